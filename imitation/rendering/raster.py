# mypy: disable-error-code="untyped-decorator"
"""A z-buffer rasteriser: which triangle each sample of a picture sees, exactly where the camera model says.

No graphics driver takes part, so pictures do not depend on one. Edge functions are taken in homogeneous
coordinates: a triangle that reaches behind the camera needs no clipping.
"""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.geometry.projection import Camera


@attrs.frozen(eq=False)
class Seen:
    """What each sample of a picture (h, w) sees.

    Attributes
    ----------
    depth : float32 (h, w) camera z, inf where nothing is seen.
    face : int32 (h, w) the triangle, -1 where nothing is seen.
    weights : float32 (h, w, 2) barycentric weights of the triangle's first two corners.
    """

    depth: NDArray[np.float32]
    face: NDArray[np.int32]
    weights: NDArray[np.float32]


def rasterise(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    camera: Camera,
    size: tuple[int, int],
    samples: int = 1,
) -> Seen:
    """Find the triangle that each sample of a picture sees.

    Parameters
    ----------
    vertices : (n, 3) world positions.
    faces : (m, 3) vertex indices.
    camera : the picture's camera, pixel centres at integers.
    size : (width, height) in pixels.
    samples : samples along each side of a pixel; the result has samples * height rows.
    """
    width, height = size[0] * samples, size[1] * samples
    # Sample k of pixel u lies at u + (k + .5) / samples - .5.
    finer = np.array([[samples, 0, (samples - 1) / 2], [0, samples, (samples - 1) / 2], [0, 0, 1.0]])
    K = finer @ camera.K
    depth = np.full((height, width), np.inf, np.float32)
    face = np.full((height, width), -1, np.int32)
    weights = np.zeros((height, width, 2), np.float32)
    local, near = _seen_from(vertices, camera)
    corners = np.ascontiguousarray(faces, np.int32)
    _fill(local, corners, K, np.linalg.inv(K), near, depth, depth[:0], face, weights)
    return Seen(depth, face, weights)


def depths(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], camera: Camera, size: tuple[int, int]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth (h, w) of the nearest and of the farthest surface at each pixel; inf and -inf where nothing is seen.

    Parameters
    ----------
    vertices, faces, camera, size : see ``rasterise``.
    """
    nearest = np.full((size[1], size[0]), np.inf, np.float32)
    farthest = np.full((size[1], size[0]), -np.inf, np.float32)
    local, near = _seen_from(vertices, camera)
    none, corners = np.empty((0, 0), np.int32), np.ascontiguousarray(faces, np.int32)
    K = np.ascontiguousarray(camera.K)
    _fill(local, corners, K, np.linalg.inv(K), near, nearest, farthest, none, np.empty((0, 0, 2), np.float32))
    return nearest, farthest


def _seen_from(vertices: NDArray[np.float64], camera: Camera) -> tuple[NDArray[np.float64], float]:
    """Vertices (n, 3) as the camera has them, and from which depth on a surface counts."""
    local = np.ascontiguousarray(vertices @ camera.R.T + camera.T)
    return local, 1e-3 * max(float(np.abs(local[:, 2]).max(initial=0.0)), 1e-9)


@njit(cache=True, nogil=True)
def _fill(
    local: Any, faces: Any, K: Any, inverse: Any, near: float, depth: Any, farthest: Any, face: Any, weights: Any
) -> None:
    """Nearest surfaces of all samples (h, w), and, each where its array is not empty, farthest ones, faces, weights."""
    both, named = farthest.size > 0, face.size > 0
    height, width = depth.shape
    edge = np.empty((3, 3))
    normal = np.empty((3, 3))
    for f in range(faces.shape[0]):
        determinant = 0.0
        front = 0
        low_x, high_x, low_y, high_y = width - 1.0, 0.0, height - 1.0, 0.0
        for i in range(3):
            p, q = local[faces[f, (i + 1) % 3]], local[faces[f, (i + 2) % 3]]
            normal[i, 0] = p[1] * q[2] - p[2] * q[1]
            normal[i, 1] = p[2] * q[0] - p[0] * q[2]
            normal[i, 2] = p[0] * q[1] - p[1] * q[0]
            r = local[faces[f, i]]
            if r[2] > near:
                front += 1
                x = (K[0, 0] * r[0] + K[0, 1] * r[1]) / r[2] + K[0, 2]
                y = K[1, 1] * r[1] / r[2] + K[1, 2]
                low_x, high_x = min(low_x, x), max(high_x, x)
                low_y, high_y = min(low_y, y), max(high_y, y)
        if front == 0:
            continue
        if front < 3:
            low_x, high_x, low_y, high_y = 0.0, width - 1.0, 0.0, height - 1.0
        if high_x < 0 or high_y < 0 or low_x > width - 1 or low_y > height - 1:
            continue
        r = local[faces[f, 0]]
        determinant = r[0] * normal[0, 0] + r[1] * normal[0, 1] + r[2] * normal[0, 2]
        if determinant == 0.0:
            continue
        for i in range(3):
            for k in range(3):
                edge[i, k] = (
                    normal[i, 0] * inverse[0, k] + normal[i, 1] * inverse[1, k] + normal[i, 2] * inverse[2, k]
                ) / determinant
        first_x, last_x = max(int(np.ceil(low_x)), 0), min(int(np.floor(high_x)), width - 1)
        first_y, last_y = max(int(np.ceil(low_y)), 0), min(int(np.floor(high_y)), height - 1)
        for y in range(first_y, last_y + 1):
            for x in range(first_x, last_x + 1):
                a = edge[0, 0] * x + edge[0, 1] * y + edge[0, 2]
                b = edge[1, 0] * x + edge[1, 1] * y + edge[1, 2]
                c = edge[2, 0] * x + edge[2, 1] * y + edge[2, 2]
                # The weights sum to 1 / depth, which is positive only before the camera.
                if a < 0 or b < 0 or c < 0:
                    continue
                whole = a + b + c
                if whole <= 0:
                    continue
                z = 1.0 / whole
                if z <= near:
                    continue
                if both and z > farthest[y, x]:
                    farthest[y, x] = z
                if z < depth[y, x]:
                    depth[y, x] = z
                    if named:
                        face[y, x] = f
                        weights[y, x, 0] = a * z
                        weights[y, x, 1] = b * z
