"""Where a contact lies: on a plane, on the nearest step, or at a depth that is assumed (paper A, 3.1 and 4)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.cameras.plane import Plane, fit_plane, least_squares_plane
from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Array, Camera

FEWEST = 6  # points for a local fit
TILTED = 14  # points for a local fit that may tilt


class _Cameras(Protocol):
    def __getitem__(self, frame: int, /) -> Camera: ...
    def __len__(self) -> int: ...


@attrs.frozen(eq=False)
class Ground:
    """What a foot stands on.

    Attributes
    ----------
    name : how it was found, in words for the user.
    plane : the plane, or None where a depth is assumed.
    depth : the assumed camera z, world units, or None.
    residual : rms distance of the points from the plane, world units; NaN where nothing was measured.
    """

    name: str
    plane: Plane | None = None
    depth: float | None = None
    residual: float = float("nan")

    def intersect(self, camera: Camera, pixel: ArrayLike) -> Array:
        """World points (..., 3) where the rays of pixels (..., 2) meet the ground.

        Raises
        ------
        NoSolution
            A ray does not meet it in front of the camera.
        """
        pixel = np.asarray(pixel, np.float64)
        if self.plane is None:
            return camera.lift(pixel, np.full(pixel.shape[:-1], self.depth))
        rays = camera.rays(pixel)
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = -self.plane.height(camera.centre) / (rays @ self.plane.normal)
        if not (np.isfinite(depth) & (depth > 0)).all():
            missed = pixel.reshape(-1, 2)[int(np.argmin(np.where(np.isfinite(depth), depth, -np.inf).reshape(-1)))]
            raise NoSolution(
                f"The ray of pixel ({missed[0]:.0f}, {missed[1]:.0f}) does not meet the ground ({self.name}) in front "
                "of the camera."
            )
        return camera.lift(pixel, depth)


def plane_ground(points: ArrayLike, *, up: ArrayLike | None = None, selected: bool = True) -> Ground:
    """The plane through points (p, 3) that the user selected (the paper's rabbit, Fig. 17), or through all."""
    plane = fit_plane(points, up=up)
    kind = "selected" if selected else "recovered"
    name = f"plane through {int(plane.used.sum())} of {len(plane.used)} {kind} points"
    return Ground(name, plane=plane, residual=plane.residual)


def constant_depth(depth: float) -> Ground:
    """A constant camera depth, where the camera does not move (the paper's salamander, Fig. 16)."""
    if not (np.isfinite(depth) and depth > 0):
        raise InputError(f"A constant depth must be positive, but is {depth}.")
    return Ground(f"constant depth {depth:g}", depth=float(depth))


def constant_depth_track(positions: ArrayLike, cameras: _Cameras, depth: float) -> Array:
    """World trajectory (n, 3) of a track (n, 2) whose depth is assumed constant; NaN where the track is absent."""
    positions = np.asarray(positions, np.float64)
    ground = constant_depth(depth)
    return np.stack([ground.intersect(cameras[t], positions[t]) for t in range(len(positions))])


def _support(plane: Plane, place: Array, points: Array, reach: float, thin: float) -> float:
    """How much the points round a place speak for a plane through it: near ones count, off it they count against."""
    near = np.exp(-((points - place) ** 2).sum(1) / (2 * reach**2))
    off = np.abs(plane.height(points)) / thin
    return float((near * (np.exp(-0.5 * off**2) - 0.25 * (off > 3))).sum())


def _level(up: Array, points: Array, place: float, thin: float) -> Plane:
    used = np.abs(points @ up - place) < 3 * thin
    offset = float(np.median(points[used] @ up)) if used.any() else place
    return Plane(up, offset, 0.0, used)


def local_ground(
    points: ArrayLike,
    cameras: _Cameras,
    frame: int,
    pixel: ArrayLike,
    *,
    up: ArrayLike = (0.0, 0.0, 1.0),
    nearest: int = 40,
) -> Ground:
    """Fit the step, tread or slope under a contact to recovered points (p, 3) seen near its pixel.

    Every level that the points near the pixel suggest, and the slope through them, is scored by the points round the
    place where the pixel's ray would meet it: so a foot on a tread takes the tread and not the riser or the floor
    behind. With many points the plane may tilt, up to 35 degrees.

    Raises
    ------
    NoSolution
        Too few points near the pixel, or none of the planes is met by its ray.
    """
    array = np.asarray(points, np.float64).reshape(-1, 3)
    camera, spot = cameras[frame], np.asarray(pixel, np.float64)
    axis = np.asarray(up, np.float64) / np.linalg.norm(up)
    seen = camera.project(array)
    away = np.linalg.norm(seen - spot, axis=1)
    width = 2 * camera.K[0, 2] + 1
    order = np.lexsort((np.arange(len(away)), np.where(np.isfinite(away), away, np.inf)))[:nearest]
    order = order[away[order] < 0.2 * width]
    if len(order) < FEWEST:
        raise NoSolution(
            f"Only {len(order)} recovered points lie near pixel ({spot[0]:.0f}, {spot[1]:.0f}) of frame {frame}; "
            "use a plane through selected points instead."
        )
    close, weight = array[order], np.exp(-away[order] / (0.05 * width))
    depth = float(np.median(camera.depth(close)))
    reach = max(float(np.median(away[order])) * depth / camera.K[0, 0], 0.02 * depth)
    thin = 0.006 * depth
    candidates = [_level(axis, close, float(h), thin) for h in np.unique(np.round(close @ axis / thin)) * thin]
    candidates += _slopes(close, axis, thin)
    scored: list[tuple[float, Plane, Array]] = []
    for plane in candidates:
        try:
            place = Ground("", plane=plane).intersect(camera, spot)
        except NoSolution:
            continue
        scored.append((_support(plane, place, close, reach, thin), plane, place))
    if not scored:
        raise NoSolution(f"The ray of pixel ({spot[0]:.0f}, {spot[1]:.0f}) meets no surface fitted to points near it.")
    _, plane, place = max(scored, key=lambda item: item[0])
    return _refined(plane, place, close, weight, axis, reach, thin)


def _slopes(close: Array, axis: Array, thin: float) -> Sequence[Plane]:
    if len(close) < TILTED:
        return []
    try:
        return [fit_plane(close, up=axis, tolerance=2 * thin)]
    except NoSolution:
        return []


def _refined(plane: Plane, place: Array, close: Array, weight: Array, axis: Array, reach: float, thin: float) -> Ground:
    used = np.abs(plane.height(close)) < 2.5 * thin
    inside = weight * np.exp(-((close - place) ** 2).sum(1) / (4 * reach**2)) + 1e-6
    kind = "level"
    if used.sum() >= TILTED:
        normal, centre, spread = least_squares_plane(close[used], inside[used])
        normal = normal if normal @ axis > 0 else -normal
        tilted = float(normal @ axis)
        # A strip of points fixes only one direction; then level is the better guess.
        if tilted > np.cos(np.radians(35)) and spread[1] > 4 * spread[0] and spread[1] > 0.15 * spread[2]:
            plane, kind = Plane(normal, float(normal @ centre), 0.0, used), "tilted"
    if kind == "level" and used.sum():
        height = float(np.average(close[used] @ plane.normal, weights=inside[used]))
        plane = Plane(plane.normal, height, 0.0, used)
    off = plane.height(close[used]) if used.any() else np.zeros(1)
    residual = float(np.sqrt(np.mean(off**2)))
    plane = attrs.evolve(plane, residual=residual)
    return Ground(f"{kind} local fit to {int(used.sum())} of {len(close)} points", plane=plane, residual=residual)
