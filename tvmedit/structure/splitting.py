"""Two motions that repeat alike and differ in part: cutting a cluster whose textons fall into two unlike groups.

The exact segmentation compares a frame with the one a period before. Where one motion takes over another's rhythm and
differs in one limb only, a single period is dear and all that follow are cheap: not enough for a cluster of its own.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from tvmedit.structure.structure import Cluster, Span
from tvmedit.structure.warping import warp_cost

LEAST_DIFFERENCE = 0.7
"""Groups must differ by so many lambda a frame ..."""
LEAST_RATIO = 1.5
"""... and by so much more than any two textons within a group, ..."""
LARGEST_SPEED_UP = 1.18
"""... in the same rhythm: a motion that grows faster is one motion."""


def split_unlike(atoms: NDArray[np.float32], cluster: Cluster, novelty: float) -> list[Cluster]:
    """Cut a cyclic cluster where all textons before differ from all after, again and again; [cluster] where none do."""
    textons = cluster.textons
    if not cluster.cyclic or len(textons) < 4:
        return [cluster]
    difference = _differences(atoms, textons)
    best, strongest = (0, 0), 0.0
    # The texton that the change falls into may be of neither group.
    for cut, left_out in itertools.product(range(2, len(textons) - 1), (0, 1)):
        after = cut + left_out
        if after > len(textons) - 2 or not _alike(_period(textons[:cut]), _period(textons[after:])):
            continue
        across = float(difference[:cut, after:].min())
        within = max(float(difference[:cut, :cut].max()), float(difference[after:, after:].max()))
        if across > LEAST_DIFFERENCE * novelty and across > LEAST_RATIO * within and across - within > strongest:
            best, strongest = (cut, after), across - within
    if not best[0]:
        return [cluster]
    frame = _changeover(atoms, textons[: best[0]], textons[best[1] :])
    reason = f"Its textons differ from the next ones by {strongest / novelty:.2f} lambda more than among themselves."
    left = tuple(span for span in textons[: best[1]] if span[1] < frame)
    right = tuple(span for span in textons[best[0] :] if span[0] >= frame)
    if not left or not right:
        return [cluster]
    first = Cluster(cluster.first, frame - 1, True, left, _period(left), reason=reason)
    second = Cluster(frame, cluster.last, True, right, _period(right), reason=cluster.reason)
    return split_unlike(atoms, first, novelty) + split_unlike(atoms, second, novelty)


def _differences(atoms: NDArray[np.float32], textons: tuple[Span, ...]) -> NDArray[np.float64]:
    """Mean cost of warping each texton onto each other one, the ends free by a fifth of it."""
    count, last = len(textons), len(atoms) - 1
    difference = np.zeros((count, count))
    for i, (a, b) in enumerate(textons):
        for j, (c, d) in enumerate(textons):
            if i != j:
                free = (d - c + 1) // 5
                difference[i, j] = warp_cost(atoms, a, b, max(0, c - free), min(last, d + free))
    return 0.5 * (difference + difference.T)


def _changeover(atoms: NDArray[np.float32], before: tuple[Span, ...], after: tuple[Span, ...]) -> int:
    """First frame that looks more like what follows than like what went before, best for all frames around."""
    reach = before[-1][1] - before[-1][0] + 1
    low, high = before[-1][0], min(after[0][1], after[0][0] + reach)
    old = np.arange(before[0][0], before[-1][0])
    new = np.arange(after[0][1] + 1, after[-1][1] + 1)
    frames = np.arange(low, high + 1)
    gain = atoms[np.ix_(frames, old)].min(axis=1) - atoms[np.ix_(frames, new)].min(axis=1)
    return int(frames[int(np.argmin(np.r_[0.0, np.cumsum(gain)[:-1]]))])


def _alike(first: float, second: float) -> bool:
    return max(first, second) < LARGEST_SPEED_UP * min(first, second)


def _period(textons: tuple[Span, ...]) -> float:
    return float(np.median([b - a + 1 for a, b in textons]))
