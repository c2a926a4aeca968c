"""Damaged sequences are refused in one sentence, whatever part of them is spoilt."""

from __future__ import annotations

import contextlib
import io
import json
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.formats.images import write_image
from app.formats.meshes import read_mesh
from app.formats.sequences import read_sequence, write_sequence
from app.formats.tvm import FrameMesh, Texture, open_mesh_frames, painted, write_mesh_frames
from imitation.errors import InputError

MESH = FrameMesh(
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float64),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32),
    np.full((4, 3), 90, np.uint8),
)


def respelt(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    """Change a GLB's JSON part, with the container right around it."""
    data = path.read_bytes()
    size = struct.unpack("<I", data[12:16])[0]
    tree = json.loads(data[20 : 20 + size])
    change(tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    path.write_bytes(data[:8] + struct.pack("<II", 20 + len(text) + len(rest), len(text)) + data[16:20] + text + rest)


@pytest.mark.parametrize(
    "place",
    [
        ("materials", 0),
        ("materials", 0, "pbrMetallicRoughness"),
        ("meshes", 0, "primitives", 0),
        ("meshes", 0, "primitives", 0, "attributes"),
        ("accessors", 0),
        ("bufferViews", 0),
        ("nodes", 0),
    ],
)
@pytest.mark.parametrize("value", [None, 1.5, "x", [], True])
def test_a_glb_with_something_else_where_a_table_should_be(place: tuple[Any, ...], value: Any, tmp_path: Path) -> None:
    """No message of Python's reaches the user; what does not matter to the surface may be read over."""
    write_mesh_frames(tmp_path / "film", [MESH, MESH], form="glb", fps=25, count=2)

    def spoil(tree: dict[str, Any]) -> None:
        at: Any = tree
        for key in place[:-1]:
            at = at[key]
        at[place[-1]] = value

    for path in sorted((tmp_path / "film").iterdir()):
        respelt(path, spoil)
    # Anything but a refusal in our own words, or the whole surface, fails here.
    with contextlib.suppress(InputError), open_mesh_frames(tmp_path / "film") as frames:
        assert len(frames[1].vertices) == 4


@pytest.mark.parametrize("header", [b"{'descr': ('<f4', 'fortran_order': False\n", b"(((((\n", b"{}\n"])
def test_an_npz_whose_headers_are_no_python(header: bytes, tmp_path: Path) -> None:
    """What numpy says of headers it cannot parse does not reach the user."""
    array = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("vertices.npy", array)
        archive.writestr("faces.npy", array)
    (tmp_path / "film.npz").write_bytes(packed.getvalue())
    with pytest.raises(InputError, match="not an npz of vertices"):
        open_mesh_frames(tmp_path / "film.npz")


@pytest.mark.parametrize("part", ["vertices", "faces", "fps", "colors", "name"])
@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"no array",
        b"\x93NUMPY\x01\x00" + struct.pack("<H", 10) + b"(((((((((\n",
        b"\x93NUMPY\x01\x00\x56\x00{'descr': '<f4', 'fortran_order': False, 'shape': (14999999999985, 3, 3)}".ljust(96),
        np.zeros(0),
        np.array(b"x"),
        np.array("x"),
        np.array(np.nan),
        np.full((2, 2), 7 + 1j),
        np.zeros((2, 4, 3, 1)),
    ],
)
def test_a_character_npz_of_any_content(part: str, content: Any, tmp_path: Path) -> None:
    """One part is something else: read where it does not matter, or refused in one sentence."""
    places = np.zeros((2, 4, 3), np.float32) + MESH.vertices
    write_sequence(tmp_path / "good.npz", places, MESH.faces, 25, colors=MESH.colours, name="wolf")
    if isinstance(content, np.ndarray):
        packed = io.BytesIO()
        np.lib.format.write_array(packed, content)
        content = packed.getvalue()
    with zipfile.ZipFile(tmp_path / "good.npz") as good, zipfile.ZipFile(tmp_path / "film.npz", "w") as spoilt:
        for name in good.namelist():
            spoilt.writestr(name, content if name == f"{part}.npy" else good.read(name))
    with contextlib.suppress(InputError):
        assert len(read_sequence(tmp_path / "film.npz")) == 2


