"""Skinned and moving GLB scenes as sequences, against an evaluation of their own."""

from __future__ import annotations

import json
import random
import struct
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

from app.actions.inspect import inspect
from app.actions.kinds import kind_of
from app.formats import read_sequence
from app.formats.gltf import GltfWriter
from app.formats.tvm import guess_facts, open_mesh_frames
from imitation.errors import InputError

Array = NDArray[np.float64]
Change = Callable[[dict[str, Any]], None]
TIMES = np.arange(9) / 24.0
SPARSE = np.array([0.0, 1 / 6, 1 / 3])
FPS = 24


class Arm:
    """A tube along +y on three joints, 0.5 apart; the second bends, the third twists, the first wanders, in keys."""

    def __init__(self, seed: int = 3) -> None:
        rng = np.random.default_rng(seed)
        rings, sides = 7, 6
        angle = 2 * np.pi * np.arange(sides) / sides
        ring = np.stack([0.2 * np.cos(angle), np.zeros(sides), 0.2 * np.sin(angle)], axis=1)
        self.base = (ring[None] + np.linspace(0, 1.5, rings)[:, None, None] * [0, 1, 0]).reshape(-1, 3)
        a, b = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
        here, beside = a * sides + b, a * sides + (b + 1) % sides
        pairs = np.stack([here, here + sides, beside, beside, here + sides, beside + sides], axis=-1)
        self.faces = pairs.reshape(-1, 3)
        self.joints = np.tile([0, 1, 2, 2], (len(self.base), 1)).astype(np.uint8)
        near = np.maximum(1 - np.abs(self.base[:, 1, None] - [0.0, 0.5, 1.0]) / 0.6, 0) + 1e-3
        self.weights = np.pad(near / near.sum(axis=1, keepdims=True), ((0, 0), (0, 1))).astype(np.float32)
        self.bulge = (ring[None] * np.linspace(0, 1, rings)[:, None, None]).reshape(-1, 3)
        self.bend = Rotation.from_euler("xyz", np.cumsum(rng.normal(0, 0.3, (len(TIMES), 3)), axis=0)).as_quat()
        self.bend[3] *= -1  # the same turn, the other sign: the shorter way has to be taken
        self.twist = rng.normal(0, 0.5, (3, 3, 4))
        self.twist[:, 1, 3] += 2.0
        self.twist[:, 1] /= np.linalg.norm(self.twist[:, 1], axis=1, keepdims=True)
        self.wander = np.cumsum(rng.normal(0, 0.1, (len(TIMES), 3)), axis=0)
        self.swell = np.array([0.0, 0.5, -0.2])

    def write(self, path: Path, change: Change | None = None, *, morph: bool = True) -> Path:
        """Write the GLB by hand; ``change`` may spoil its tree."""
        writer = GltfWriter()
        inverse = np.tile(np.eye(4), (3, 1, 1))
        inverse[:, 1, 3] = [0.0, -0.5, -1.0]
        attributes = {
            "POSITION": writer.add(self.base.astype(np.float32), "VEC3", target=34962, bounds=True),
            "JOINTS_0": writer.add(self.joints, "VEC4", target=34962),
            "WEIGHTS_0": writer.add(self.weights, "VEC4", target=34962),
        }
        primitive = {
            "attributes": attributes,
            "indices": writer.add(self.faces.astype(np.uint32).reshape(-1, 1), "SCALAR"),
        }
        if morph:
            primitive["targets"] = [{"POSITION": writer.add(self.bulge.astype(np.float32), "VEC3", bounds=True)}]
        dense = writer.add(TIMES.astype(np.float32).reshape(-1, 1), "SCALAR", bounds=True)
        sparse = writer.add(SPARSE.astype(np.float32).reshape(-1, 1), "SCALAR", bounds=True)
        samplers = [
            {"input": dense, "output": writer.add(self.bend.astype(np.float32), "VEC4")},
            {
                "input": sparse,
                "output": writer.add(self.twist.reshape(-1, 4).astype(np.float32), "VEC4"),
                "interpolation": "CUBICSPLINE",
            },
            {
                "input": dense,
                "output": writer.add(self.wander.astype(np.float32), "VEC3"),
                "interpolation": "STEP",
            },
            {"input": sparse, "output": writer.add(self.swell.astype(np.float32).reshape(-1, 1), "SCALAR")},
        ]
        targets = [(2, "rotation"), (3, "rotation"), (1, "translation"), *([(0, "weights")] if morph else [])]
        channels = [{"sampler": k, "target": {"node": node, "path": at}} for k, (node, at) in enumerate(targets)]
        writer.tree |= {
            "scene": 0,
            "scenes": [{"nodes": [4]}],
            "nodes": [
                # Where a skinned mesh's node stands must not matter.
                {"mesh": 0, "skin": 0, "translation": [9.0, 9.0, 9.0]},
                {"children": [2]},
                {"children": [3], "translation": [0.0, 0.5, 0.0]},
                {"translation": [0.0, 0.5, 0.0], "scale": [1.5, 1.0, 1.0]},
                {"children": [0, 1], "rotation": [0.0, 0.7071067811865476, 0.0, 0.7071067811865476]},
            ],
            "meshes": [{"primitives": [primitive]}],
            "skins": [
                {
                    "joints": [1, 2, 3],
                    "inverseBindMatrices": writer.add(
                        inverse.transpose(0, 2, 1).reshape(3, 16).astype(np.float32), "MAT4"
                    ),
                }
            ],
            "animations": [{"name": "wave", "samplers": samplers, "channels": channels}],
        }
        if change is not None:
            change(writer.tree)
        writer.write(path)
        return path

    def truth(self, frame: int, *, morph: bool = True) -> Array:
        """Vertices of a frame, z up, by homogeneous matrices and scipy's interpolation."""
        t = frame / FPS
        bend = Slerp(TIMES, Rotation.from_quat(self.bend))(min(t, TIMES[-1]))
        spline = [
            CubicHermiteSpline(SPARSE[k : k + 2], self.twist[k : k + 2, 1], [self.twist[k, 2], self.twist[k + 1, 0]])
            for k in range(2)
        ]
        twist = Rotation.from_quat(spline[0](t) if t < SPARSE[1] else spline[1](t))
        root = _matrix(Rotation.from_euler("y", 90, degrees=True), [0, 0, 0])
        first = root @ _matrix(Rotation.identity(), self.wander[frame])
        second = first @ _matrix(bend, [0, 0.5, 0])
        third = second @ _matrix(twist, [0, 0.5, 0]) @ np.diag([1.5, 1, 1, 1])
        shape = self.base + (np.interp(t, SPARSE, self.swell) if morph else 0.0) * self.bulge
        placed = np.zeros_like(shape)
        for joint, (world, rest) in enumerate(zip((first, second, third), (0.0, 0.5, 1.0), strict=True)):
            local = np.c_[shape - [0, rest, 0], np.ones(len(shape))]
            placed += self.weights[:, joint, None] * (local @ world.T)[:, :3]
        return np.stack([placed[:, 0], -placed[:, 2], placed[:, 1]], axis=1)


