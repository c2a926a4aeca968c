"""Compiled loops of the space-time solve: its energy and its banded Gauss-Newton system."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def energy(  # type: ignore[no-untyped-def]
    depths, centres, directions, pairs, lengths, pair_weight, acceleration_weight, target, weight
):
    """Sum of depth, acceleration and (Cauchy) length terms; arrays as in `normal_equations`."""
    count, keys = depths.shape
    total = 0.0
    for t in range(count):
        for i in range(keys):
            total += weight[t, i] * (depths[t, i] - target[t, i]) ** 2
    for t in range(count - 2):
        for i in range(keys):
            for axis in range(3):
                change = (
                    centres[t, axis] + depths[t, i] * directions[t, i, axis]
                    - 2 * (centres[t + 1, axis] + depths[t + 1, i] * directions[t + 1, i, axis])
                    + centres[t + 2, axis] + depths[t + 2, i] * directions[t + 2, i, axis]
                )  # fmt: skip
                total += acceleration_weight[t, i] * change * change
    for t in range(count):
        for p in range(len(pairs)):
            i, j = pairs[p, 0], pairs[p, 1]
            squared = 0.0
            for axis in range(3):
                squared += (depths[t, i] * directions[t, i, axis] - depths[t, j] * directions[t, j, axis]) ** 2
            residual = np.sqrt(squared) - lengths[p]
            total += np.log(1 + pair_weight[t, p] * residual * residual)
    return total


@njit(cache=True, nogil=True)
def normal_equations(  # type: ignore[no-untyped-def]
    depths, centres, directions, pairs, lengths, pair_weight, acceleration_weight, target, weight, band, gradient
):
    """Fill the lower band (2 k + 1, n k) of the Gauss-Newton matrix and half the gradient (n k,).

    depths (n, k); centres (n, 3); directions (n, k, 3); pairs (p, 2); lengths (p,); pair_weight (n, p);
    acceleration_weight (n - 2, k); target, weight (n, k). Unknowns are ordered frame by frame.
    """
    count, keys = depths.shape
    band[:] = 0.0
    for t in range(count):
        for i in range(keys):
            band[0, t * keys + i] = weight[t, i]
            gradient[t * keys + i] = weight[t, i] * (depths[t, i] - target[t, i])
    for t in range(count - 2):
        for i in range(keys):
            w = acceleration_weight[t, i]
            first = t * keys + i
            for axis in range(3):
                a, b, c = directions[t, i, axis], -2 * directions[t + 1, i, axis], directions[t + 2, i, axis]
                change = (
                    centres[t, axis] - 2 * centres[t + 1, axis] + centres[t + 2, axis]
                    + depths[t, i] * a + depths[t + 1, i] * b + depths[t + 2, i] * c
                )  # fmt: skip
                gradient[first] += w * a * change
                gradient[first + keys] += w * b * change
                gradient[first + 2 * keys] += w * c * change
                band[0, first] += w * a * a
                band[0, first + keys] += w * b * b
                band[0, first + 2 * keys] += w * c * c
                band[keys, first] += w * a * b
                band[keys, first + keys] += w * b * c
                band[2 * keys, first] += w * a * c
    for t in range(count):
        for p in range(len(pairs)):
            i, j = pairs[p, 0], pairs[p, 1]
            squared, slope_i, slope_j = 0.0, 0.0, 0.0
            for axis in range(3):
                gap = depths[t, i] * directions[t, i, axis] - depths[t, j] * directions[t, j, axis]
                squared += gap * gap
                slope_i += gap * directions[t, i, axis]
                slope_j -= gap * directions[t, j, axis]
            length = max(np.sqrt(squared), 1e-9)
            slope_i, slope_j = slope_i / length, slope_j / length
            residual = length - lengths[p]
            w = pair_weight[t, p] / (1 + pair_weight[t, p] * residual * residual)
            low, high = min(i, j), max(i, j)
            gradient[t * keys + i] += w * slope_i * residual
            gradient[t * keys + j] += w * slope_j * residual
            band[0, t * keys + i] += w * slope_i * slope_i
            band[0, t * keys + j] += w * slope_j * slope_j
            band[high - low, t * keys + low] += w * slope_i * slope_j
