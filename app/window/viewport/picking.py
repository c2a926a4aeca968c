"""Which vertex lies under the mouse: projected and compared in numpy, exact, without the graphics card."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.geometry import Camera

Array = NDArray[np.float64]
REACH = 10.0


def pick_vertex(
    camera: Camera, vertices: Array, faces: NDArray[np.int32], place: tuple[float, float], reach: float = REACH
) -> int | None:
    """The visible vertex nearest to a widget place, within reach pixels; None where there is none.

    A vertex is hidden if a triangle that it does not belong to covers it nearer to the camera.
    """
    local = vertices @ camera.R.T + camera.T
    image = local @ camera.K.T
    depth = local[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = image[:, :2] / image[:, 2:]
        away = (pixels[:, 0] - place[0]) ** 2 + (pixels[:, 1] - place[1]) ** 2
    found = np.flatnonzero((away <= reach**2) & (depth > 0))
    if not len(found):
        return None
    found = found[np.lexsort((depth[found], away[found]))]
    near = _triangles_near(pixels, depth, faces, place, reach)
    for vertex in found:
        if not _covered(int(vertex), pixels, depth, near):
            return int(vertex)
    return None


def _triangles_near(
    pixels: Array, depth: Array, faces: NDArray[np.int32], place: tuple[float, float], reach: float
) -> NDArray[np.int32]:
    """The triangles in front of the camera that may touch the circle's box."""
    x, y = pixels[:, 0], pixels[:, 1]
    with np.errstate(invalid="ignore"):
        outside = (x < place[0] - reach) | ((x > place[0] + reach).astype(np.uint8) << 1)
        outside |= ((y < place[1] - reach).astype(np.uint8) << 2) | ((y > place[1] + reach).astype(np.uint8) << 3)
    # A triangle misses the box for sure where all its corners lie beyond one and the same side.
    keep = (outside[faces[:, 0]] & outside[faces[:, 1]] & outside[faces[:, 2]]) == 0
    near = faces[keep]
    kept: NDArray[np.int32] = near[(depth[near] > 0).all(1)]
    return kept


def _covered(vertex: int, pixels: Array, depth: Array, triangles: NDArray[np.int32]) -> bool:
    others = triangles[(triangles != vertex).all(1)]
    a, b, c = (pixels[others[:, corner]] for corner in range(3))
    ab, ac, ap = b - a, c - a, pixels[vertex] - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    area = np.where(np.abs(area) < 1e-12, np.nan, area)
    v = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
    w = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
    inside = (v > 0) & (w > 0) & (v + w < 1)
    nearer = 1 / depth[others]
    inverse = nearer[:, 0] + v * (nearer[:, 1] - nearer[:, 0]) + w * (nearer[:, 2] - nearer[:, 0])
    return bool(np.any(inside & (inverse * depth[vertex] > 1.0 + 1e-3)))


def on_mesh(camera: Camera, vertices: Array, faces: NDArray[np.int32], place: tuple[float, float]) -> bool:
    """Whether a widget place lies on a triangle of the mesh."""
    local = vertices @ camera.R.T + camera.T
    image = local @ camera.K.T
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = image[:, :2] / image[:, 2:]
    corners = pixels[_triangles_near(pixels, local[:, 2], faces, place, 0.0)] - place
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    turns = np.stack([p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((a, b), (b, c), (c, a))])
    return bool(((turns >= 0).all(0) | (turns <= 0).all(0)).any())
