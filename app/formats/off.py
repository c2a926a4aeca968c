"""Reading and writing OFF, with COFF's colours."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, fan, to_int32
from imitation.errors import InputError


def read_off(data: bytes, name: str) -> MeshFile:
    """Read an OFF or COFF mesh; see read_mesh."""
    lines = [line for raw in data.splitlines() if (line := raw.split(b"#", 1)[0].split())]
    head = re.fullmatch(rb"(ST)?(C)?(N)?(4)?(n)?OFF", lines[0][0]) if lines else None
    if head is None or head[4] or head[5]:
        raise InputError(f"The file {name} is not an OFF mesh: its first line must be OFF.")
    if len(lines[0]) > 1:
        lines.insert(1, lines[0][1:])
    try:
        vertex_count, face_count = int(lines[1][0]), int(lines[1][1])
        if min(vertex_count, face_count) < 0 or len(lines) < 2 + vertex_count + face_count:
            raise ValueError
        rows = lines[2 : 2 + vertex_count]
        vertices = np.array([row[:3] for row in rows], dtype=object).astype(np.float64).reshape(-1, 3)
        polygons = []
        for row in lines[2 + vertex_count : 2 + vertex_count + face_count]:
            corners = [int(word) for word in row[1 : 1 + int(row[0])]]
            if len(corners) != int(row[0]):
                raise ValueError
            polygons.append(corners)
        faces = to_int32(fan(polygons), name)
        colors = _colors(rows, 6 if head[3] else 3) if head[2] else None
    except (ValueError, IndexError, OverflowError) as error:
        raise InputError(f"The OFF file {name} is cut off or damaged: get a whole copy of it.") from error
    return MeshFile(vertices, faces, colors, None, name)


def write_off(
    path: Path, vertices: NDArray[np.float64], faces: NDArray[np.int32], colors: NDArray[np.uint8] | None = None
) -> None:
    """Write an OFF mesh, COFF with colours; positions with 9 digits."""
    lines = ["OFF" if colors is None else "COFF", f"{len(vertices)} {len(faces)} 0"]
    if colors is None:
        lines += ["{:.9g} {:.9g} {:.9g}".format(*vertex) for vertex in vertices.tolist()]
    else:
        pairs = zip(vertices.tolist(), colors.tolist(), strict=True)
        lines += ["{:.9g} {:.9g} {:.9g} {} {} {} 255".format(*vertex, *color) for vertex, color in pairs]
    lines += ["3 {} {} {}".format(*face) for face in faces.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _colors(rows: list[list[bytes]], first: int) -> NDArray[np.uint8] | None:
    if any(len(row) < first + 3 for row in rows):
        return None
    words = [row[first : first + 3] for row in rows]
    values = np.array(words, dtype=object).astype(np.float64).reshape(-1, 3)
    if any(b"." in word for row in words for word in row):
        values = np.rint(values * 255)
    return np.clip(values, 0, 255).astype(np.uint8)
