"""Which frames get a depth map, and in which other frames each is measured."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.depth.sweep import MOST_VIEWS

BASELINES = (0.02, 0.045, 0.07, 0.1)  # of the middle depth, on both sides
BETWEEN = (0.03, 0.057, 0.085, 0.12, 0.14)  # where one side has too few
APART = 0.022  # of the middle depth, from one key frame to the next
MOST_KEYS = 24
AHEAD = 0.35  # what a step ahead shifts the picture on average, beside a step sideways
OVERLAP = 0.4  # of a frame's pixels that another must see


def key_frames(cameras: CameraPath, middle: float) -> list[int]:
    """Frames to solve: where the camera has moved far enough, not more than about ``MOST_KEYS``, both ends included."""
    count = len(cameras)
    step = max(2, -(-count // MOST_KEYS))
    centres = cameras.centres
    chosen = [0]
    for frame in range(1, count):
        apart = float(np.linalg.norm(centres[frame] - centres[chosen[-1]])) / middle
        since = frame - chosen[-1]
        if since >= step and (apart >= APART or since >= 4 * step):
            chosen.append(frame)
    if chosen[-1] != count - 1:
        # The last frame takes the place of a key frame that is closer than half a step.
        if len(chosen) > 1 and count - 1 - chosen[-1] < step / 2:
            chosen.pop()
        chosen.append(count - 1)
    return chosen


def overlap(cameras: CameraPath, frame: int, other: int, size: tuple[int, int], middle: float) -> float:
    """The share of a frame's pixels that another frame sees too, were all of them at the middle depth."""
    columns, rows = np.meshgrid(np.linspace(0, size[0] - 1, 9), np.linspace(0, size[1] - 1, 7))
    pixels = np.stack([columns.ravel(), rows.ravel()], axis=1)
    points = cameras[frame].lift(pixels, np.full(len(pixels), middle))
    seen = cameras[other].project(points)
    with np.errstate(invalid="ignore"):
        inside = (seen >= 0).all(axis=1) & (seen[:, 0] <= size[0] - 1) & (seen[:, 1] <= size[1] - 1)
    return float(inside.mean())


def choose_views(
    cameras: CameraPath, frame: int, keys: Collection[int], size: tuple[int, int], middle: float
) -> list[int]:
    """At most ``MOST_VIEWS`` frames to measure a frame's depth in: four baselines on both sides of the camera's way.

    A key frame stands in for a frame with nearly its baseline, since it brings its own depth to the second pass.
    """
    offset = (cameras.centres - cameras[frame].centre) @ cameras.R[frame].T / middle
    offset[:, 2] *= AHEAD
    away = np.linalg.norm(offset, axis=1)
    near = [v for v in range(len(cameras)) if v != frame and away[v] <= 2 * BETWEEN[-1]]
    usable = np.array([v for v in near if overlap(cameras, frame, v, size, middle) >= OVERLAP], np.int64)
    if len(usable) < 2:
        order = np.argsort(np.where(np.arange(len(cameras)) == frame, np.inf, away), kind="stable")
        usable = np.sort(order[: min(MOST_VIEWS, len(cameras) - 1)])
    way = np.linalg.svd(offset[usable], full_matrices=False)[2][0]
    side = np.where(offset[usable] @ way >= 0, 1, -1)
    stretch = min(1.0, float(away[usable].max()) / BASELINES[-1])
    chosen: list[int] = []
    for baselines in (BASELINES, BETWEEN):
        for baseline in baselines:
            for s in (-1, 1):
                if len(chosen) < MOST_VIEWS:
                    _take(chosen, usable[side == s], away, baseline * stretch, keys)
    for frame_ in usable[np.argsort(np.abs(away[usable] - 0.05 * stretch), kind="stable")]:
        if len(chosen) < min(4, len(usable)) and int(frame_) not in chosen:
            chosen.append(int(frame_))
    return sorted(chosen)


def _take(
    chosen: list[int], candidates: NDArray[np.int64], away: NDArray[np.float64], baseline: float, keys: Collection[int]
) -> None:
    """Add the candidate whose distance is nearest to a baseline, if one is near enough and new."""
    open_ = [int(v) for v in candidates if int(v) not in chosen]
    if not open_:
        return
    best = min(open_, key=lambda v: (abs(away[v] - baseline), v))
    among = [v for v in open_ if v in keys and abs(away[v] - baseline) <= 0.3 * baseline]
    if among:
        best = min(among, key=lambda v: (abs(away[v] - baseline), v))
    if abs(away[best] - baseline) <= 0.5 * baseline:
        chosen.append(best)
