"""Planes through points, most of which belong to it."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Array

TRIPLES = 600
TILT = np.radians(35)  # a ground tilted by more against the expected up is a wall


@attrs.frozen(eq=False)
class Plane:
    """The plane ``normal @ x = offset``.

    Attributes
    ----------
    normal : (3,) unit vector.
    offset : distance of the plane from the origin along the normal, world units.
    residual : rms distance of the points it was fitted to, world units.
    used : (p,) which points it was fitted to.
    """

    normal: Array
    offset: float
    residual: float = 0.0
    used: NDArray[np.bool_] = attrs.field(factory=lambda: np.zeros(0, bool))

    def height(self, points: ArrayLike) -> Array:
        """Signed distance (...,) of points (..., 3) above the plane."""
        above: Array = np.asarray(points, np.float64) @ self.normal - self.offset
        return above

    def towards(self, point: ArrayLike) -> Plane:
        """The same plane with its normal on the side of a point (3,)."""
        if self.height(point) >= 0:
            return self
        return attrs.evolve(self, normal=-self.normal, offset=-self.offset)


def _points(points: ArrayLike) -> Array:
    array = np.asarray(points, np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"A plane is fitted to points (p, 3), but these have shape {array.shape}.")
    if not np.isfinite(array).all():
        raise InputError("A plane is fitted to finite points, but some are NaN or infinite.")
    if len(array) < 3:
        raise InputError(f"A plane needs at least three points, but only {len(array)} are given; select more.")
    return array


def least_squares_plane(points: Array, weights: Array | None = None) -> tuple[Array, Array, Array]:
    """Normal (3,), centre (3,) and the points' spread (3,) along the principal axes, smallest first."""
    weights = np.ones(len(points)) if weights is None else weights
    weights = weights / weights.sum()
    centre = weights @ points
    off = (points - centre) * np.sqrt(weights)[:, None]
    values, vectors = np.linalg.eigh(off.T @ off)
    return vectors[:, 0], centre, np.sqrt(np.maximum(values, 0))


def fit_plane(
    points: ArrayLike, *, up: ArrayLike | None = None, tolerance: float | None = None, seed: int = 0
) -> Plane:
    """Fit a plane to points (p, 3), leaving out those that do not lie on it.

    Parameters
    ----------
    up : if given, only planes within 35 degrees of this direction count, and the normal points along it.
    tolerance : distance, world units, within which a point belongs to the plane; by default from the points: 1 % of
        their extent, then three times the spread of those that fit.
    seed : of the triples tried; the same points and seed give the same plane.

    Raises
    ------
    InputError
        Fewer than three points, or not finite.
    NoSolution
        The points lie on a line, or no plane lies that way.
    """
    array = _points(points)
    spread = np.linalg.norm(array - np.median(array, axis=0), axis=1)
    extent = float(np.median(spread))
    if extent == 0.0:
        extent = float(spread.max())
    reach = tolerance if tolerance is not None else 0.02 * extent
    axis = None if up is None else np.asarray(up, np.float64) / np.linalg.norm(up)
    random = np.random.default_rng(seed)
    triples = random.integers(len(array), size=(TRIPLES, 3))
    if len(array) == 3:
        triples = np.array([[0, 1, 2]])
    a, b, c = (array[triples[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    size = np.linalg.norm(normals, axis=1)
    good = size > 1e-6 * max(extent, 1e-300) ** 2
    if not good.any():
        raise NoSolution("The points lie on a line, so they fix no plane; select points beside it too.")
    normals, a = normals[good] / size[good, None], a[good]
    if axis is not None:
        level = np.abs(normals @ axis) > np.cos(TILT)
        if not level.any():
            raise NoSolution("No plane through the points is anywhere near level; select points on the ground.")
        normals, a = normals[level], a[level]
    distance = np.abs(array @ normals.T - (a * normals).sum(1))
    cost = np.minimum(distance / max(reach, 1e-300), 1.0) ** 2
    best = int(cost.sum(0).argmin())
    used = distance[:, best] <= reach
    normal, centre = normals[best], a[best]
    for _ in range(20):
        if used.sum() < 3:
            break
        fitted, middle, _ = least_squares_plane(array[used])
        if axis is not None and abs(fitted @ axis) < np.cos(TILT):
            break
        normal, centre = fitted, middle
        away = np.abs((array - centre) @ normal)
        limit = reach
        if tolerance is None:
            limit = float(np.clip(3 * np.sqrt(np.mean(away[used] ** 2)), 1e-9 * extent, reach))
        again = away <= limit
        if again.sum() < 3 or (again == used).all():
            break
        used = again
    if normal @ (np.array([0, 0, 1.0]) if axis is None else axis) < 0:
        normal = -normal
    offset = float(centre @ normal)
    residual = float(np.sqrt(np.mean((array[used] @ normal - offset) ** 2))) if used.any() else 0.0
    return Plane(normal, offset, residual, used)
