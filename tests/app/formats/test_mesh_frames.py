"""Sequences whose frames have faces of their own: read one at a time, written, and refused where they are damaged."""

from __future__ import annotations

import io
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.formats import write_image, write_mesh, write_sequence
from app.formats.tvm import FrameMesh, Texture, guess_facts, open_mesh_frames, painted, write_mesh_frames
from imitation import InputError


def bodies(count: int = 12) -> list[FrameMesh]:
    """Frames with another number of vertices each: fans round a pole, z up, 1.7 m high."""
    random = np.random.default_rng(3)
    made = []
    for frame in range(count):
        rim = 5 + frame % 4
        angle = np.linspace(0, 2 * np.pi, rim, endpoint=False) + 0.1 * frame
        ring = np.stack([0.3 * np.cos(angle), 0.3 * np.sin(angle), np.zeros(rim)], axis=1)
        vertices = np.vstack([ring, [0.0, 0.0, 1.7]]).astype(np.float32).astype(np.float64)
        faces = np.array([[k, (k + 1) % rim, rim] for k in range(rim)], np.int32)
        made.append(FrameMesh(vertices, faces, random.integers(0, 256, (rim + 1, 3), np.uint8)))
    return made


@pytest.mark.parametrize("form", ["ply", "obj", "off", "glb", "npz"])
def test_what_was_written_reads_back(form: str, tmp_path: Path) -> None:
    """Vertices in single precision, faces and colours of every frame come back, in order beyond ten."""
    target = tmp_path / ("take.npz" if form == "npz" else "take")
    made = bodies()
    write_mesh_frames(target, iter(made), form=form, fps=30, count=len(made))  # type: ignore[arg-type]
    with open_mesh_frames(target) as frames:
        assert len(frames) == 12
        assert frames.fps == (30 if form == "npz" else None)
        assert frames.up == ("z" if form in ("glb", "npz") else None)
        for mine, theirs in zip(made, frames, strict=True):
            np.testing.assert_allclose(theirs.vertices, mine.vertices, atol=1e-7)
            np.testing.assert_array_equal(theirs.faces, mine.faces)
            assert theirs.colours is not None
            np.testing.assert_allclose(theirs.colours.astype(int), mine.colours, atol=1)  # type: ignore[arg-type]
        assert len(frames[-1].vertices) == len(made[-1].vertices)
        assert [len(mesh.vertices) for mesh in frames[2:4]] == [8, 9]


def test_names_are_in_natural_order(tmp_path: Path) -> None:
    """Frame 2 comes before frame 10, hidden files and others do not count."""
    for number in (10, 2, 1):
        mesh = bodies(1)[0]
        write_mesh(tmp_path / f"f{number}.ply", mesh.vertices + np.array([0, 0, number]), mesh.faces)
    (tmp_path / ".f3.ply").write_bytes(b"")
    (tmp_path / "notes.txt").write_text("x")
    frames = open_mesh_frames(tmp_path)
    assert [round(float(mesh.vertices[:, 2].min())) for mesh in frames] == [1, 2, 10]


def test_one_moving_mesh_is_a_sequence_too(tmp_path: Path) -> None:
    """An animated GLB and a Motionwright npz give the same frames, Z up and in metres."""
    mesh = bodies(1)[0]
    vertices = mesh.vertices + 0.01 * np.arange(4)[:, None, None]
    for name in ("a.glb", "a.npz"):
        write_sequence(tmp_path / name, vertices, mesh.faces, 12, colors=mesh.colours)
        with open_mesh_frames(tmp_path / name) as frames:
            assert (len(frames), frames.fps, frames.up, frames.unit, frames.moving) == (4, 12, "z", 1.0, True)
            np.testing.assert_allclose(frames[3].vertices, vertices[3], atol=1e-6)
            assert frames[3].colours is not None


def test_positions_in_a_box(tmp_path: Path) -> None:
    """Half precision in a box, frames end to end."""
    made = bodies(3)
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in made)])
    face_starts = np.cumsum([0, *(len(mesh.faces) for mesh in made)])
    np.savez_compressed(
        tmp_path / "box.npz",
        positions=(np.concatenate([mesh.vertices for mesh in made]) / 2).astype(np.float16),
        faces=np.concatenate([mesh.faces for mesh in made]),
        vertex_offsets=starts,
        face_offsets=face_starts,
        center=[0.0, 0.0, 5.0],
        scale=[2.0],
        fps=[15.0],
    )
    with open_mesh_frames(tmp_path / "box.npz") as frames:
        assert (len(frames), frames.fps) == (3, 15)
        np.testing.assert_allclose(frames[1].vertices, made[1].vertices + np.array([0, 0, 5]), atol=2e-3)


