"""Banded systems of smoothness along time: the normal equations of first and second differences."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def smoothness_band(first: Array, second: Array) -> Array:
    """Lower band (3, n) of the normal matrix of weighted first and second differences.

    Parameters
    ----------
    first : (n - 1,) weights of ``(z[t + 1] - z[t])^2``.
    second : (n - 2,) weights of ``(z[t + 1] - 2 z[t] + z[t - 1])^2``, empty for fewer than three frames.
    """
    count = len(first) + 1
    band = np.zeros((3, count))
    band[0, :-1] += first
    band[0, 1:] += first
    band[1, :-1] -= first
    if len(second):
        band[0, :-2] += second
        band[0, 1:-1] += 4 * second
        band[0, 2:] += second
        band[1, :-2] -= 2 * second
        band[1, 1:-1] -= 2 * second
        band[2, :-2] += second
    return band


def solve_band(band: Array, right: Array) -> Array:
    """Solve a symmetric positive definite system given by its lower band (b + 1, n)."""
    from scipy.linalg import solveh_banded

    rows = min(len(band), band.shape[1])
    solution: Array = np.asarray(solveh_banded(band[:rows], right, lower=True, check_finite=False), np.float64)
    return solution
