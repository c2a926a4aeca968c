"""Moving meshes: exact vertices at exact times, read back by ourselves and by others."""

from __future__ import annotations

import json
import struct
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.formats import read_mesh, read_sequence, write_mesh, write_sequence
from imitation.errors import InputError
from imitation.progress import Progress

NTSC = Fraction(30000, 1001)


def wave(frames: int = 7, rings: int = 6) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A waving tube in single precision, its faces, and colours."""
    turn = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    rest = np.array([[np.cos(a), np.sin(a), z / 2] for z in range(rings) for a in turn])
    faces = []
    for ring in range(rings - 1):
        for k in range(8):
            a, b, c, d = 8 * ring + k, 8 * ring + (k + 1) % 8, 8 * ring + 8 + k, 8 * ring + 8 + (k + 1) % 8
            faces += [(a, b, d), (a, d, c)]
    times = np.arange(frames)[:, None]
    vertices = np.repeat(rest[None], frames, axis=0)
    vertices[..., 0] += np.sin(0.4 * times + rest[:, 2]) * rest[:, 2]
    vertices[..., 1] += 0.2 * times
    colors = np.random.default_rng(1).integers(0, 256, rest.shape).astype(np.uint8)
    return vertices.astype(np.float32).astype(np.float64), np.array(faces, np.int32), colors


@pytest.mark.parametrize("target", ["tube.glb", "tube.usdc", "tube.usda", "tube.npz", "ply", "obj"])
def test_sequences_come_back_exactly(tmp_path: Path, target: str) -> None:
    """Every vertex of every frame, faces, colours and rate survive in every format (single precision)."""
    vertices, faces, colors = wave()
    form = target if target in ("ply", "obj") else None
    write_sequence(tmp_path / target, vertices, faces, NTSC, form=form, colors=colors, name="tube")
    back = read_sequence(tmp_path / target, fps=NTSC)
    np.testing.assert_allclose(back.vertices, vertices, atol=5e-7 if target == "tube.glb" else 1e-9)
    np.testing.assert_array_equal(back.faces, faces)
    np.testing.assert_array_equal(back.colors, colors)
    assert (back.fps, back.name.split(".")[0], len(back)) == (NTSC, "tube", 7)


@settings(deadline=None, max_examples=25)
@given(
    vertices=hnp.arrays(
        np.float32, st.tuples(st.integers(1, 5), st.just(4), st.just(3)), elements=st.floats(-100, 100, width=32)
    ),
    rate=st.fractions(Fraction(1), Fraction(240), max_denominator=1001),
)
def test_any_numbers_come_back(tmp_path_factory: pytest.TempPathFactory, vertices: np.ndarray, rate: Fraction) -> None:
    """Npz keeps all bits; PLY folders keep all single-precision bits."""
    folder = tmp_path_factory.mktemp("any")
    for target, form in (("a.npz", "npz"), ("plys", "ply")):
        write_sequence(folder / target, vertices, [[0, 1, 2], [1, 2, 3]], rate, form=form)
        back = read_sequence(folder / target, fps=rate)
        np.testing.assert_array_equal(back.vertices, vertices)
        assert back.fps == rate


def _parse(path: Path) -> tuple[dict, bytes]:
    """The two chunks of a GLB, read by hand."""
    data = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    return json.loads(data[20 : 20 + size]), data[28 + size :]


@pytest.mark.parametrize("interpolation", ["linear", "step"])
def test_glb_evaluated_by_hand_shows_each_frame_at_its_time(tmp_path: Path, interpolation: str) -> None:
    """An independent evaluation of the animation by pygltflib's structures gives the vertices at k / fps."""
    import pygltflib

    vertices, faces, colors = wave(frames=12)
    path = tmp_path / "tube.glb"
    write_sequence(path, vertices, faces, NTSC, colors=colors, interpolation=interpolation)
    gltf = pygltflib.GLTF2().load(str(path))
    blob = gltf.binary_blob()

    def values(index: int) -> np.ndarray:
        accessor = gltf.accessors[index]
        view = gltf.bufferViews[accessor.bufferView]
        kind, width = {5126: "<f4", 5125: "<u4"}[accessor.componentType], {"SCALAR": 1, "VEC3": 3}[accessor.type]
        assert not view.byteStride
        return np.frombuffer(blob, kind, accessor.count * width, view.byteOffset).reshape(-1, width)

    primitive, sampler = gltf.meshes[0].primitives[0], gltf.animations[0].samplers[0]
    assert sampler.interpolation == interpolation.upper()
    base, targets = values(primitive.attributes.POSITION), [values(each["POSITION"]) for each in primitive.targets]
    weights = values(sampler.output).reshape(12, 11)
    np.testing.assert_allclose(values(sampler.input)[:, 0], np.arange(12) * 1001 / 30000, rtol=1e-7)
    np.testing.assert_array_equal(values(primitive.indices).reshape(-1, 3), faces)
    normals, turned = values(primitive.attributes.NORMAL), [values(each["NORMAL"]) for each in primitive.targets]
    for frame in range(12):
        shown = base + sum(weights[frame, k] * targets[k] for k in range(11))
        np.testing.assert_allclose(shown, vertices[frame][:, [0, 2, 1]] * [1, 1, -1], atol=5e-7)
        lit = normals + sum(weights[frame, k] * turned[k] for k in range(11))
        np.testing.assert_allclose(np.linalg.norm(lit, axis=1), 1, atol=1e-5)


