"""How deep the vertices of a mesh lie below the ground."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.geometry.projection import Array


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
