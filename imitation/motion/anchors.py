"""Anchors: the depth of a point that touches the background from time to time (paper A, 3.2, eq. 1-4)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.banded import Array, smoothness_band, solve_band

Loss = Literal["quadratic", "robust"]


def anchor_depths(
    positions: ArrayLike,
    cameras: CameraPath,
    contacts: Mapping[int, ArrayLike],
    *,
    beta: float = 1e-4,
    loss: Loss = "quadratic",
) -> Array:
    """Depth in every frame of a point that touches known places in some frames (paper A, eq. 2-4).

    Parameters
    ----------
    positions : (n, 2) track, pixels; NaN where absent (eq. 4 asks for its length only).
    cameras : the clip's cameras.
    contacts : frame -> place (3,), world, of the touched background point.
    beta : weight of the smoothness of eq. 3 against the contacts of eq. 2.
    loss : "quadratic" is eq. 3; "robust" (Cauchy) lets the depth change suddenly where the contacts ask for it.

    Returns
    -------
    (n,) camera z, world units; ``cameras[t].lift(positions[t], depth[t])`` is the 3D track (eq. 1).

    Raises
    ------
    InputError
        There is no contact, a contact lies outside the clip or behind its camera, or the lengths differ.
    """
    positions = np.asarray(positions, np.float64)
    count = len(positions)
    if count != len(cameras):
        raise InputError(f"The track has {count} frames but there are {len(cameras)} cameras; both need one a frame.")
    if not contacts:
        raise InputError(
            "An anchor needs at least one contact; mark a frame in which the point touches the background."
        )
    if not (np.isfinite(beta) and beta > 0):
        raise InputError(f"The smoothness weight beta must be positive, but is {beta}.")
    weight, target = np.zeros(count), np.zeros(count)
    for frame, place in contacts.items():
        target[frame], weight[frame] = _contact_depth(frame, place, cameras), 1.0
    if count == 1:
        return target
    if loss == "quadratic":
        return _solve(weight, target, beta, np.ones(count - 1), np.ones(max(count - 2, 0)))
    if loss == "robust":
        return _solve_robust(weight, target, beta)
    raise InputError(f'The loss must be "quadratic" or "robust", but is "{loss}".')


def _contact_depth(frame: int, place: ArrayLike, cameras: CameraPath) -> float:
    if not 0 <= frame < len(cameras):
        raise InputError(
            f"The contact in frame {frame} is outside the clip of {len(cameras)} frames; move or remove it."
        )
    point = np.asarray(place, np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InputError(f"The contact in frame {frame} needs a place of three finite numbers.")
    depth = float(cameras[frame].depth(point))
    if depth <= 0:
        raise InputError(f"The contact in frame {frame} lies behind the camera; check its place on the ground.")
    return depth


def _solve(weight: Array, target: Array, beta: float, first: Array, second: Array) -> Array:
    band = smoothness_band(beta * first, beta * second)
    band[0] += weight
    return solve_band(band, weight * target)


def _solve_robust(weight: Array, target: Array, beta: float, rounds: int = 30) -> Array:
    """Cauchy loss on both differences by reweighting; its scale is the median change of the quadratic solution."""
    count = len(weight)
    depth = _solve(weight, target, beta, np.ones(count - 1), np.ones(max(count - 2, 0)))
    scale = max(float(np.median(np.abs(np.diff(depth)))), 1e-6 * float(np.abs(depth).max()))
    for _ in range(rounds):
        first = 1 / (1 + (np.diff(depth) / scale) ** 2)
        second = 1 / (1 + (np.diff(depth, 2) / scale) ** 2)
        previous, depth = depth, _solve(weight, target, beta, first, second)
        if np.abs(depth - previous).max() <= 1e-9 * np.abs(depth).max():
            break
    return depth
