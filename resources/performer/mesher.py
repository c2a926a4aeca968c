"""Capsules to a closed triangle mesh with colours, by marching cubes on a grid with a random offset."""

from __future__ import annotations

import functools

import numpy as np
from numba import njit
from numpy.typing import NDArray

from resources.performer.cube_table import EDGES, cube_triangles
from resources.performer.skeleton import MATERIALS

SHARPNESS = 45.0
"""1/m: the field is the sum of exp(-SHARPNESS * distance to a capsule), its surface where the sum is 1."""
REACH = 0.11
PALETTE = np.array([[222, 178, 148], [58, 112, 150], [62, 60, 70], [214, 208, 196], [70, 48, 38]], float)


@functools.cache
def _triangles() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    return cube_triangles()


@njit(cache=True, nogil=True)
def nearest_capsule(points, capsules):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Row of the capsule whose surface is nearest to each point (n, 3)."""
    nearest = np.zeros(len(points), np.int64)
    for i in range(len(points)):
        least = 1e30
        for row in range(len(capsules)):
            distance = _distance(points[i, 0], points[i, 1], points[i, 2], capsules[row])
            if distance < least:
                least = distance
                nearest[i] = row
    return nearest


@njit(cache=True, nogil=True, inline="always")
def _distance(x, y, z, capsule):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Distance to the surface of a tapered capsule, negative inside."""
    ax, ay, az = x - capsule[0], y - capsule[1], z - capsule[2]
    bx, by, bz = capsule[3] - capsule[0], capsule[4] - capsule[1], capsule[5] - capsule[2]
    along = (ax * bx + ay * by + az * bz) / (bx * bx + by * by + bz * bz + 1e-12)
    along = min(max(along, 0.0), 1.0)
    dx, dy, dz = ax - along * bx, ay - along * by, az - along * bz
    return np.sqrt(dx * dx + dy * dy + dz * dz) - capsule[6] - along * (capsule[7] - capsule[6])


@njit(cache=True, nogil=True, inline="always")
def _bump(x, y, z, bumps):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Sum of plane waves: each row of bumps is a wave vector (3), a phase and an amplitude in metres."""
    total = 0.0
    for row in range(len(bumps)):
        total += bumps[row, 4] * np.sin(bumps[row, 0] * x + bumps[row, 1] * y + bumps[row, 2] * z + bumps[row, 3])
    return total


@njit(cache=True, nogil=True)
def _grid(capsules, bumps, origin, shape, cell):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Smooth distance on the grid's nodes; nodes out of every capsule's reach stay positive."""
    total = np.zeros(shape)
    low, high = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for row in range(len(capsules)):
        widest = max(capsules[row, 6], capsules[row, 7]) + REACH
        for k in range(3):
            first, last = min(capsules[row, k], capsules[row, 3 + k]), max(capsules[row, k], capsules[row, 3 + k])
            low[k] = max(0, int(np.floor((first - widest - origin[k]) / cell)))
            high[k] = min(shape[k], int(np.ceil((last + widest - origin[k]) / cell)) + 1)
        for i in range(low[0], high[0]):
            for j in range(low[1], high[1]):
                for k in range(low[2], high[2]):
                    distance = _distance(
                        origin[0] + cell * i, origin[1] + cell * j, origin[2] + cell * k, capsules[row]
                    )
                    if distance < REACH:
                        total[i, j, k] += np.exp(-SHARPNESS * distance)
    for i in range(shape[0]):
        for j in range(shape[1]):
            for k in range(shape[2]):
                if total[i, j, k] < 1e-3:
                    total[i, j, k] = REACH
                else:
                    bump = _bump(origin[0] + cell * i, origin[1] + cell * j, origin[2] + cell * k, bumps)
                    total[i, j, k] = -np.log(total[i, j, k]) / SHARPNESS - bump
    return total


