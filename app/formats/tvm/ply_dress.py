"""What a PLY wears: pictures named in its header by texture coordinates at vertices or corners, in and out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, fan
from app.formats.ply import fans, read_tables
from app.formats.tvm.frames import Texture
from imitation.errors import InputError

MARK = b"comment TextureFile "
_AT_VERTICES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))


def ply_texture(data: bytes, path: Path, mesh: MeshFile) -> Texture | None:
    """The pictures on a PLY whose geometry has been read already; None where its header names none that is there."""
    header = data[: data.find(b"end_header")]
    lines = [line for line in header.splitlines() if line.startswith(MARK)]
    if not lines:
        return None
    images = [_beside(path, line[len(MARK) :].decode("utf-8", "replace").strip()) for line in lines]
    if not any(images):
        return None
    tables = read_tables(data, path.name)
    try:
        coordinates, corners, number = _at_corners(tables) or _at_vertices(tables, mesh)
    except (ValueError, TypeError, IndexError) as error:
        raise InputError(f"The PLY file {path.name} has texture coordinates that cannot be understood.") from error
    if not len(coordinates) or len(corners) != len(mesh.faces):
        return None
    there = [image for image in images if image is not None]
    rank = np.array([-1 if image is None else there.index(image) for image in images], np.int32)
    known = (number >= 0) & (number < len(images))
    of_face = np.where(known, rank[np.where(known, number, 0)], -1).astype(np.int32)
    return Texture(coordinates, corners.astype(np.int32), tuple(there), of_face)


Found = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]


def _at_corners(tables: dict[str, dict[str, Any]]) -> Found | None:
    """Coordinates listed with each face (texcoord), a pair a corner, and the number of its picture (texnumber)."""
    face = tables.get("face", {})
    polygons = face.get("vertex_indices", face.get("vertex_index"))
    if polygons is None or "texcoord" not in face:
        return None
    pairs = face["texcoord"]
    counts = _lengths(polygons)
    if isinstance(pairs, np.ndarray):
        flat = pairs.reshape(-1).astype(np.float64)
    else:
        flat = np.concatenate([np.asarray(row, np.float64) for row in pairs]) if len(pairs) else np.zeros(0)
    if not np.array_equal(_lengths(pairs), 2 * counts):
        raise ValueError("texcoord")
    starts = np.cumsum(np.r_[0, counts[:-1]])
    if len(counts) and (counts == counts[0]).all():
        corners = fans(starts[:, None] + np.arange(counts[0]))
    else:
        corners = fan([list(range(a, a + n)) for a, n in zip(starts.tolist(), counts.tolist(), strict=True)])
    number = np.asarray(face.get("texnumber", np.zeros(len(counts))), np.int64)
    return flat.reshape(-1, 2), corners, np.repeat(number, np.maximum(counts - 2, 0))


def _lengths(lists: Any) -> NDArray[np.int64]:
    """How long each list is; equally long ones come as one array."""
    if isinstance(lists, np.ndarray):
        return np.full(len(lists), lists.shape[1], np.int64)
    return np.array([len(each) for each in lists], np.int64)


def _at_vertices(tables: dict[str, dict[str, Any]], mesh: MeshFile) -> Found:
    vertex = tables.get("vertex", {})
    for u, v in _AT_VERTICES:
        if u in vertex and v in vertex:
            places = np.stack([np.asarray(vertex[u], np.float64), np.asarray(vertex[v], np.float64)], axis=1)
            return places, mesh.faces.astype(np.int64), np.zeros(len(mesh.faces), np.int64)
    return np.zeros((0, 2)), np.zeros((0, 3), np.int64), np.zeros(0, np.int64)


def _beside(path: Path, name: str) -> Path | None:
    """A file inside the folder, wherever a stranger's name may lead."""
    try:
        file = (path.parent / name.replace("\\", "/")).resolve()
        return file if file.is_relative_to(path.parent.resolve()) and file.is_file() else None
    except (OSError, ValueError):
        return None


def write_dressed_ply(
    file: Path,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    colours: NDArray[np.uint8] | None,
    texture: Texture,
    names: list[str],
) -> None:
    """Write a binary PLY whose faces list their texture coordinates; the pictures lie beside it under ``names``."""
    fields = [(axis, "<f4") for axis in "xyz"]
    lines = ["ply", "format binary_little_endian 1.0", *(f"comment TextureFile {name}" for name in names)]
    lines += [f"element vertex {len(vertices)}", *(f"property float {axis}" for axis in "xyz")]
    if colours is not None:
        fields += [(channel, "u1") for channel in ("red", "green", "blue")]
        lines += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    lines += ["property list uchar float texcoord", "property int texnumber", "end_header", ""]
    table = np.zeros(len(vertices), fields)
    for k, axis in enumerate("xyz"):
        table[axis] = vertices[:, k]
    if colours is not None:
        for k, channel in enumerate(("red", "green", "blue")):
            table[channel] = colours[:, k]
    rows = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", (3,)), ("k", "u1"), ("t", "<f4", (6,)), ("number", "<i4")])
    known = np.where(texture.corners[:, :, None] >= 0, texture.coordinates[texture.corners], 0.0)
    rows["n"], rows["v"], rows["k"], rows["t"] = 3, faces, 6, known.reshape(-1, 6)
    rows["number"] = np.where((texture.corners >= 0).all(axis=1), texture.image_of_face, -1)
    with file.open("wb") as stream:
        stream.write("\n".join(lines).encode("utf-8"))
        stream.write(table.tobytes())
        stream.write(rows.tobytes())
