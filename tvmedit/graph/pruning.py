"""Which edges stay: as printed (eq. 13 and 14), or by an absolute limit that never cuts the graph apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
JUMP_SECONDS = 0.1
"""Default limit at mu = 1: a cut may jump as far as the performer moves in so many seconds."""


def printed_limits(weights: Array) -> Array:
    """Mean weight of each node's edges to the others (eq. 13): the mean of the k - 1 out-edges, (k,)."""
    finite = np.where(np.isfinite(weights), weights, 0.0)
    return np.asarray(finite.sum(axis=1) / max(len(weights) - 1, 1))


def prune_printed(weights: Array, mu: float) -> Array:
    """Eq. 14: an edge goes if its weight is at least mu times the mean of its node's edges."""
    return np.where(weights >= mu * printed_limits(weights)[:, None], np.inf, weights)


def prune_absolute(weights: Array, limit: float) -> tuple[Array, NDArray[np.bool_]]:
    """Keep what weighs less than a limit, and the cheapest further edges without which a motion is out of reach.

    Edges over the limit are looked at from the cheapest up; one is kept, and marked as poor, if its end cannot be
    reached from its start by what is kept so far. So every two motions stay joined by a path of the least bottleneck
    there is.

    Returns
    -------
    weights (k, k), inf where pruned; poor (k, k) bool
    """
    count = len(weights)
    kept = np.where(weights < limit, weights, np.inf)
    reach = _reachable(np.isfinite(kept))
    poor = np.zeros((count, count), bool)
    over = np.argwhere(np.isfinite(weights) & ~np.isfinite(kept))
    order = np.argsort(weights[over[:, 0], over[:, 1]], kind="stable")
    for a, b in over[order]:
        if reach.all():
            break
        if not reach[a, b]:
            kept[a, b], poor[a, b] = weights[a, b], True
            # Whoever reaches a now reaches whatever b reaches.
            reach |= reach[:, a][:, None] & reach[b][None, :]
    return kept, poor


def _reachable(edges: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which nodes reach which, themselves included."""
    reach = edges | np.eye(len(edges), dtype=bool)
    while True:
        further = (reach.astype(np.int64) @ reach.astype(np.int64)) > 0
        if (further == reach).all():
            return reach
        reach = further