def _matrix(turn: Rotation, shift: Any) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn.as_matrix(), shift
    return matrix


@pytest.mark.parametrize("morph", [True, False])
def test_a_skin_follows_its_joints(tmp_path: Path, morph: bool) -> None:
    """Every frame equals linear blend skinning with slerped, splined and stepped keys, after morph targets."""
    arm = Arm()
    path = arm.write(tmp_path / "arm.glb", morph=morph)
    with open_mesh_frames(path) as frames:
        assert (len(frames), frames.fps, frames.up, frames.unit, frames.moving) == (9, 24, "z", 1.0, True)
        assert frames.remark == ""
        for frame in (8, 0, 3, 4, 5, 7):
            mesh = frames[frame]
            np.testing.assert_array_equal(mesh.faces, arm.faces)
            assert np.abs(mesh.vertices - arm.truth(frame, morph=morph)).max() < 2e-6
    whole = read_sequence(path)
    assert whole.vertices.shape == (9, len(arm.base), 3)
    assert np.abs(whole.vertices[6] - arm.truth(6, morph=morph)).max() < 2e-6
    assert kind_of(path) == "sequence"
    assert inspect(path)["frames"] == 9


def test_nodes_that_move_without_a_skin_are_posed(tmp_path: Path) -> None:
    """A rigid mesh on a moving node moves with it; its base is in the node's coordinates."""
    arm = Arm()

    def rigid(tree: dict[str, Any]) -> None:
        del tree["skins"], tree["nodes"][0]["skin"]
        tree["nodes"][2]["children"] = [3, 0]
        tree["nodes"][4]["children"] = [1]

    with open_mesh_frames(arm.write(tmp_path / "arm.glb", rigid, morph=False)) as frames:
        turns = Slerp(TIMES, Rotation.from_quat(arm.bend))
        for frame in (0, 3, 8):
            within = turns(TIMES[frame]).apply(arm.base + 9.0) + [0, 0.5, 0] + arm.wander[frame]
            world = Rotation.from_euler("y", 90, degrees=True).apply(within)
            expected = np.stack([world[:, 0], -world[:, 2], world[:, 1]], axis=1)
            assert np.abs(frames[frame].vertices - expected).max() < 1e-5