def textured(folder: Path, count: int = 2) -> Path:
    """OBJ frames with a picture each: left half red, right half blue."""
    folder.mkdir()
    for frame in range(count):
        picture = np.zeros((8, 8, 3), np.uint8)
        picture[:, :4], picture[:, 4:] = (200 + frame, 0, 0), (0, 0, 200 + frame)
        write_image(folder / f"skin_{frame}.png", picture)
        (folder / f"m_{frame}.mtl").write_text(f"newmtl skin\nKd 1 1 1\nmap_Kd -s 1 1 1 skin_{frame}.png\n")
        (folder / f"m_{frame}.obj").write_text(
            f"mtllib m_{frame}.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0.1 0.5\nvt 0.9 0.5\nusemtl skin\nf 1/1 2/2 3/1\n"
        )
    return folder


def test_textures_pass_through_untouched(tmp_path: Path) -> None:
    """Coordinates and pictures come out of an export byte for byte; elsewhere vertices have their colours."""
    frames = open_mesh_frames(textured(tmp_path / "in"))
    mesh = frames[1]
    assert isinstance(mesh.texture, Texture)
    assert mesh.texture.images[0].name == "skin_1.png"
    write_mesh_frames(tmp_path / "out", frames, form="obj", fps=25, count=2, name="m")
    again = open_mesh_frames(tmp_path / "out")[1]
    assert again.texture is not None
    np.testing.assert_array_equal(again.texture.coordinates, mesh.texture.coordinates)
    np.testing.assert_array_equal(again.texture.corners, mesh.texture.corners)
    assert (tmp_path / "out" / "skin_1.png").read_bytes() == (tmp_path / "in" / "skin_1.png").read_bytes()
    coloured = painted(mesh).colours
    assert coloured is not None
    assert coloured.tolist() == [[201, 0, 0], [0, 0, 201], [201, 0, 0]]
    write_mesh_frames(tmp_path / "off", frames, form="off", fps=25, count=2)
    np.testing.assert_array_equal(open_mesh_frames(tmp_path / "off")[1].colours, coloured)  # type: ignore[arg-type]


