"""The lines of the ground: a grid whose step is a round number and which fades with the distance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

PIECES = 24


def round_step(radius: float) -> float:
    """A step of 1, 2 or 5 times a power of ten that gives about twenty lines across."""
    wanted = max(radius, 1e-6) / 10
    power = 10.0 ** math.floor(math.log10(wanted))
    return power * next(factor for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= wanted * 0.999)


def ground_grid(
    centre: NDArray[np.float64], radius: float, height: float
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.uint8]]:
    """Points (n, 3) round a centre (2,) on z = height, the lines between them (m, 2), colour and opacity (n, 4)."""
    step = round_step(radius)
    count = int(radius / step)
    origin = np.round(centre / step) * step
    along = np.linspace(-count * step, count * step, PIECES + 1)
    rows = []
    for number in range(-count, count + 1):
        line = np.full(PIECES + 1, number * step)
        rows += [np.column_stack([along, line]), np.column_stack([line, along])]
    flat = np.concatenate(rows)
    fade = np.clip(1 - np.linalg.norm(flat, axis=1) / (count * step), 0, 1) ** 1.2
    major = np.repeat([number % 5 == 0 for number in range(-count, count + 1) for _ in range(2)], PIECES + 1)
    rgba = np.zeros((len(flat), 4), np.uint8)
    rgba[:, :3] = (150, 162, 176)
    rgba[:, 3] = (fade * np.where(major, 150, 70)).astype(np.uint8)
    points = np.column_stack([flat + origin, np.full(len(flat), height)])
    first = np.arange(0, len(points), PIECES + 1)[:, None] + np.arange(PIECES)[None]
    return points, np.stack([first, first + 1], axis=-1).reshape(-1, 2), rgba
