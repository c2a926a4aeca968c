"""Reading and writing STL, whose corners of equal position are one vertex."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile
from imitation.errors import InputError

_ROW = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(data: bytes, name: str) -> MeshFile:
    """Read an STL mesh, whose corners of equal position become one vertex, in order of first use."""
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    text = data[:5].lower() == b"solid" and b"facet" in data[:2000]
    if count >= 0 and len(data) == 84 + count * _ROW.itemsize:
        text = False
    if text:
        corners = _text(data, name)
    else:
        if count < 0 or len(data) < 84 + count * _ROW.itemsize:
            raise InputError(f"The STL file {name} is cut off or damaged: get a whole copy of it.")
        corners = np.frombuffer(data, _ROW, count, 84)["corners"].reshape(-1, 3).astype(np.float64)
    corners = corners + 0.0  # one zero, so that -0.0 is no other place
    unique, first, inverse = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    return MeshFile(unique[order], rank[inverse.reshape(-1)].reshape(-1, 3), None, None, name)


def write_stl(path: Path, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
    """Write a binary STL."""
    rows = np.zeros(len(faces), _ROW)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    rows["normal"] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    rows["corners"] = corners
    path.write_bytes(b"\0" * 80 + len(faces).to_bytes(4, "little") + rows.tobytes())


def _text(data: bytes, name: str) -> NDArray[np.float64]:
    words = [line.split() for line in data.splitlines()]
    try:
        places = [row[1:4] for row in words if row and row[0].lower() == b"vertex"]
        corners = np.array(places, dtype=object).astype(np.float64).reshape(-1, 3)
    except ValueError as error:
        raise InputError(f"The STL file {name} is cut off or damaged: get a whole copy of it.") from error
    if len(corners) % 3 or not any(row and row[0].lower() == b"endsolid" for row in words):
        raise InputError(f"The STL file {name} is cut off or damaged: get a whole copy of it.")
    return corners