def test_material_colours(tmp_path: Path) -> None:
    """Faces in the colour of their material, where there is no picture."""
    for frame in range(2):
        (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0.5 0\n")
        (tmp_path / f"{frame}.obj").write_text(
            "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\n"
        )
    colours = open_mesh_frames(tmp_path)[0].colours
    assert colours is not None
    assert colours[0].tolist() == [255, 0, 0]
    assert colours[3].tolist() == [0, 128, 0]


def test_a_strangers_material_names_no_file_outside(tmp_path: Path) -> None:
    """A picture outside the folder is not taken."""
    folder = textured(tmp_path / "in")
    write_image(tmp_path / "secret.png", np.zeros((2, 2, 3), np.uint8))
    (folder / "m_0.mtl").write_text("newmtl skin\nmap_Kd ../secret.png\n")
    assert open_mesh_frames(folder)[0].texture is None


def test_guesses_are_named(tmp_path: Path) -> None:
    """A folder says neither rate nor axis nor unit; what the user says is not guessed."""
    made = [FrameMesh(100 * mesh.vertices[:, [0, 2, 1]], mesh.faces[:, ::-1].copy()) for mesh in bodies(3)]
    write_mesh_frames(tmp_path / "in", made, form="ply", fps=25, count=3)
    frames = open_mesh_frames(tmp_path / "in")
    guess = guess_facts(frames)
    assert (guess.fps, guess.up, guess.unit, guess.guessed) == (25.0, "y", 0.01, ("fps", "up", "unit"))
    assert "Y up" in guess.why
    assert "centimetres" in guess.why
    said = guess_facts(frames, fps=30, up="z", unit=1)
    assert (said.fps, said.up, said.unit, said.guessed, said.why) == (30, "z", 1, (), "")


def broken(folder: Path, what: str) -> Path:
    """A sequence that cannot be used."""
    write_mesh_frames(folder, bodies(3), form="ply", fps=25, count=3, name="f")
    first = folder / "f_0000.ply"
    data = first.read_bytes()
    if what == "one frame":
        (folder / "f_0001.ply").unlink()
        (folder / "f_0002.ply").unlink()
    elif what == "mixed":
        write_mesh(folder / "x.obj", bodies(1)[0].vertices, bodies(1)[0].faces)
    elif what == "empty folder":
        for file in folder.iterdir():
            file.unlink()
    elif what == "cut off":
        first.write_bytes(data[:-9])
    elif what == "lying":
        first.write_bytes(data.replace(b"vertex 6", b"vertex 999999999"))
    elif what == "no faces":
        first.write_bytes(data.replace(b"face 5", b"face 0"))
    elif what == "NaN":
        at = data.index(b"end_header\n") + 11
        first.write_bytes(data[:at] + np.float32("nan").tobytes() + data[at + 4 :])
    elif what == "no vertices":
        first.write_bytes(
            b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
            b"property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
        )
    return folder


REASONS = {
    "one frame": "at least two",
    "mixed": r"mixes formats \(1 OBJ, 3 PLY\)",
    "empty folder": "holds no PLY",
    "cut off": "f_0000.ply",
    "lying": "promises 999999999 rows",
    "no faces": "no faces",
    "NaN": "NaN",
    "no vertices": "no vertices",
}


@pytest.mark.parametrize("what", REASONS)
def test_bad_folders_get_one_sentence(what: str, tmp_path: Path) -> None:
    """Each is refused at once, without asking for much memory."""
    folder = broken(tmp_path / "in", what)
    tracemalloc.start()
    with pytest.raises(InputError, match=REASONS[what]) as caught:
        open_mesh_frames(folder)
    assert tracemalloc.get_traced_memory()[1] < 4 << 20
    tracemalloc.stop()
    assert str(caught.value).count(". ") == 0


def test_a_later_frame_is_named(tmp_path: Path) -> None:
    """A damaged frame in the middle is found when it is read, and named."""
    write_mesh_frames(tmp_path, bodies(3), form="ply", fps=25, count=3, name="f")
    (tmp_path / "f_0001.ply").write_bytes(b"ply\n")
    frames = open_mesh_frames(tmp_path)
    with pytest.raises(InputError, match=r"f_0001\.ply"):
        list(frames)


def packed_bytes() -> bytes:
    """A small good npz."""
    memory = io.BytesIO()
    mesh = bodies(1)[0]
    np.savez(memory, vertices=np.stack([mesh.vertices] * 3), faces=mesh.faces, fps=[25.0])
    return memory.getvalue()


@given(st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_damaged_npz_never_surprise(tmp_path: Path, data: st.DataObject) -> None:
    """Whatever is changed in the file, it is read or refused in a sentence, never with another error."""
    good = bytearray(packed_bytes())
    for _ in range(data.draw(st.integers(1, 6))):
        good[data.draw(st.integers(0, len(good) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path / "x.npz"
    path.write_bytes(good[: data.draw(st.integers(1, len(good)))] if data.draw(st.booleans()) else good)
    try:
        with open_mesh_frames(path) as frames:
            list(frames)
    except InputError:
        pass


@given(st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_lying_headers_never_surprise(tmp_path: Path, data: st.DataObject) -> None:
    """Any numbers and kinds in a PLY or OFF header: read or refused, without large memory."""
    count, faces = (data.draw(st.sampled_from([-1, 0, 1, 3, 10**6, 2**31, 10**15])) for _ in range(2))
    body = data.draw(st.binary(max_size=60))
    form = data.draw(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
    kind = data.draw(st.sampled_from(["float", "double", "uchar", "int", "list uchar int"]))
    head = f"ply\nformat {form} 1.0\nelement vertex {count}\nproperty {kind} x\nproperty float y\nproperty float z\n"
    head += f"element face {faces}\nproperty list uint int vertex_indices\nend_header\n"
    if data.draw(st.booleans()):
        suffix, content = ".ply", head.encode() + body
    else:
        suffix, content = ".off", f"OFF\n{count} {faces} 0\n".encode() + body
    for number in range(2):
        (tmp_path / f"f{number}{suffix}").write_bytes(content)
    for other in tmp_path.glob("f*"):
        if other.suffix != suffix:
            other.unlink()
    tracemalloc.start()
    try:
        list(open_mesh_frames(tmp_path))
    except InputError:
        pass
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    assert peak < 8 << 20


def test_an_npz_that_promises_too_much(tmp_path: Path) -> None:
    """A header of 10^12 rows over a few bytes is refused before anything is unpacked."""
    memory = io.BytesIO()
    np.lib.format.write_array_header_1_0(memory, {"descr": "<f4", "fortran_order": False, "shape": (10**12, 3)})
    with zipfile.ZipFile(tmp_path / "x.npz", "w") as archive:
        archive.writestr("vertices.npy", memory.getvalue() + bytes(64))
    with pytest.raises(InputError, match="export it again"):
        open_mesh_frames(tmp_path / "x.npz")


def test_the_memory_is_that_of_a_frame(tmp_path: Path) -> None:
    """Reading many frames of many vertices one after another holds one of them."""
    random = np.random.default_rng(0)
    faces = random.integers(0, 4000, (8000, 3)).astype(np.int32)

    def many() -> list[FrameMesh]:
        return [FrameMesh(random.random((4000, 3)), faces) for _ in range(100)]

    write_mesh_frames(tmp_path / "x.npz", many(), form="npz", fps=25, count=100)
    tracemalloc.start()
    with open_mesh_frames(tmp_path / "x.npz") as frames:
        total = sum(len(mesh.vertices) for mesh in frames)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert total == 100 * 4000
    # 100 frames are 14 MB in the file; one frame as read is 0.19 MB, and unpacking needs some more.
    assert peak < 6 << 20
