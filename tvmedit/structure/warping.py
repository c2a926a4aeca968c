"""Is it one motion at another speed? Warping a texton of one cluster onto another cluster's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled
from tvmedit.structure.structure import Cluster

SAME_MOTION = 1.0
"""Clusters whose textons warp onto each other for less than so many lambda a frame show the same motion."""
LARGEST_SPEED_UP = 1.9


@compiled
def warp_cost(atoms: NDArray[np.floating], first: int, last: int, low: int, high: int) -> float:
    """Mean cost of warping frames first..last onto some stretch of low..high (all included), steps 1:1, 1:2 and 2:1."""
    n, m = last - first + 1, high - low + 1
    total = np.full((n, m), np.inf)
    for j in range(m):
        total[0, j] = atoms[first, low + j]
    for i in range(1, n):
        for j in range(m):
            here = atoms[first + i, low + j]
            value = np.inf
            if j >= 1:
                value = total[i - 1, j - 1] + here
            if j >= 2:
                value = min(value, total[i - 1, j - 2] + 0.5 * (atoms[first + i, low + j - 1] + here))
            if i >= 2 and j >= 1:
                value = min(value, total[i - 2, j - 1] + atoms[first + i - 1, low + j] + here)
            total[i, j] = value
    if n == 1:
        return float(total[0].min())
    return float(total[n - 1].min() / n)


def texton_difference(atoms: NDArray[np.floating], earlier: Cluster, later: Cluster, *, adjacent: bool = True) -> float:
    """Mean cost a frame of warping a texton of each of two cyclic clusters onto two of the other's.

    Adjacent clusters are compared where they meet, others in their middle. Infinite where one does not repeat or one
    is more than 1.9 times as fast.
    """
    if not (earlier.cyclic and later.cyclic):
        return float("inf")
    ratio = max(earlier.period, later.period) / min(earlier.period, later.period)
    if ratio >= LARGEST_SPEED_UP:
        return float("inf")
    before = earlier.textons[-2:] if adjacent else _middle(earlier)
    after = later.textons[:2] if adjacent else _middle(later)
    there = warp_cost(atoms, before[-1][0], before[-1][1], after[0][0], _reach(atoms, after, later))
    back = warp_cost(atoms, after[0][0], after[0][1], max(earlier.first, before[0][0] - 2), before[-1][1])
    return 0.5 * float(there + back)


def _reach(atoms: NDArray[np.floating], textons: tuple[tuple[int, int], ...], cluster: Cluster) -> int:
    """End of the stretch warped onto: two periods from the first texton's start, so that any phase finds its match."""
    wanted = textons[0][0] + int(2 * cluster.period)
    return min(max(textons[-1][1], wanted), cluster.last, len(atoms) - 1)


def _middle(cluster: Cluster) -> tuple[tuple[int, int], ...]:
    at = max(0, len(cluster.textons) // 2 - 1)
    return cluster.textons[at : at + 2]
