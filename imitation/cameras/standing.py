"""What carries a foot, where an edge nearer to the camera shows beside it: a wall's top is not the paving behind it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras.ground import Ground, local_ground
from imitation.cameras.path import CameraPath
from imitation.cameras.plane import fit_plane
from imitation.errors import NoSolution
from imitation.geometry.projection import Array, Camera

WIDE = 0.3
"""Reach of the search for what lies behind an edge, of the picture's width."""
BEYOND = 0.04
"""Share of a surface's points that lie beyond a place inside it, whichever way; at an edge there are fewer."""
WEAK = 0.3
"""A local fit that fewer of the points nearby speak for gives way to a surface further round that surrounds it."""
FEWEST, ROUNDS = 5, 8


def standing_ground(
    points: ArrayLike,
    cameras: CameraPath,
    frame: int,
    pixel: ArrayLike,
    *,
    up: ArrayLike = (0.0, 0.0, 1.0),
) -> Ground:
    """As `local_ground`, but a surface that ends before the foot does not carry it.

    Where the points that speak for the local fit all lie on the camera's side of the place, the fit was carried on
    beyond an edge: the foot may as well stand on something lower behind it. A lower surface takes its place if its own
    points lie all round the foot. A foot at the far end of a step keeps the step where nothing lower is seen.

    Parameters
    ----------
    points : (p, 3) recovered points, world. cameras, frame, pixel, up : as in `local_ground`.

    Raises
    ------
    NoSolution
        Too few points near the pixel, or no surface that its ray meets.
    """
    array = np.asarray(points, np.float64).reshape(-1, 3)
    camera, spot = cameras[frame], np.asarray(pixel, np.float64)
    axis = np.asarray(up, np.float64) / np.linalg.norm(up)
    seen = camera.project(array)
    width = 2 * camera.K[0, 2] + 1
    near: NDArray[np.bool_] = np.asarray(np.linalg.norm(seen - spot, axis=1) < WIDE * width)
    around = array[near & (camera.depth(array) > 0)]
    try:
        first = local_ground(array, cameras, frame, spot, up=axis)
    except NoSolution:
        wide = _carrying(around, camera, spot, axis, np.inf)
        if wide is None:
            raise
        return wide
    assert first.plane is not None
    place = first.intersect(camera, spot)
    thin = 0.006 * float(camera.depth(place))
    fitting = around[np.abs(first.plane.height(around)) < 3 * thin]
    if len(fitting) < FEWEST or first.plane.used.mean() < WEAK:
        return _carrying(around, camera, spot, axis, np.inf) or first
    if _beyond(fitting, place, camera, axis) >= BEYOND:
        return first
    rest = around[np.abs(first.plane.height(around)) >= 3 * thin]
    return _carrying(rest, camera, spot, axis, float(place @ axis) - 3 * thin) or first


def _beyond(points: Array, place: Array, camera: Camera, axis: Array, *, behind: bool = True) -> float:
    """Smallest share of points on the far side of any upright line through a place; small outside their outline.

    With ``behind`` only lines whose far side faces away from the camera: a surface may end before the foot.
    """
    if not len(points):
        return 0.0
    forward = place - camera.centre
    forward = forward - (forward @ axis) * axis
    forward = forward / max(float(np.linalg.norm(forward)), 1e-12)
    across = np.cross(axis, forward)
    turns = np.radians(np.arange(-75, 76, 15) if behind else np.arange(0, 360, 15))
    away = np.linalg.norm(points - place, axis=1)
    usual = float(np.median(away))
    # What happens to lie in the same plane far off is another surface.
    near = points[away <= 3 * usual] - place
    sides = near @ (np.cos(turns) * forward[:, None] + np.sin(turns) * across[:, None])
    return float((sides > 0.1 * usual).mean(axis=0).min())


def _carrying(points: Array, camera: Camera, spot: Array, axis: Array, below: float) -> Ground | None:
    """The first surface under a height that has points all round the place where the ray meets it."""
    left = points
    for _ in range(ROUNDS):
        if len(left) < FEWEST:
            break
        tolerance = 0.02 * float(np.quantile(camera.depth(left), 0.25))
        try:
            plane = fit_plane(left, up=axis, tolerance=tolerance)
        except NoSolution:
            break
        used = left[plane.used]
        left = left[~plane.used]
        ground = Ground(f"wide fit round the place to {len(used)} of {len(points)} points", plane, None, plane.residual)
        try:
            place = ground.intersect(camera, spot)
        except NoSolution:
            continue
        inside = len(used) >= FEWEST and _beyond(used, place, camera, axis, behind=False) >= BEYOND
        if inside and place @ axis < below:
            return ground
    return None
