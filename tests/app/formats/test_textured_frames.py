"""Pictures on meshes: through PLY and GLB and back, byte for byte."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest

from app.formats import write_image
from app.formats.glb import read_glb
from app.formats.tvm import FrameMesh, Texture, open_mesh_frames, painted, write_mesh_frames
from app.formats.tvm.pictures import PictureRoom
from imitation import InputError


def picture(path: Path, colour: tuple[int, int, int]) -> Path:
    """A picture, the left half of one colour and the right half white."""
    values = np.full((8, 8, 3), 255, np.uint8)
    values[:, :4] = colour
    write_image(path, values)
    return path


def cube(images: tuple[Path, ...]) -> FrameMesh:
    """A cube of which every face has coordinates of its own; two pictures, and two triangles without any."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float64)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))], np.int32)
    random = np.random.default_rng(1)
    coordinates = random.random((24, 2)).astype(np.float32).astype(np.float64)
    places = np.array([t for k in range(6) for t in ((4 * k, 4 * k + 1, 4 * k + 2), (4 * k, 4 * k + 2, 4 * k + 3))])
    of_face = np.repeat([0, 0, 1, 1, 0, -1], 2).astype(np.int32)
    places = np.where(of_face[:, None] < 0, -1, places).astype(np.int32)
    return FrameMesh(corners, faces, None, Texture(coordinates, places, images, of_face))


def by_corner(mesh: FrameMesh) -> list[tuple[object, ...]]:
    """Each triangle as it looks: positions, coordinates and the picture's bytes, in an order of its own."""
    texture = mesh.texture
    assert texture is not None
    rows = []
    for face, corners, image in zip(mesh.faces, texture.corners, texture.image_of_face, strict=True):
        data = texture.images[image].read_bytes() if image >= 0 else b""
        at = tuple(map(tuple, texture.coordinates[corners].round(6))) if image >= 0 else ()
        rows.append((tuple(map(tuple, mesh.vertices[face])), at, data))
    return sorted(rows)


@pytest.mark.parametrize("form", ["ply", "obj", "glb"])
def test_pictures_and_coordinates_come_back(form: str, tmp_path: Path) -> None:
    """Every corner keeps its coordinates, every face its picture, and the surface is not cut at the seams."""
    frames = []
    for number in range(2):
        here = tmp_path / f"in{number}"
        here.mkdir()
        images = (picture(here / "skin.png", (200 + number, 0, 0)), picture(here / "coat.jpg", (0, 0, 100)))
        frames.append(cube(images))
    write_mesh_frames(tmp_path / "out", frames, form=form, fps=25, count=2)  # type: ignore[arg-type]
    with open_mesh_frames(tmp_path / "out") as again:
        for mine, theirs in zip(frames, again, strict=True):
            assert len(theirs.vertices) == 8
            assert by_corner(theirs) == by_corner(mine)
            assert theirs.colours is None
            assert painted(theirs).colours is not None


def test_a_texture_file_at_vertices(tmp_path: Path) -> None:
    """Text PLY as some programs write it: s and t with each vertex."""
    picture(tmp_path / "skin.png", (9, 8, 7))
    for number in range(2):
        (tmp_path / f"{number}.ply").write_text(
            "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 3\nproperty float x\n"
            "property float y\nproperty float z\nproperty float s\nproperty float t\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0 0.1 0.5\n1 0 0 0.9 0.5\n0 0 1 0.1 0.9\n3 0 1 2\n"
        )
    mesh = open_mesh_frames(tmp_path)[1]
    assert painted(mesh).colours.tolist() == [[9, 8, 7], [255, 255, 255], [9, 8, 7]]  # type: ignore[union-attr]


def test_text_ply_with_polygons(tmp_path: Path) -> None:
    """A square and a triangle with coordinates at their corners; the second names a picture that is not there."""
    picture(tmp_path / "a.png", (1, 2, 3))
    for number in range(2):
        (tmp_path / f"{number}.ply").write_text(
            "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile gone.png\nelement vertex 5\n"
            "property float x\nproperty float y\nproperty float z\nelement face 2\n"
            "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n"
            "end_header\n0 0 0\n1 0 0\n1 0 1\n0 0 1\n2 0 1\n"
            "4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 1 4 2 6 0 0 1 0 1 1 1\n"
        )
    texture = open_mesh_frames(tmp_path)[0].texture
    assert texture is not None
    assert texture.image_of_face.tolist() == [0, 0, -1]
    assert texture.coordinates[texture.corners[1]].tolist() == [[0, 0], [1, 1], [0, 1]]


