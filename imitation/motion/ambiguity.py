"""Reflection ambiguity: limbs that the video explains as well by a pose mirrored in depth (paper A, Fig. 6).

The mirrored pose often costs less than the true one, so nothing is flipped here: it is only said where.
"""

from __future__ import annotations

from itertools import pairwise

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.motion.banded import Array
from imitation.motion.lifting import LiftProblem, minimise
from imitation.progress import Progress, silent

NEAR = 0.35
"""A limb can swap sides where it lies across the view: its depth differs from its parent's by less of its length."""
MOVED = 0.03
COST = 1.05
STEPS = 15


@attrs.frozen
class AmbiguousSpan:
    """Frames in which a key point could as well be elsewhere along its ray.

    Attributes
    ----------
    name : the key point.
    first, last : frames, both included.
    decide : the frame in which one edit decides most of it.
    other : how far along the ray the other place is from the chosen one in that frame, world units (camera z).
    """

    name: str
    first: int
    last: int
    decide: int
    other: float


def limb_parents(rest: Array, pairs: NDArray[np.int32]) -> NDArray[np.int64]:
    """Parent (k,) of each key point in the tree of shortest ways from the most central one; -1 for that one."""
    from scipy import sparse
    from scipy.sparse.csgraph import dijkstra

    length = np.linalg.norm(rest[pairs[:, 0]] - rest[pairs[:, 1]], axis=1)
    graph = sparse.coo_array((length, (pairs[:, 0], pairs[:, 1])), shape=(len(rest),) * 2).tocsr()
    far, before = dijkstra(graph, directed=False, return_predecessors=True)
    # Parts without a pair between them count as very far.
    root = int(np.argmin(np.where(np.isfinite(far), far, 1e9 * (1 + length.sum())).sum(axis=1)))
    parents: NDArray[np.int64] = before[root].astype(np.int64)
    return np.where(parents < 0, -1, parents)


def find_ambiguous(
    problem: LiftProblem,
    depths: Array,
    acceleration: Array,
    stretch: Array,
    parents: NDArray[np.int64],
    progress: Progress | None = None,
) -> tuple[NDArray[np.bool_], Array]:
    """Mirror every limb in every run between two swaps, solve again, and compare.

    Parameters
    ----------
    problem, depths, acceleration, stretch : the space-time solve's data and solution, diagonals.
    parents : (k,) from `limb_parents`.

    Returns
    -------
    flags (n, k) : where a mirrored solution of nearly the same cost is elsewhere.
    other (n, k) : its depth minus the chosen one, diagonals; the largest found.
    """
    report = progress or silent
    depths, best = minimise(problem, depths, acceleration, stretch, STEPS, 1e-4)
    flags, other = np.zeros(depths.shape, bool), np.zeros(depths.shape)
    candidates = [
        (key, first, last)
        for key, parent in enumerate(parents.tolist())
        if parent >= 0
        for first, last in _runs(problem, depths, key, parent)
    ]
    for done, (key, first, last) in enumerate(candidates):
        report(done / len(candidates))
        start = depths.copy()
        frames = slice(first, last + 1)
        change = 2 * (depths[frames, parents[key]] - depths[frames, key])
        for member in [key, *_below(key, parents)]:
            start[frames, member] = np.maximum(start[frames, member] + change, 0.1 * depths[frames, member])
        mirrored, cost = minimise(problem, start, acceleration, stretch, STEPS, 1e-4)
        if cost < COST * best:
            moved = mirrored - depths
            larger = np.abs(moved) > np.abs(other)
            other[larger] = moved[larger]
            flags |= np.abs(moved) > MOVED
    report(1.0)
    return flags, other


def spans_of(flags: NDArray[np.bool_], other: Array, names: tuple[str, ...], diagonal: float) -> list[AmbiguousSpan]:
    """Runs of flagged frames per key point; each names the frame in which most key points are flagged."""
    crowd = flags.sum(axis=1)
    spans = []
    for key, name in enumerate(names):
        for first, last in runs_of(flags[:, key]):
            decide = first + int(np.argmax(crowd[first : last + 1]))
            spans.append(AmbiguousSpan(name, first, last, decide, float(other[decide, key] * diagonal)))
    return spans


def runs_of(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last position of every run of True."""
    edge = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    return list(zip(np.flatnonzero(edge == 1).tolist(), (np.flatnonzero(edge == -1) - 1).tolist(), strict=True))


def _runs(problem: LiftProblem, depths: Array, key: int, parent: int) -> list[tuple[int, int]]:
    """Runs between the frames in which a limb lies across the view, where it has some depth to mirror."""
    gap = np.abs(depths[:, key] - depths[:, parent])
    places = problem.points(depths[:1])[0]
    length = float(np.linalg.norm(places[key] - places[parent]))
    inner = np.flatnonzero((gap[1:-1] <= gap[:-2]) & (gap[1:-1] < gap[2:]) & (gap[1:-1] < NEAR * length)) + 1
    cuts = [0, *inner.tolist(), len(gap) - 1]
    return [
        (first, last) for first, last in pairwise(cuts) if last - first >= 2 and gap[first : last + 1].max() > MOVED / 2
    ]


def _below(key: int, parents: NDArray[np.int64]) -> list[int]:
    found = [child for child in range(len(parents)) if parents[child] == key]
    return found + [deeper for child in found for deeper in _below(child, parents)]
