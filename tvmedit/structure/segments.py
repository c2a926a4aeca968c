"""Exact segmentation of a sequence: new motion costs, repetition is free."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled

Array = NDArray[np.float64]
Atoms = NDArray[np.float32]
Frames = NDArray[np.int64]

SLACK = 0.12
"""A repeat may come so much earlier or later, in periods."""
LEAST_REPEATS = 1.8
"""A cyclic segment holds at least so many periods."""


@compiled
def repeat_costs(atoms: Atoms, shortest: int, longest: int, limit: float) -> Array:
    """Running sums of what frame t costs as a repeat at period p.

    E_p(t) is the least atom distance to the frames p (1 - 0.12) .. p (1 + 0.12) before it, cut off at ``limit``; half
    a frame to either side of each counts too, so that a quick motion repeats as well at few frames a second.

    Parameters
    ----------
    atoms : (n, n) float32
    shortest, longest : int
        Periods in frames, both included.
    limit : float

    Returns
    -------
    (longest - shortest + 1, n + 1) float64
        Row p - shortest: sums[t] = E_p(0) + ... + E_p(t - 1); a frame without a frame p before it costs the limit.
    """
    n = len(atoms)
    sums = np.zeros((longest - shortest + 1, n + 1))
    between = _between_frames(atoms, longest + int(SLACK * longest))
    for row in range(len(sums)):
        period = row + shortest
        slack = int(SLACK * period)
        total = 0.0
        for t in range(n):
            cost = limit
            for back in range(max(1, period - slack), min(t, period + slack) + 1):
                cost = min(cost, between[t, back])
            total += cost
            sums[row, t + 1] = total
    return sums


@compiled
def _between_frames(atoms: Atoms, furthest: int) -> Atoms:
    """Atom distance of each frame to those 1 .. ``furthest`` before it, (n, furthest + 1), between frames too.

    A frame's distance to the straight way from one earlier frame to the next follows from the three distances between
    them; each earlier frame gets the least to either side of it.
    """
    n = len(atoms)
    least = np.zeros((n, furthest + 1), np.float32)
    for t in range(n):
        for back in range(1, min(t, furthest) + 1):
            here = atoms[t, t - back] ** 2
            value = here
            for side in (-1, 1):
                other = back + side
                if other < 1 or other > t:
                    continue
                there, step = atoms[t, t - other] ** 2, atoms[t - back, t - other] ** 2
                if step > 0.0:
                    share = 0.5 * (1.0 + (here - there) / step)
                    # Half-way belongs to both, whatever the rounding.
                    if 0.0 < share < 0.501:
                        value = min(value, here - share * share * step)
            least[t, back] = np.sqrt(max(value, 0.0))
    return least


@compiled
def best_segments(
    sums: Array, shortest: int, novelty: float, penalty: float, force_cyclic: bool
) -> tuple[Frames, Frames]:
    """Cheapest cut of the whole sequence into segments, each with a period or none.

    A segment [a, b) of period p costs penalty + novelty p + the repeats' costs from a + p on; one that does not
    repeat costs penalty + novelty (b - a). As the cost is a difference of running sums, the best start for each end
    and period is a running minimum: n times the number of periods in all.

    Returns
    -------
    starts (k,), periods (k,) int64
        First frame of each segment in order; period 0 where it does not repeat.
    """
    periods, n = sums.shape[0], sums.shape[1] - 1
    cost = np.full(n + 1, np.inf)
    came, kept = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
    cost[0] = 0.0
    best_new, best_new_at = np.inf, 0
    best = np.full(periods, np.inf)
    best_at = np.zeros(periods, np.int64)
    done = np.zeros(periods, np.int64)
    # With force_cyclic new motion is so dear that only what is too short for any period stays unrepeated.
    price = novelty * (1000.0 if force_cyclic else 1.0)
    for b in range(1, n + 1):
        if cost[b - 1] - price * (b - 1) < best_new:
            best_new, best_new_at = cost[b - 1] - price * (b - 1), b - 1
        cost[b] = penalty + price * b + best_new
        came[b] = best_new_at
        for row in range(periods):
            period = row + shortest
            newest = b - int(np.ceil(LEAST_REPEATS * period))
            while done[row] <= newest:
                a = done[row]
                value = cost[a] - sums[row, a + period]
                if value < best[row]:
                    best[row], best_at[row] = value, a
                done[row] += 1
            value = penalty + novelty * period + sums[row, b] + best[row]
            if value < cost[b]:
                cost[b], came[b], kept[b] = value, best_at[row], period
    count, b = 0, n
    starts, chosen = np.zeros(n, np.int64), np.zeros(n, np.int64)
    while b > 0:
        starts[count], chosen[count] = came[b], kept[b]
        b = came[b]
        count += 1
    return starts[:count][::-1].copy(), chosen[:count][::-1].copy()


def repeats_within(
    sums: Array, starts: Frames, periods: Frames, shortest: int, novelty: float, penalty: float
) -> tuple[Frames, Frames]:
    """Cut the segments that do not repeat once more, at another penalty, where something inside them does.

    Actions that are done once follow each other at no cost, so a motion repeated for a moment between two of them would
    have to pay for itself and for the second action. Arguments and result as of ``best_segments``.
    """
    stops = [*starts[1:].tolist(), sums.shape[1] - 1]
    cut = []
    for first, stop, period in zip(starts.tolist(), stops, periods.tolist(), strict=True):
        if period or stop - first < LEAST_REPEATS * shortest:
            cut.append((np.array([first]), np.array([period])))
            continue
        inside = np.ascontiguousarray(sums[:, first : stop + 1])
        within, found = best_segments(inside, shortest, novelty, penalty, False)
        cut.append((first + within, found))
    return np.concatenate([part[0] for part in cut]), np.concatenate([part[1] for part in cut])


@compiled
def best_period(sums: Array, shortest: int, first: int, last: int, novelty: float, force_cyclic: bool) -> int:
    """Period of one segment [first, last) whose ends are given; 0 where new motion throughout is cheaper."""
    least = np.inf if force_cyclic else novelty * (last - first)
    chosen = 0
    for row in range(len(sums)):
        period = row + shortest
        if LEAST_REPEATS * period > last - first:
            break
        value = novelty * period + sums[row, last] - sums[row, first + period]
        if value < least:
            least, chosen = value, period
    return chosen


@compiled
def texton_chain(atoms: Atoms, first: int, last: int, period: int, novelty: float, spread: float) -> Frames:
    """Starts of the textons of a cyclic segment [first, last), and the end of the last one.

    The chain of starts with the least sum of A[start, next start] plus a quadratic price on a length that differs
    from the period; frames left over at either end cost ``novelty`` a period.

    Returns
    -------
    (k + 1,) int64
        Starts of k textons and the frame after the last; fewer than two where no texton fits.
    """
    stop = min(last, len(atoms) - 1)
    low, high = max(2, int(np.ceil(0.7 * period))), int(1.3 * period)
    size = stop - first + 1
    cost, came = np.empty(size), np.full(size, -1)
    idle = novelty / period
    best_end, least = -1, np.inf
    for i in range(size):
        cost[i] = idle * i
        for back in range(low, min(high, i) + 1):
            stretch = (back - period) / (spread * period)
            value = cost[i - back] + atoms[first + i - back, first + i] + 0.5 * novelty * stretch * stretch
            if value < cost[i]:
                cost[i], came[i] = value, i - back
        if came[i] >= 0 and cost[i] + idle * (last - first - i) < least:
            least, best_end = cost[i] + idle * (last - first - i), i
    chain = np.empty(size, np.int64)
    count = 0
    while best_end >= 0:
        chain[count] = first + best_end
        count += 1
        best_end = came[best_end]
    return chain[:count][::-1].copy()
