"""Feet that a solution puts below the ground they stand on are lifted onto it: softly, and near their contacts only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Array

FOOT = 0.07
"""Radius of a foot round its vertex, as a share of the character's largest extent at rest; beyond it fades out."""
AROUND = 4
"""Frames before and after its contacts in which a foot is lifted too, less and less."""
SOFT = 1.5
"""Frames over which the lift is smoothed (standard deviation)."""

Contacts = Mapping[int, Sequence[tuple[int, int, ArrayLike]]]


def lifted_feet(
    vertices: Sequence[Any] | NDArray[np.floating],
    rest: ArrayLike,
    contacts: Contacts,
    normal: ArrayLike = (0.0, 0.0, 1.0),
    *,
    radius: float | None = None,
) -> Array:
    """Lift the feet (n, v, 3) of a motion along the normal until none is below its own contacts.

    Between two contacts a foot swings: then the lower of the two levels counts. What is above its level stays as it is,
    to the bit, and so does all that is farther from a foot than twice its radius.

    Parameters
    ----------
    vertices : (n, v, 3) world. rest : (v, 3) the character as it stands, same scale.
    contacts : vertex of a foot to [(first frame, last frame, place (3,)), ...], frames both included.
    normal : (3,) pointing up. radius : of a foot, world units; None: ``FOOT`` of the character.

    Raises
    ------
    InputError
        A vertex that the mesh does not have, or contacts outside the motion.
    """
    moved = np.array(vertices, np.float64)
    still = np.asarray(rest, np.float64)
    up = np.asarray(normal, np.float64) / np.linalg.norm(np.asarray(normal, np.float64))
    if moved.ndim != 3 or moved.shape[1:] != still.shape:
        raise InputError(f"A motion {moved.shape} and a mesh {still.shape} do not belong together.")
    reach = radius or FOOT * float(np.ptp(still, axis=0).max())
    most = np.zeros(moved.shape[:2])
    for vertex, intervals in contacts.items():
        if not 0 <= vertex < moved.shape[1]:
            raise InputError(f"There is no vertex {vertex}: the mesh has {moved.shape[1]}.")
        if not len(intervals):
            continue
        share = _share(still, vertex, reach)
        foot = share > 0.5
        level, weight = _levels(intervals, len(moved), up)
        deep = np.maximum(level - (moved[:, foot] @ up).min(axis=1), 0)
        lift = np.minimum(_softened(deep * weight), 2 * reach)
        # Two feet beside each other: the one that is lifted more takes what they share with it.
        most = np.maximum(most, lift[:, None] * share)
    return moved + most[..., None] * up


def _share(rest: Array, vertex: int, reach: float) -> Array:
    """How much each vertex (v,) moves with a foot: 1 within its radius, 0 from twice of it on."""
    away = np.clip(2 - np.linalg.norm(rest - rest[vertex], axis=1) / reach, 0, 1)
    smooth: Array = away * away * (3 - 2 * away)
    return smooth


def _levels(intervals: Sequence[tuple[int, int, ArrayLike]], count: int, up: Array) -> tuple[Array, Array]:
    """Height of the ground under a foot in each frame (n,), and how much it counts there, 0 to 1."""
    ordered = sorted(intervals, key=lambda each: each[0])
    heights = [float(np.asarray(place, np.float64) @ up) for _, _, place in ordered]
    if ordered[0][0] < 0 or ordered[-1][1] >= count:
        raise InputError(f"Contacts from frame {ordered[0][0]} to {ordered[-1][1]} lie outside {count} frames.")
    frames = np.arange(count)
    level, weight = np.full(count, heights[0]), np.zeros(count)
    for k, (first, last, _) in enumerate(ordered):
        level[first : last + 1], weight[first : last + 1] = heights[k], 1
        after = ordered[k + 1][0] if k + 1 < len(ordered) else count
        swing = frames[last + 1 : after]
        level[swing] = min(heights[k], heights[k + 1]) if k + 1 < len(ordered) else heights[k]
        weight[swing] = 1 if k + 1 < len(ordered) else np.clip(1 - (swing - last) / (AROUND + 1), 0, 1)
    before = frames[: ordered[0][0]]
    weight[before] = np.clip(1 - (ordered[0][0] - before) / (AROUND + 1), 0, 1)
    return level, weight


def _softened(deep: Array) -> Array:
    """Depths (n,) smoothed over time, nowhere much less than they were; zero where nothing near is below."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d

    if not deep.any():
        return deep
    widened = maximum_filter1d(deep, 3, mode="nearest")
    soft: Array = gaussian_filter1d(widened, SOFT, mode="nearest", truncate=3.0)
    return np.maximum(soft, deep)
