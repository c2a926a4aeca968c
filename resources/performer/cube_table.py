"""The triangles of marching cubes, derived rather than pasted: loops of crossed edges around a cube's faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Corner k of a cube stands at (k & 1, k >> 1 & 1, k >> 2); an edge is a pair of corners along one axis.
EDGES = tuple((a, a | 1 << axis) for axis in range(3) for a in range(8) if not a >> axis & 1)
MOST = 12
"""Loops cut into fans of triangles: at most four loops or one of seven edges, never more than twelve triangles."""


def _faces() -> list[tuple[int, int, int, int]]:
    """The six faces as corners in turn, counter-clockwise seen from outside."""
    faces = []
    for axis in range(3):
        u, v = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        for side in (0, 1 << axis):
            ring = (side, side | u, side | u | v, side | v)
            faces.append(ring if side else ring[::-1])
    return faces


def cube_triangles() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Triangles of each of the 256 cubes.

    Returns
    -------
    triangles (256, 12, 3) int64
        Edge numbers (rows of ``EDGES``), normals from inside to outside; bit k of the row says that corner k is inside.
    counts (256,) int64
        How many of the twelve are used.
    """
    edge_of = {frozenset(pair): number for number, pair in enumerate(EDGES)}
    triangles, counts = np.zeros((256, MOST, 3), np.int64), np.zeros(256, np.int64)
    for code in range(256):
        after: dict[int, int] = {}
        for ring in _faces():
            inside = [code >> corner & 1 for corner in ring]
            for k in range(4):
                # The surface leaves the face where the ring comes out of the inside and comes back where it last went
                # in: inside corners of a doubtful face stay apart, in both cubes that share it, hence no holes.
                if inside[k] and not inside[(k + 1) % 4]:
                    back = k
                    while inside[back]:
                        back = (back - 1) % 4
                    leave = edge_of[frozenset((ring[k], ring[(k + 1) % 4]))]
                    enter = edge_of[frozenset((ring[back], ring[(back + 1) % 4]))]
                    after[enter] = leave
        while after:
            first, edge = after.popitem()
            loop = [first]
            while edge != first:
                loop.append(edge)
                edge = after.pop(edge)
            for k in range(1, len(loop) - 1):
                triangles[code, counts[code]] = loop[0], loop[k], loop[k + 1]
                counts[code] += 1
    return triangles, counts
