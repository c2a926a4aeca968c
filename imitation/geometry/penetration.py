"""How deep the vertices of a mesh lie below the ground, or behind a measured surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Array, Camera


def below_ground(
    vertices: ArrayLike, places: ArrayLike, normal: ArrayLike = (0.0, 0.0, 1.0), *, reach: float = np.inf
) -> Array:
    """How far each vertex is below the ground (v,), world units, 0 above it.

    Parameters
    ----------
    vertices : (v, 3) world.
    places : (k, 3) points of the ground; under a vertex it is as high as at the nearest of them, seen along the normal:
        one point is a plane, the feet on a stair are its steps.
    normal : (3,) pointing up.
    reach : world units; farther from every place, seen along the normal, nothing is known of the ground.
    """
    points = np.asarray(vertices, np.float64)
    ground = np.asarray(places, np.float64).reshape(-1, 3)
    up = np.asarray(normal, np.float64)
    if not len(ground):
        raise InputError("The ground needs one point at least.")
    up = up / np.linalg.norm(up)
    heights, level = points @ up, ground @ up
    flat, flat_ground = points - heights[:, None] * up, ground - level[:, None] * up
    away = np.stack([((flat - each) ** 2).sum(1) for each in flat_ground], axis=1)
    deep = np.maximum(level[np.argmin(away, axis=1)] - heights, 0.0)
    known: Array = np.where(away.min(axis=1) <= reach**2, deep, 0.0)
    return known


def behind_surface(vertices: ArrayLike, camera: Camera, depth: NDArray[np.floating], *, reach: float) -> Array:
    """How far each vertex is behind what the camera sees (v,), world units, 0 in front of it or where nothing is known.

    Parameters
    ----------
    vertices : (v, 3) world.
    depth : (h, w) camera z of the background, NaN where unknown.
    reach : world units; what lies deeper stands behind the thing and is hidden by it, it does not stick in it.
    """
    points = np.asarray(vertices, np.float64)
    pixels, z = camera.project(points), camera.depth(points)
    at = np.rint(np.nan_to_num(pixels, nan=-1.0)).astype(np.int64)
    height, width = depth.shape
    inside = (at >= 0).all(1) & (at[:, 0] < width) & (at[:, 1] < height) & (z > 0)
    deep = np.zeros(len(points))
    deep[inside] = z[inside] - depth[at[inside, 1], at[inside, 0]]
    found: Array = np.where(np.isfinite(deep) & (deep > 0) & (deep <= reach), deep, 0.0)
    return found