@pytest.mark.parametrize("name", ["../secret.png", "nothing.png", "\0"])
def test_a_strangers_header_names_no_file_outside(name: str, tmp_path: Path) -> None:
    """A picture outside the folder, or none, is no texture."""
    picture(tmp_path / "secret.png", (0, 0, 0))
    (tmp_path / "in").mkdir()
    for number in range(2):
        (tmp_path / "in" / f"{number}.ply").write_text(
            f"ply\nformat ascii 1.0\ncomment TextureFile {name}\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n"
        )
    assert open_mesh_frames(tmp_path / "in")[0].texture is None


def test_lists_of_coordinates_that_do_not_fit(tmp_path: Path) -> None:
    """One sentence that names the file."""
    picture(tmp_path / "a.png", (1, 2, 3))
    (tmp_path / "0.ply").write_text(
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "end_header\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2 4 0 0 1 1\n"
    )
    (tmp_path / "1.ply").write_bytes((tmp_path / "0.ply").read_bytes())
    with pytest.raises(InputError, match=r"0\.ply has texture coordinates"):
        open_mesh_frames(tmp_path)


def test_a_damaged_texture_in_a_glb(tmp_path: Path) -> None:
    """Changed bytes anywhere give a mesh or one sentence, never anything else."""
    image = picture(tmp_path / "skin.png", (200, 0, 0))
    write_mesh_frames(tmp_path / "out", [cube((image, image))] * 2, form="glb", fps=25, count=2)
    file = sorted((tmp_path / "out").iterdir())[0]
    whole = file.read_bytes()
    random = np.random.default_rng(5)
    for _ in range(150):
        data = bytearray(whole)
        data[int(random.integers(20, 1900))] = int(random.integers(32, 127))
        file.write_bytes(bytes(data))
        with contextlib.suppress(InputError), open_mesh_frames(tmp_path / "out") as frames:
            assert len(frames[0].vertices)


def test_a_glb_comes_out_as_it_went_in(tmp_path: Path) -> None:
    """Read and written again, the coordinates are the same to the bit."""
    image = picture(tmp_path / "skin.png", (200, 0, 0))
    write_mesh_frames(tmp_path / "a", [cube((image, image))] * 2, form="glb", fps=25, count=2)
    with open_mesh_frames(tmp_path / "a") as frames:
        write_mesh_frames(tmp_path / "b", frames, form="glb", fps=25, count=2)
        with open_mesh_frames(tmp_path / "b") as again:
            assert by_corner(again[1]) == by_corner(frames[1])
            first, second = frames[1].texture, again[1].texture
            assert first is not None
            assert second is not None
            assert set(map(tuple, first.coordinates)) == set(map(tuple, second.coordinates))


def test_a_still_reader_sees_the_same_surface(tmp_path: Path) -> None:
    """The GLB's triangles without the pictures, for whoever reads meshes alone."""
    image = picture(tmp_path / "skin.png", (200, 0, 0))
    write_mesh_frames(tmp_path / "out", [cube((image, image))] * 2, form="glb", fps=25, count=2)
    file = sorted((tmp_path / "out").iterdir())[0]
    mesh = read_glb(file, file.read_bytes())
    assert len(mesh.faces) == 12
    assert np.ptp(mesh.vertices, axis=0).tolist() == [1, 1, 1]


def test_equal_pictures_are_one_file_and_the_oldest_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The room keeps to its budget, but never fewer than it promises."""
    monkeypatch.setattr("app.formats.tvm.pictures.BUDGET", 100)
    monkeypatch.setattr("app.formats.tvm.pictures.KEPT", 2)
    room = PictureRoom()
    data = [b"\x89PNG\r\n\x1a\n" + bytes([k] * 60) for k in range(4)]
    first = room.put(data[0], "a")
    assert first is not None
    assert room.put(data[0], "b") == first
    assert room.put(b"GIF89a", "c") is None
    rest = [room.put(each, "a") for each in data[1:]]
    assert not first.exists()
    assert [each.read_bytes() for each in rest[1:] if each is not None] == data[2:]
    folder = first.parent.parent
    del room
    assert not folder.exists()
