"""What lies under the mouse, as pure functions on plain values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

GRAB = 10.0


@dataclass(frozen=True)
class Hit:
    """The thing found: its kind, the name or index of the owner, the index in it, and how far away in pixels."""

    kind: str
    owner: str
    index: int
    distance: float


def nearest_point(
    place: tuple[float, float], places: ArrayLike, owners: Sequence[str], reach: float = GRAB, kind: str = "point"
) -> Hit | None:
    """The nearest of (n, 2) places within reach; NaN rows are never found, the first of equals wins."""
    rows = np.asarray(places, np.float64).reshape(-1, 2)
    if not len(rows):
        return None
    distances = np.hypot(rows[:, 0] - place[0], rows[:, 1] - place[1])
    distances = np.where(np.isfinite(distances), distances, np.inf)
    index = int(np.argmin(distances))
    if distances[index] > reach:
        return None
    return Hit(kind, owners[index], index, float(distances[index]))


def nearest_edge(place: tuple[float, float], polygon: ArrayLike, reach: float = GRAB) -> tuple[int, float] | None:
    """The edge of a closed polygon (n, 2) nearest to a place: the index of its first corner and the distance."""
    start = np.asarray(polygon, np.float64)
    if len(start) < 2:
        return None
    end = np.roll(start, -1, axis=0)
    along = end - start
    length = np.maximum((along**2).sum(1), 1e-12)
    share = np.clip(((np.asarray(place) - start) * along).sum(1) / length, 0.0, 1.0)
    gaps = np.linalg.norm(start + share[:, None] * along - place, axis=1)
    index = int(np.argmin(gaps))
    return (index, float(gaps[index])) if gaps[index] <= reach else None


def inside(place: tuple[float, float], polygon: ArrayLike) -> bool:
    """Whether a place is inside a closed polygon (n, 2), by the even-odd rule."""
    corners = np.asarray(polygon, np.float64)
    if len(corners) < 3:
        return False
    x, y = place
    following = np.roll(corners, -1, axis=0)
    crosses = (corners[:, 1] > y) != (following[:, 1] > y)
    rise = np.where(crosses, following[:, 1] - corners[:, 1], 1.0)
    at = corners[:, 0] + (y - corners[:, 1]) / rise * (following[:, 0] - corners[:, 0])
    return bool(np.count_nonzero(crosses & (x < at)) % 2)
