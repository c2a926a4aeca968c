"""Two places of the scene seen in one picture, so that a distance between them can be told in metres."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras.ground import local_ground
from imitation.cameras.path import CameraPath
from imitation.cameras.plane import Plane
from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Array, Camera

BESIDE = 0.012
"""How far a recovered point may lie beside the line between the two pixels, of the picture's width."""
FEWEST = 4
ALIKE = 0.02
"""Inverse depths that differ by less, relatively, are of one thing."""


def seen_segment(
    path: CameraPath,
    frame: int,
    first: ArrayLike,
    second: ArrayLike,
    *,
    plane: Plane | None = None,
    depth: float | None = None,
) -> tuple[Array, Array, str]:
    """Places (3,) of two pixels of one picture, in the path's world, and how they were found.

    In this order: a straight thing whose recovered points lie along the line between the pixels; an upright thing whose
    lower end is on the ground; two places on the ground; a depth that is assumed.

    Parameters
    ----------
    first, second : (2,) pixels of ``frame``, the ends of the thing.
    plane : the ground in the path's world, where one is known.
    depth : the assumed camera z where nothing else is known.

    Raises
    ------
    InputError
        The pixels are the same.
    NoSolution
        Nothing says how far away the ends are.
    """
    ends = np.array([first, second], np.float64)
    if np.linalg.norm(ends[1] - ends[0]) < 1:
        raise InputError("The two ends of a known length are the same place in the picture: choose two others.")
    camera = path[frame]
    along = _along_points(camera, path.points, ends) if len(path.points) else None
    if along is not None:
        return along[0], along[1], "along the recovered points between them"
    if plane is not None:
        upright = _upright(path, frame, ends, plane)
        if upright is not None:
            return upright[0], upright[1], "upright on the ground"
        places = _on_plane(camera, ends, plane)
        if places is not None:
            return places[0], places[1], "on the ground"
    if depth is not None:
        places = camera.lift(ends, np.full(2, depth))
        return places[0], places[1], "at the assumed depth"
    raise NoSolution("Nothing says how far away the ends of the known length are: track two points of the background.")


def _along_points(camera: Camera, points: Array, ends: Array) -> Array | None:
    """Both ends (2, 3) by the straight line in space that most points near the line in the picture lie on.

    Along a straight line the inverse depth changes evenly in the picture.
    """
    seen = camera.project(points)
    line = ends[1] - ends[0]
    length = float(np.linalg.norm(line))
    share = (seen - ends[0]) @ line / length**2
    beside = np.abs((seen - ends[0]) @ np.array([-line[1], line[0]])) / length
    width = 2 * camera.K[0, 2] + 1
    near: NDArray[np.bool_] = np.asarray((share > -0.1) & (share < 1.1) & (beside < BESIDE * width))
    if near.sum() < FEWEST or np.ptp(share[near]) < 0.5:
        return None
    share, inverse = share[near], 1 / camera.depth(points[near])
    best: tuple[int, float, Array] | None = None
    for a in range(len(share)):
        for b in range(a + 1, len(share)):
            if abs(share[b] - share[a]) < 0.3:
                continue
            slope = (inverse[b] - inverse[a]) / (share[b] - share[a])
            start = inverse[a] - slope * share[a]
            guess = start + slope * share
            alike = np.abs(inverse - guess) < ALIKE * np.abs(guess)
            count = int(alike.sum())
            if count < max(FEWEST, 0.5 * len(share)) or min(start, start + slope) <= 0:
                continue
            if best is None or (count, start) > best[:2]:
                fitted = np.polyfit(share[alike], inverse[alike], 1)
                best = (count, float(start), np.array([fitted[1], fitted[0] + fitted[1]]))
    if best is None or (best[2] <= 0).any():
        return None
    return camera.lift(ends, 1 / best[2])


def _upright(path: CameraPath, frame: int, ends: Array, plane: Plane) -> Array | None:
    """The ends of a thing that stands upright on the ground: the lower one on it, the other above."""
    camera = path[frame]
    for lower, upper in ((0, 1), (1, 0)):
        try:
            ground = local_ground(path.points, path, frame, ends[lower], up=plane.normal)
            foot = ground.intersect(camera, ends[lower])
        except NoSolution:
            met = _on_plane(camera, ends[lower : lower + 1], plane)
            if met is None:
                continue
            foot = met[0]
        reach = 0.01 * float(camera.depth(foot))
        shown = camera.project(np.stack([foot, foot + reach * plane.normal]))
        up, line = shown[1] - shown[0], ends[upper] - ends[lower]
        if up @ line < np.cos(np.radians(6)) * np.linalg.norm(up) * np.linalg.norm(line):
            continue
        # The height at which the vertical through the foot is nearest to the upper pixel's ray.
        ray = camera.rays(ends[upper])
        system = np.stack([plane.normal, -ray], axis=1)
        height = float(np.linalg.lstsq(system, camera.centre - foot, rcond=None)[0][0])
        top = foot + height * plane.normal
        return np.stack([foot, top] if lower == 0 else [top, foot])
    return None


def _on_plane(camera: Camera, pixels: Array, plane: Plane) -> Array | None:
    rays = camera.rays(pixels)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = -plane.height(camera.centre) / (rays @ plane.normal)
    if not (np.isfinite(depth) & (depth > 0)).all():
        return None
    return camera.lift(pixels, depth)
