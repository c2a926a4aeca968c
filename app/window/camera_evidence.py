"""What speaks for the recovered cameras: where background points were seen, how far off they are, the ground's grid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CELLS, SAMPLES, NEAREST = 12, 61, 0.05


@dataclass(frozen=True, eq=False)
class Evidence:
    """Recovered background points in one frame.

    index : (k,) into the path's points. places : (k, 2) picture pixels. residuals : (k,) pixels between where a point
    was seen and where the solution puts it, NaN where it was not followed.
    """

    index: NDArray[np.int64]
    places: Array
    residuals: Array

    def nearest(self, place: tuple[float, float], reach: float) -> int:
        """The point nearest to a place, within reach pixels; -1 for none."""
        if not len(self.places):
            return -1
        gaps = np.hypot(*(self.places - place).T)
        row = int(np.argmin(gaps))
        return int(self.index[row]) if gaps[row] <= reach else -1


NOTHING = Evidence(np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0))


def evidence(path: Any, frame: int) -> Evidence:
    """The points of a ``CameraPath`` (None for none) in a frame: those followed there, else all in front of it."""
    if path is None or not len(path.points) or frame >= len(path):
        return NOTHING
    camera = path[frame]
    rows = np.flatnonzero(path.observations[:, 0] == frame) if len(path.observations) else np.zeros(0, np.int64)
    if len(rows) and len(path.observed) == len(path.observations):
        index, seen = path.observed[rows].astype(np.int64), path.observations[rows, 1:]
        gaps = camera.project(path.points[index]) - seen
        return Evidence(index, seen, np.hypot(*gaps.T))
    index = np.flatnonzero(camera.depth(path.points) > 0)
    return Evidence(index, camera.project(path.points[index]), np.full(len(index), np.nan))


def spacing_for(distance: float) -> float:
    """A round number of units, 1, 2 or 5 times a power of ten, about an eighth of a distance."""
    wanted = max(distance / 8, 1e-9)
    power = 10.0 ** math.floor(math.log10(wanted))
    return power * max(factor for factor in (1, 2, 5) if factor * power <= wanted * (1 + 1e-9))


def ground_grid(camera: Any, offset: float, size: tuple[int, int]) -> tuple[list[Array], float]:
    """Lines (k, 2) in picture pixels on the plane z = offset, as a camera sees it, and their distance in world units.

    NaN rows stand where a line is behind the camera. Empty where the lower half of the picture shows no ground.
    """
    width, height = size
    middle = camera.centre
    ray = camera.rays(np.array([width / 2, 0.78 * height]))
    if abs(ray[2]) < 1e-9 or (offset - middle[2]) / ray[2] <= 0:
        return [], 0.0
    foot = middle + (offset - middle[2]) / ray[2] * ray
    distance = float(np.linalg.norm(foot - middle))
    step = spacing_for(distance)
    x0, y0 = np.round(foot[:2] / step) * step
    ends = np.linspace(-CELLS, CELLS, SAMPLES) * step
    lines = []
    for number in range(-CELLS, CELLS + 1):
        still = np.full(SAMPLES, number * step)
        for dx, dy in ((still, ends), (ends, still)):
            points = np.stack([x0 + dx, y0 + dy, np.full(SAMPLES, offset)], axis=1)
            behind = camera.depth(points) < NEAREST * distance
            places = camera.project(points)
            places[behind] = np.nan
            lines.append(places)
    return lines, step


def horizon(camera: Any, size: tuple[int, int]) -> Array | None:
    """Where level ground far away would end: two picture places (2, 2) at the left and right border.

    The vanishing line of planes with the normal z is K^-T R z (Hartley and Zisserman, 8.6).
    """
    a, b, c = np.linalg.inv(camera.K).T @ (camera.R @ np.array([0.0, 0.0, 1.0]))
    if abs(b) < 1e-9 * abs(a):
        return None
    xs = np.array([-0.5, size[0] - 0.5])
    line: Array = np.stack([xs, -(a * xs + c) / b], axis=1)
    return line
