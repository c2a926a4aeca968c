"""The sample's character files: binary PLY with vertex colours, just what the sample needs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from resources.world.skeleton import Array

VERTEX = np.dtype([("place", "<f4", 3), ("colour", "u1", 3)])
FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def write(path: Path, vertices: Array, faces: NDArray[np.int32], colours: NDArray[np.uint8]) -> None:
    """Write a mesh; vertices (n, 3), faces (m, 3), colours (n, 3)."""
    head = ["ply", "format binary_little_endian 1.0", "comment a character of the Motionwright sample"]
    head += [f"element vertex {len(vertices)}", *(f"property float {c}" for c in "xyz")]
    head += [f"property uchar {c}" for c in ("red", "green", "blue")]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    points, corners = np.zeros(len(vertices), VERTEX), np.zeros(len(faces), FACE)
    points["place"], points["colour"] = vertices, colours
    corners["count"], corners["corners"] = 3, faces
    path.write_bytes("\n".join(head).encode() + b"\n" + points.tobytes() + corners.tobytes())


def read(path: Path) -> tuple[Array, NDArray[np.int32], NDArray[np.uint8]]:
    """Read a file that ``write`` wrote: vertices (n, 3), faces (m, 3), colours (n, 3)."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts = [int(line.split()[2]) for line in data[:end].decode().splitlines() if line.startswith("element")]
    points = np.frombuffer(data, VERTEX, counts[0], end)
    corners = np.frombuffer(data, FACE, counts[1], end + counts[0] * VERTEX.itemsize)
    return points["place"].astype(np.float64), corners["corners"].astype(np.int32), points["colour"].copy()