@njit(cache=True, nogil=True)
def _march(field, origin, cell, edges, triangles, counts):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Marching cubes with shared vertices."""
    nx, ny, nz = field.shape
    index = np.full((nx, ny, nz, 3), -1, np.int32)
    vertices = np.empty((4096, 3))
    count = 0
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                f = field[i, j, k]
                for axis in range(3):
                    a, b, c = i + (axis == 0), j + (axis == 1), k + (axis == 2)
                    if a == nx or b == ny or c == nz or (f < 0.0) == (field[a, b, c] < 0.0):
                        continue
                    t = f / (f - field[a, b, c])
                    if count == len(vertices):
                        vertices = np.concatenate((vertices, np.empty_like(vertices)))
                    vertices[count, 0] = origin[0] + cell * (i + t * (axis == 0))
                    vertices[count, 1] = origin[1] + cell * (j + t * (axis == 1))
                    vertices[count, 2] = origin[2] + cell * (k + t * (axis == 2))
                    index[i, j, k, axis] = count
                    count += 1
    faces = np.empty((2 * count + 64, 3), np.int32)
    used = 0
    for i in range(nx - 1):
        for j in range(ny - 1):
            for k in range(nz - 1):
                code = 0
                for corner in range(8):
                    code |= (field[i + (corner & 1), j + ((corner >> 1) & 1), k + (corner >> 2)] < 0.0) << corner
                for row in range(counts[code]):
                    if used == len(faces):
                        faces = np.concatenate((faces, np.empty_like(faces)))
                    for side in range(3):
                        edge = triangles[code, row, side]
                        a = edges[edge, 0]
                        faces[used, side] = index[i + (a & 1), j + ((a >> 1) & 1), k + (a >> 2), edge // 4]
                    used += 1
    return vertices[:count].copy(), faces[:used].copy()


def body_mesh(
    capsules: NDArray[np.float64],
    *,
    cell: float = 0.028,
    offset: NDArray[np.float64] | None = None,
    bumps: NDArray[np.float64] | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.uint8]]:
    """Mesh the smooth union of capsules on a grid of its own.

    Parameters
    ----------
    capsules : (c, 8) float64
        What ``body_capsules`` gives (world, metres).
    cell : float
        Edge of a grid cell in metres: about the mesh's edge length.
    offset : (3,) float64, optional
        Shift of the grid in cells, so that two meshes of one pose share no vertex.
    bumps : (b, 5) float64, optional
        Plane waves on the surface: wave vector (1/m), phase, amplitude (m).

    Returns
    -------
    vertices (v, 3) float64, faces (m, 3) int32, colours (v, 3) uint8
        Closed, normals outwards; each vertex on an edge of the grid.
    """
    waves = np.zeros((0, 5)) if bumps is None else bumps
    shift = np.zeros(3) if offset is None else np.asarray(offset, float)
    widest = np.maximum(capsules[:, 6], capsules[:, 7])[:, None] + 0.04
    low = np.minimum(capsules[:, :3] - widest, capsules[:, 3:6] - widest).min(axis=0) - cell * (2 + shift)
    high = np.maximum(capsules[:, :3] + widest, capsules[:, 3:6] + widest).max(axis=0) + 2 * cell
    shape = tuple(int(n) for n in np.ceil((high - low) / cell) + 2)
    field = _grid(capsules, waves, low, shape, cell)
    vertices, faces = _march(field, low, cell, np.array(EDGES), *_triangles())
    nearest = nearest_capsule(vertices, capsules)
    return vertices, faces, _colours(capsules, vertices, nearest)


def _colours(
    capsules: NDArray[np.float64], vertices: NDArray[np.float64], nearest: NDArray[np.int64]
) -> NDArray[np.uint8]:
    """Material colours with bands along each limb, so that a texture sticks to the body."""
    colour = PALETTE[MATERIALS[np.minimum(nearest, len(MATERIALS) - 1)]]
    axis = capsules[nearest, 3:6] - capsules[nearest, :3]
    along = ((vertices - capsules[nearest, :3]) * axis).sum(axis=1) / (np.linalg.norm(axis, axis=1) + 1e-9)
    shade = 1.0 + 0.10 * np.sin(along / 0.05 * np.pi)
    return np.asarray(np.clip(colour * shade[:, None], 0, 255), np.uint8)