@pytest.mark.parametrize("part", ["up", "name"])
def test_an_npz_with_text_of_impossible_characters(part: str, tmp_path: Path) -> None:
    """Beyond the last character there is, Python has no message of its own but a SystemError."""
    places = np.zeros((2, 4, 3), np.float32) + MESH.vertices
    text = np.array([0x7FFFFFFF], "<u4").view("<U1")
    np.savez(tmp_path / "film.npz", vertices=places, faces=MESH.faces, fps=[25, 1], **{part: text})
    with contextlib.suppress(InputError):
        assert len(read_sequence(tmp_path / "film.npz")) == 2
    with contextlib.suppress(InputError), open_mesh_frames(tmp_path / "film.npz") as frames:
        assert len(frames) == 2


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_character_npz_whose_compressed_bytes_are_spoilt(method: int, tmp_path: Path) -> None:
    """Each decompressor has exceptions of its own."""
    places = np.random.default_rng(0).random((2, 400, 3)).astype(np.float32)
    packed = io.BytesIO()
    np.lib.format.write_array(packed, places)
    with zipfile.ZipFile(tmp_path / "film.npz", "w", method) as archive:
        archive.writestr("vertices.npy", packed.getvalue())
    data = bytearray((tmp_path / "film.npz").read_bytes())
    data[200:1200] = bytes(range(250)) * 4
    (tmp_path / "film.npz").write_bytes(data)
    with pytest.raises(InputError, match="not an npz of vertices"):
        read_sequence(tmp_path / "film.npz")


def test_a_glb_whose_extensions_and_asset_are_no_tables(tmp_path: Path) -> None:
    """What the file says of itself may be anything."""
    places = np.stack([MESH.vertices, MESH.vertices + 1.0])
    for key, value in (("extensionsRequired", 1.5), ("extensionsRequired", [3]), ("asset", 1), ("asset", None)):
        write_sequence(tmp_path / "film.glb", places, MESH.faces, 25)
        respelt(tmp_path / "film.glb", lambda tree, key=key, value=value: tree.update({key: value}))
        with contextlib.suppress(InputError):
            assert len(read_sequence(tmp_path / "film.glb")) == 2


def test_a_glb_with_fewer_colours_than_vertices(tmp_path: Path) -> None:
    """Colours of another length would fail where they are drawn."""
    write_mesh_frames(tmp_path / "film", [MESH, MESH], form="glb", fps=25, count=2)

    def shorten(tree: dict[str, Any]) -> None:
        number = tree["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
        tree["accessors"][number]["count"] = 3

    for path in sorted((tmp_path / "film").iterdir()):
        respelt(path, shorten)
    with pytest.raises(InputError, match="not a whole GLB"):
        open_mesh_frames(tmp_path / "film")


def test_texture_coordinates_that_are_no_numbers_are_painted(tmp_path: Path) -> None:
    """The rest of the surface keeps its colours."""
    write_image(tmp_path / "coat.png", np.full((4, 4, 3), (10, 200, 30), np.uint8))
    where = np.array([[0.5, np.nan], [np.inf, 0.5], [0.2, 0.2], [1e300, -1e300]])
    worn = Texture(where, MESH.faces, (tmp_path / "coat.png",), np.zeros(4, np.int32))
    colours = painted(FrameMesh(MESH.vertices, MESH.faces, None, worn)).colours
    assert colours is not None
    assert colours.tolist() == [[10, 200, 30]] * 4


@pytest.mark.parametrize("corner", ["99999999999999999999", "-1", "1e30", "nan", "4294967296", "1.5"])
def test_a_text_ply_with_impossible_corners(corner: str, tmp_path: Path) -> None:
    """Numbers that no integer holds, in faces of different length."""
    lines = ["ply", "format ascii 1.0", "element vertex 4", *(f"property float {axis}" for axis in "xyz")]
    lines += ["element face 2", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(str(value) for value in place) for place in MESH.vertices.tolist()]
    (tmp_path / "mesh.ply").write_text("\n".join([*lines, f"3 0 1 {corner}", "4 0 1 2 3", ""]))
    with contextlib.suppress(InputError):
        assert read_mesh(tmp_path / "mesh.ply").faces.max() < 4


def test_an_npz_of_no_rates(tmp_path: Path) -> None:
    """A rate without a value."""
    places = np.zeros((2, 4, 3), np.float32) + MESH.vertices
    np.savez(tmp_path / "film.npz", vertices=places, faces=MESH.faces, fps=np.zeros(0))
    with pytest.raises(InputError, match="not an npz of vertices"):
        open_mesh_frames(tmp_path / "film.npz")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.99])
def test_a_truncated_usd_stage(share: float, tmp_path: Path) -> None:
    """The library's own exceptions do not reach the user."""
    pytest.importorskip("pxr")
    write_mesh_frames(tmp_path / "film.usdc", [MESH, MESH], form="usd", fps=25, count=2)
    data = (tmp_path / "film.usdc").read_bytes()
    (tmp_path / "film.usdc").write_bytes(data[: int(share * len(data))])
    with pytest.raises(InputError):
        open_mesh_frames(tmp_path / "film.usdc")
