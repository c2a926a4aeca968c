# mypy: disable-error-code="no-untyped-def"
"""Products of long vectors in a fixed order of summation: a threaded BLAS gives other bits with other threads."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, boundscheck=False, error_model="numpy", fastmath={"reassoc", "contract"})
def products(a, b):
    """Scalar products (k, l) of the rows of a (k, n) with those of b (l, n)."""
    result = np.zeros((len(a), len(b)))
    for i in range(len(a)):
        for j in range(len(b)):
            total = 0.0
            for p in range(a.shape[1]):
                total += a[i, p] * b[j, p]
            result[i, j] = total
    return result


@njit(cache=True, nogil=True, boundscheck=False, error_model="numpy", fastmath={"contract"})
def combine(share, rows):
    """Sums (k, n) of the rows (l, n) with weights (k, l)."""
    result = np.zeros((len(share), rows.shape[1]))
    for i in range(len(share)):
        for j in range(len(rows)):
            for p in range(rows.shape[1]):
                result[i, p] += share[i, j] * rows[j, p]
    return result
