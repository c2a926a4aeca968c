"""Depth smoothing: the key points' depths of a deformed sequence regularised in time (paper A, 3.5, eq. 12)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array, smoothness_band, solve_band

CLAMPED = 1e9


def smooth_depths(depths: ArrayLike, *, alpha: float, clamped: NDArray[np.bool_] | None = None) -> Array:
    """Smooth depths in time (paper A, eq. 12).

    Parameters
    ----------
    depths : (n, k) camera z of k key points, any length unit; NaN where unknown (filled by the smoothness alone).
    alpha : smoothness weight; depends on the frame rate, not on the unit.
    clamped : (n, k) depths that must stay as they are: frames in contact and edited frames.

    Returns
    -------
    (n, k) smoothed depths.

    Raises
    ------
    InputError
        A wrong shape, a negative weight, or a key point without any depth.
    """
    depths = np.asarray(depths, np.float64)
    if depths.ndim != 2 or not depths.size:
        raise InputError(f"Depths to smooth need shape (frames, key points), but have {depths.shape}.")
    if not (np.isfinite(alpha) and alpha >= 0):
        raise InputError(f"The smoothness weight alpha must not be negative, but is {alpha}.")
    known = np.isfinite(depths)
    if not known.any(axis=0).all():
        raise InputError(f"Key point {int(np.argmin(known.any(axis=0)))} has no depth in any frame.")
    count = len(depths)
    if count == 1 or (alpha == 0 and known.all()):
        return depths.copy()
    # A tiny smoothness bridges gaps where none was asked for.
    strength = max(alpha, 1e-9)
    band = smoothness_band(np.full(count - 1, strength), np.full(max(count - 2, 0), strength))
    if known.all() and clamped is None:
        band[0] += 1
        return solve_band(band, depths)
    weight = known.astype(np.float64)
    if clamped is not None:
        weight[clamped & known] = CLAMPED
    result = np.empty_like(depths)
    for key in range(depths.shape[1]):
        system = band.copy()
        system[0] += weight[:, key]
        result[:, key] = solve_band(system, weight[:, key] * np.where(known[:, key], depths[:, key], 0))
    if clamped is not None:
        result[clamped & known] = depths[clamped & known]
    return result