def test_corners_cut_apart_are_one_vertex(tmp_path: Path) -> None:
    """Vertices equal in place, weights and displacements are one, as texture seams and materials cut them apart."""
    arm = Arm()
    truth, count = arm.truth(5), len(arm.base)
    for name in ("base", "joints", "weights", "bulge"):
        value = getattr(arm, name)
        setattr(arm, name, np.concatenate([value, value]))
    arm.weights[count + 3] = arm.weights[count + 3, ::-1]  # one copy that moves otherwise stays
    arm.faces = np.concatenate([arm.faces[:30], arm.faces[30:] + count])
    with open_mesh_frames(arm.write(tmp_path / "arm.glb")) as frames:
        mesh = frames[5]
    assert len(mesh.vertices) == count + 1
    assert np.abs(mesh.vertices[:count] - truth).max() < 2e-6


def test_what_a_file_leaves_open_is_said(tmp_path: Path) -> None:
    """Uneven keys are sampled at 30 a second; of several animations the first is taken; both are told."""

    def uneven(tree: dict[str, Any]) -> None:
        animation = tree["animations"][0]
        animation["channels"] = animation["channels"][1:2]
        tree["animations"].append({**animation, "name": "run"})

    with open_mesh_frames(Arm().write(tmp_path / "arm.glb", uneven, morph=False)) as frames:
        assert frames.fps == Fraction(30)
        assert len(frames) == 11  # a third of a second
        guess = guess_facts(frames)
    assert guess.guessed == ()
    assert "2 animations (wave, run): wave is taken" in guess.why
    assert "no even rate" in guess.why


def _no_animation(tree: dict[str, Any]) -> None:
    del tree["animations"]


def _no_weights(tree: dict[str, Any]) -> None:
    del tree["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"]


def _no_joint(tree: dict[str, Any]) -> None:
    tree["skins"][0]["joints"] = [1, 2]


def _joint_outside(tree: dict[str, Any]) -> None:
    tree["skins"][0]["joints"] = [1, 2, 77]


def _not_in_scene(tree: dict[str, Any]) -> None:
    tree["nodes"][4]["children"] = [0]


def _times_back(tree: dict[str, Any]) -> None:
    samplers = tree["animations"][0]["samplers"]
    samplers[0]["input"] = samplers[3]["output"]


def _fewer_keys(tree: dict[str, Any]) -> None:
    samplers = tree["animations"][0]["samplers"]
    samplers[0]["output"] = samplers[1]["output"]
    samplers[0]["interpolation"] = "CUBICSPLINE"


def _circle(tree: dict[str, Any]) -> None:
    tree["nodes"][3]["children"] = [1]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_no_animation, "no animation"),
        (_no_weights, "no joints"),
        (_no_joint, "joints that are not there"),
        (_joint_outside, "joints that are not there"),
        (_not_in_scene, "cannot be posed"),
        (_times_back, "times do not ascend"),
        (_fewer_keys, "not a whole GLB"),
        (_circle, "not a whole GLB"),
    ],
)
def test_damaged_skins_are_refused(tmp_path: Path, change: Change, words: str) -> None:
    """One sentence says what is wrong with the file."""
    path = Arm().write(tmp_path / "arm.glb", change)
    with pytest.raises(InputError, match=words) as caught:
        open_mesh_frames(path)
    assert "arm.glb" in str(caught.value)
    assert str(caught.value).count(". ") == 0


