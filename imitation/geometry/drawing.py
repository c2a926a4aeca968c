"""What drawing wants to know of a mesh that changes in every frame: one pass each, free of the interpreter's lock."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def drawn_normals(vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> NDArray[np.float32]:
    """Unit normals (v, 3) at vertices (v, 3) of triangles (m, 3), faces weighted by area; zero where no face meets."""
    normals = np.zeros(vertices.shape, np.float32)
    for face in range(len(faces)):
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        x1, x2 = vertices[b, 0] - vertices[a, 0], vertices[c, 0] - vertices[a, 0]
        y1, y2 = vertices[b, 1] - vertices[a, 1], vertices[c, 1] - vertices[a, 1]
        z1, z2 = vertices[b, 2] - vertices[a, 2], vertices[c, 2] - vertices[a, 2]
        x, y, z = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
        for corner in (a, b, c):
            normals[corner, 0] += x
            normals[corner, 1] += y
            normals[corner, 2] += z
    for vertex in range(len(normals)):
        x, y, z = normals[vertex, 0], normals[vertex, 1], normals[vertex, 2]
        length = np.sqrt(x * x + y * y + z * z)
        if length > 0:
            normals[vertex, 0], normals[vertex, 1], normals[vertex, 2] = x / length, y / length, z / length
    return normals


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def hides_its_inside(vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> bool:
    """Whether triangles (m, 3) close a surface that is oriented outwards, so that its inside is never seen.

    Every edge has to be there as often in the one direction as in the other. That is told by a sum of mixed bits
    which each pair takes back, exact but for one mesh in 2^64; vertices in the same place count as two.
    """
    if len(faces) == 0:
        return False
    balance = np.uint64(0)
    volume = 0.0
    for face in range(len(faces)):
        for corner in range(3):
            a, b = np.uint64(faces[face, corner]), np.uint64(faces[face, (corner + 1) % 3])
            balance += _mixed(a << np.uint64(32) | b) - _mixed(b << np.uint64(32) | a)
        a3, b3, c3 = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        volume += a3[0] * (b3[1] * c3[2] - b3[2] * c3[1])
        volume += a3[1] * (b3[2] * c3[0] - b3[0] * c3[2])
        volume += a3[2] * (b3[0] * c3[1] - b3[1] * c3[0])
    return balance == np.uint64(0) and volume > 0.0


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _mixed(value: np.uint64) -> np.uint64:
    """Bits of a number, so mixed that sums of different ones do not meet."""
    value = (value ^ (value >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    value = (value ^ (value >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return value ^ (value >> np.uint64(31))
