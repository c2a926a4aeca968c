"""Whether a mesh has an outside: then what faces away from the camera is never seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def is_closed(vertices: ArrayLike, faces: ArrayLike) -> bool:
    """Say whether triangles (m, 3) of vertices (v, 3) close a surface that is oriented outwards.

    Every edge has to be there exactly as often in the one direction as in the other; vertices in the same place count
    as one, so that seams of colours or textures do not open it.
    """
    points, corners = np.asarray(vertices), np.asarray(faces, np.int64).reshape(-1, 3)
    if not len(corners):
        return False
    welded = np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)[corners]
    welded = welded[(welded != np.roll(welded, 1, axis=1)).all(axis=1)]
    edges = np.concatenate([welded[:, [0, 1]], welded[:, [1, 2]], welded[:, [2, 0]]])
    count = len(points)
    there, back = np.sort(edges @ (count, 1)), np.sort(edges @ (1, count))
    if not np.array_equal(there, back):
        return False
    a, b, c = (points[corners[:, corner]].astype(np.float64) for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) > 0.0