def test_glb_follows_the_rules_viewers_rely_on(tmp_path: Path) -> None:
    """Offsets are multiples of four, bounds are exact, weights match targets, vertex rows are multiples of four."""
    vertices, faces, colors = wave()
    for quantize in (False, True):
        path = tmp_path / "tube.glb"
        write_sequence(path, vertices, faces, 25, colors=colors, quantize=quantize)
        tree, blob = _parse(path)
        sizes = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
        widths = {"SCALAR": 1, "VEC3": 3}
        assert tree["buffers"][0]["byteLength"] == len(blob)
        for accessor in tree["accessors"]:
            view = tree["bufferViews"][accessor["bufferView"]]
            row = view.get("byteStride") or sizes[accessor["componentType"]] * widths[accessor["type"]]
            assert view["byteOffset"] % 4 == 0
            assert view["byteLength"] == accessor["count"] * row
            assert view["byteOffset"] + view["byteLength"] <= len(blob)
            if view.get("target") == 34962:
                assert row % 4 == 0
        primitive = tree["meshes"][0]["primitives"][0]
        assert len(primitive["targets"]) == len(tree["meshes"][0]["weights"]) == 6
        for target in [primitive["attributes"], *primitive["targets"]]:
            assert {"min", "max"} <= set(tree["accessors"][target["POSITION"]])
        assert ("KHR_mesh_quantization" in tree.get("extensionsRequired", [])) == quantize


def test_another_reader_opens_the_glb(tmp_path: Path) -> None:
    """Trimesh loads the first frame, turned to Y up."""
    import trimesh

    vertices, faces, _ = wave()
    write_sequence(tmp_path / "tube.glb", vertices, faces, 25)
    mesh = trimesh.load(tmp_path / "tube.glb", force="mesh", process=False, maintain_order=True)
    np.testing.assert_allclose(mesh.vertices, vertices[0][:, [0, 2, 1]] * [1, 1, -1], atol=1e-6)
    assert len(read_mesh(tmp_path / "tube.glb").vertices) == len(vertices[0])


def test_quantised_glb_is_half_as_large_and_near(tmp_path: Path) -> None:
    """Integers halve the file and move no vertex by more than 1/32767 of the largest displacement."""
    vertices, faces, _ = wave(frames=60, rings=40)
    write_sequence(tmp_path / "a.glb", vertices, faces, 25)
    write_sequence(tmp_path / "b.glb", vertices, faces, 25, quantize=True)
    largest = np.abs(vertices - vertices[0]).max()
    assert np.abs(read_sequence(tmp_path / "b.glb").vertices - vertices).max() <= largest / 32766 * 1.01
    assert (tmp_path / "b.glb").stat().st_size < 0.56 * (tmp_path / "a.glb").stat().st_size


