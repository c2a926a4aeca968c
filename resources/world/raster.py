"""A z-buffer, compiled: which triangle a sample sees, at what depth, from a camera or along parallel light."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.geometry.projection import Camera
from resources.world.skeleton import Array

Ids = NDArray[np.int32]


@njit(cache=True, nogil=True)
def _setup(points, faces, ss):  # type: ignore[no-untyped-def]
    """Inverse (m, 3, 3) of the matrix whose columns are the image points of each triangle's corners.

    Applied to (x, y, 1) it gives barycentric coordinates divided by depth, so that no clipping is needed.
    """
    m = len(faces)
    inverse = np.zeros((m, 3, 3))
    for t in range(m):
        a, b, c = points[faces[t, 0]], points[faces[t, 1]], points[faces[t, 2]]
        if a[2] <= 0 and b[2] <= 0 and c[2] <= 0:
            continue
        bc = np.array([b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]])
        det = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2]
        if abs(det) < 1e-12:
            continue
        inverse[t, 0] = bc / det
        inverse[t, 1, 0] = (c[1] * a[2] - c[2] * a[1]) / det
        inverse[t, 1, 1] = (c[2] * a[0] - c[0] * a[2]) / det
        inverse[t, 1, 2] = (c[0] * a[1] - c[1] * a[0]) / det
        inverse[t, 2, 0] = (a[1] * b[2] - a[2] * b[1]) / det
        inverse[t, 2, 1] = (a[2] * b[0] - a[0] * b[2]) / det
        inverse[t, 2, 2] = (a[0] * b[1] - a[1] * b[0]) / det
    return inverse


@njit(cache=True, nogil=True)
def _fill(points, faces, inverse, ss, near, closeness, ids, offset):  # type: ignore[no-untyped-def]
    height, width = ids.shape
    for t in range(len(faces)):
        m = inverse[t]
        if m[0, 0] == 0 and m[1, 0] == 0 and m[2, 0] == 0 and m[0, 1] == 0 and m[1, 1] == 0 and m[2, 1] == 0:
            continue
        x0, x1, y0, y1 = 0, width - 1, 0, height - 1
        behind = False
        lx, hx, ly, hy = 1e18, -1e18, 1e18, -1e18
        for i in range(3):
            p = points[faces[t, i]]
            if p[2] <= near:
                behind = True
                break
            x, y = p[0] / p[2], p[1] / p[2]
            lx, hx, ly, hy = min(lx, x), max(hx, x), min(ly, y), max(hy, y)
        if not behind:
            if hx < -1 or hy < -1 or lx > width / ss + 1 or ly > height / ss + 1:
                continue
            x0 = max(x0, int(np.ceil((lx + 0.5) * ss - 0.5)))
            x1 = min(x1, int(np.floor((hx + 0.5) * ss - 0.5)))
            y0 = max(y0, int(np.ceil((ly + 0.5) * ss - 0.5)))
            y1 = min(y1, int(np.floor((hy + 0.5) * ss - 0.5)))
        for row in range(y0, y1 + 1):
            v = (row + 0.5) / ss - 0.5
            b0, b1, b2 = m[0, 1] * v + m[0, 2], m[1, 1] * v + m[1, 2], m[2, 1] * v + m[2, 2]
            for column in range(x0, x1 + 1):
                u = (column + 0.5) / ss - 0.5
                c0, c1, c2 = m[0, 0] * u + b0, m[1, 0] * u + b1, m[2, 0] * u + b2
                if c0 >= 0 and c1 >= 0 and c2 >= 0:
                    close = c0 + c1 + c2
                    if close > closeness[row, column] and close * near < 1:
                        closeness[row, column] = close
                        ids[row, column] = t + offset


def image_points(vertices: Array, camera: Camera) -> Array:
    """``K (R X + T)`` (n, 3) of world points (n, 3): pixels times depth."""
    points: Array = (vertices @ camera.R.T + camera.T) @ camera.K.T
    return np.ascontiguousarray(points)


def rasterise(
    vertices: Array, faces: Ids, camera: Camera, size: tuple[int, int], ss: int = 1, near: float = 0.05
) -> tuple[Array, Ids, Array]:
    """See triangles through a camera.

    Parameters
    ----------
    size : (width, height) of the picture; each pixel is sampled ``ss`` x ``ss`` times, once in its centre where 1.

    Returns
    -------
    closeness : (h ss, w ss) one over camera z, 0 where nothing is seen. ids : the triangle seen, -1 for none.
    inverse : (m, 3, 3) barycentric coordinates over depth from (x, y, 1), for each triangle.
    """
    points = image_points(vertices, camera)
    inverse = _setup(points, faces, ss)
    closeness = np.zeros((size[1] * ss, size[0] * ss))
    ids = np.full(closeness.shape, -1, np.int32)
    _fill(points, faces, inverse, ss, near, closeness, ids, 0)
    return closeness, ids, inverse


@njit(cache=True, nogil=True)
def fill_light(points, faces, nearest):  # type: ignore[no-untyped-def]
    """Draw triangles into a map (h, w) of the height nearest to the light; points are (column, row, height)."""
    height, width = nearest.shape
    for t in range(len(faces)):
        a, b, c = points[faces[t, 0]], points[faces[t, 1]], points[faces[t, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        x0 = max(0, int(np.ceil(min(a[0], b[0], c[0]))))
        x1 = min(width - 1, int(np.floor(max(a[0], b[0], c[0]))))
        y0 = max(0, int(np.ceil(min(a[1], b[1], c[1]))))
        y1 = min(height - 1, int(np.floor(max(a[1], b[1], c[1]))))
        for row in range(y0, y1 + 1):
            for column in range(x0, x1 + 1):
                w1 = ((column - a[0]) * (c[1] - a[1]) - (row - a[1]) * (c[0] - a[0])) / area
                w2 = ((b[0] - a[0]) * (row - a[1]) - (b[1] - a[1]) * (column - a[0])) / area
                if w1 >= 0 and w2 >= 0 and w1 + w2 <= 1:
                    h = a[2] + w1 * (b[2] - a[2]) + w2 * (c[2] - a[2])
                    if h > nearest[row, column]:
                        nearest[row, column] = h