def test_weights_that_are_no_numbers_and_endless_times_are_refused(tmp_path: Path) -> None:
    """NaN weights, keys that lie hours away, and places that are NaN in a later frame."""
    arm = Arm()
    arm.weights[4, 1] = np.nan
    with pytest.raises(InputError, match="skin weights"):
        open_mesh_frames(arm.write(tmp_path / "nan.glb"))
    arm = Arm()
    arm.wander[5] = np.inf
    with open_mesh_frames(arm.write(tmp_path / "inf.glb")) as frames, pytest.raises(InputError, match="Frame 5 of inf"):
        frames[5]

    def stated(tree: dict[str, Any]) -> None:
        tree["asset"]["extras"] = {"fps": "1/0"}
        tree["animations"][0]["samplers"][0]["input"] = 99

    with pytest.raises(InputError, match="not a whole GLB"):
        open_mesh_frames(Arm().write(tmp_path / "index.glb", stated))


def test_a_picture_on_a_skin_comes_along(tmp_path: Path) -> None:
    """Texture coordinates and the base colour's picture lie on the faces of every frame, seams sewn."""
    import cv2

    arm = Arm()
    writer_of = GltfWriter.write
    picture = cv2.imencode(".png", np.full((4, 4, 3), 90, np.uint8))[1].tobytes()
    places = np.random.default_rng(0).random((len(arm.base), 2)).astype(np.float32)

    def kept(self: GltfWriter, path: Path) -> None:
        primitive = self.tree["meshes"][0]["primitives"][0]
        primitive["attributes"]["TEXCOORD_0"] = self.add(places, "VEC2")
        primitive["material"] = 0
        self.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        self.tree["textures"] = [{"source": 0}]
        self.tree["images"] = [{"name": "coat", "mimeType": "image/png", "bufferView": self.add_bytes(picture)}]
        writer_of(self, path)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(GltfWriter, "write", kept)
        path = arm.write(tmp_path / "arm.glb")
    with open_mesh_frames(path) as frames:
        texture = frames[4].texture
        assert texture is not None
        assert texture.images[0].read_bytes() == picture
        np.testing.assert_array_equal(texture.corners, arm.faces)
        np.testing.assert_allclose(texture.coordinates, places * [1, -1] + [0, 1], atol=1e-6)


def _places(tree: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [found for key, value in items for found in ((*path, key), *_places(value, (*path, key)))]


def test_whatever_a_file_says_is_read_or_refused(tmp_path: Path) -> None:
    """Any entry of the description replaced or missing, any length cut off: frames, or one sentence; never a crash."""
    path = Arm().write(tmp_path / "arm.glb")
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    tree, binary = json.loads(data[20 : 20 + size]), data[20 + size :]
    rng = random.Random(5)
    places = _places(tree)
    refused = 0
    for _ in range(400):
        spoiled = json.loads(json.dumps(tree))
        *above, last = rng.choice(places)
        entry = spoiled
        for key in above:
            entry = entry[key]
        entry[last] = rng.choice([None, -1, 0, 99, 1e9, "x", [], {}, 2**40, float("nan"), [1], 1.5])
        text = json.dumps(spoiled).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(binary))
        path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + binary)
        refused += _refused(path)
    assert refused > 200
    for _ in range(40):
        path.write_bytes(data[: rng.randrange(len(data))])
        assert _refused(path)


def _refused(path: Path) -> bool:
    try:
        with open_mesh_frames(path) as frames:
            assert all(len(frames[k].vertices) for k in (0, -1))
    except InputError:
        return True
    return False


def test_one_of_several_animations_is_chosen_by_name_or_number(tmp_path: Path) -> None:
    """Without a choice the first is taken and the others are named; what is not there, or twice there, is said."""
    arm = Arm()

    def thrice(tree: dict[str, Any]) -> None:
        wave = tree["animations"][0]
        # The second moves the first joint alone.
        only = {**wave, "name": "Bend", "channels": wave["channels"][:1]}
        tree["animations"] += [only, {**only, "name": "Bend"}]

    path = arm.write(tmp_path / "arm.glb", thrice)
    first, second = open_mesh_frames(path), open_mesh_frames(path, animation="2")
    assert "3 animations (wave, Bend, Bend): wave is taken" in first.remark
    assert second.remark == ""
    assert open_mesh_frames(path, animation="Wave").remark == ""
    assert np.abs(first[4].vertices - second[4].vertices).max() > 0.05
    for wanted, sentence in (("Run", "no animation Run: it has wave"), ("Bend", "by its number, 2 and 3")):
        with pytest.raises(InputError, match=sentence):
            open_mesh_frames(path, animation=wanted)
    with pytest.raises(InputError, match="only an animated GLB"):
        open_mesh_frames(tmp_path, animation="wave")