def test_usd_states_time_and_axes(tmp_path: Path) -> None:
    """A stage says Z up, metres, frames a second, first and last frame, and holds one sample a frame."""
    from pxr import Usd, UsdGeom

    vertices, faces, _ = wave()
    write_sequence(tmp_path / "tube.usdc", vertices, faces, 24, name="3 tube!")
    stage = Usd.Stage.Open(str(tmp_path / "tube.usdc"))
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    times = (stage.GetTimeCodesPerSecond(), stage.GetStartTimeCode(), stage.GetEndTimeCode())
    assert times == (24.0, 0.0, 6.0)
    mesh = next(UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
    assert mesh.GetPointsAttr().GetTimeSamples() == list(range(7))
    np.testing.assert_allclose(mesh.GetExtentAttr().Get(3), [vertices[3].min(0), vertices[3].max(0)], atol=1e-6)


def test_a_shorter_sequence_replaces_a_longer_one(tmp_path: Path) -> None:
    """Old frames of the same name go, other files in the folder stay."""
    vertices, faces, _ = wave()
    (tmp_path / "notes.txt").write_text("mine")
    write_mesh(tmp_path / "other_0001.ply", vertices[0], faces)
    write_sequence(tmp_path, vertices, faces, 25, form="ply", name="tube")
    write_sequence(tmp_path, vertices[:2], faces, 25, form="ply", name="tube")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["notes.txt", "other_0001.ply", "tube_0000.ply", "tube_0001.ply"]


@pytest.mark.parametrize(("target", "form"), [("a.glb", None), ("a.usdc", None), ("a.npz", None), ("plys", "ply")])
def test_same_sequence_same_bytes(tmp_path: Path, target: str, form: str | None) -> None:
    """Writing twice gives the same bytes."""
    vertices, faces, colors = wave()
    found = []
    for folder in (tmp_path / "1", tmp_path / "2"):
        write_sequence(folder / target, vertices, faces, 25, form=form, colors=colors)
        files = sorted(path for path in folder.rglob("*") if path.is_file())
        found.append([path.read_bytes() for path in files])
    assert found[0] == found[1]


@pytest.mark.parametrize(("target", "form"), [("a.glb", None), ("a.usdc", None), ("plys", "obj")])
def test_cancelled_writing_leaves_nothing(tmp_path: Path, target: str, form: str | None) -> None:
    """A cancelled export leaves no file and no folder."""
    from imitation.errors import Cancelled

    def stop() -> Progress:
        def inner(fraction: float) -> None:
            if fraction > 0.4:
                raise Cancelled

        return inner

    vertices, faces, _ = wave()
    with pytest.raises(Cancelled):
        write_sequence(tmp_path / target, vertices, faces, 25, form=form, progress=stop())
    assert not list(tmp_path.iterdir())


def test_bad_sequences(tmp_path: Path) -> None:
    """Wrong shapes, no frames, NaN, changing faces, unknown files: one sentence each."""
    vertices, faces, _ = wave()
    broken = vertices.copy()
    broken[4, 2, 1] = np.nan
    for v, f, rate, name, words in [
        (vertices[0], faces, 25, "a.glb", "A sequence needs vertices"),
        (vertices[:0], faces, 25, "a.glb", "no frames"),
        (broken, faces, 25, "a.glb", "Frame 4 of the sequence"),
        (vertices, faces + 99, 25, "a.glb", "names a vertex outside"),
        (vertices, faces, 0, "a.glb", "frame rate"),
        (vertices, faces, float("nan"), "a.glb", "frame rate"),
        (vertices, faces, 25, "a.fbx", "is not clear"),
    ]:
        with pytest.raises(InputError, match=words):
            write_sequence(tmp_path / name, v, f, rate)
    assert not list(tmp_path.iterdir())
    write_mesh(tmp_path / "still.glb", vertices[0], faces)
    write_sequence(tmp_path / "mixed", vertices[:2], faces, 25, form="ply")
    write_mesh(tmp_path / "mixed" / "character_0001.ply", vertices[1], faces[::-1])
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.npz").write_text("no arrays")
    (tmp_path / "text.usda").write_text("no stage")
    for name, words in [
        ("still.glb", "no animation"),
        ("mixed", "one connectivity"),
        ("empty", "no PLY or OBJ"),
        ("none", "does not exist"),
        ("text.npz", "not an npz"),
        ("text.usda", "not a USD stage"),
    ]:
        with pytest.raises(InputError, match=words):
            read_sequence(tmp_path / name)


def test_real_baked_motions_are_read(shared_data: Path) -> None:
    """A baked motion of the shared data is read by its box and scale."""
    sequence = read_sequence(shared_data / "animated_fox" / "walk.npz")
    assert sequence.vertices.shape == (22, 290, 3)
    assert sequence.fps == 30
    assert sequence.colors is not None
