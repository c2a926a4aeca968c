"""Structure of the whole sequence at once (method "optimal")."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.structure.leaving import held, settle
from tvmedit.structure.segments import best_period, best_segments, repeat_costs, repeats_within, texton_chain
from tvmedit.structure.splitting import split_unlike
from tvmedit.structure.structure import Cluster, Structure, texton_curve
from tvmedit.structure.warping import SAME_MOTION, texton_difference

NOVELTY_SHARE = 0.55
"""Lambda, the price of a frame of new motion, as a share of the median atom distance."""
PENALTY_SECONDS = 0.3
"""A cluster costs as much as so many seconds of new motion."""
WITHIN = 0.33
"""Within a stretch that does not repeat a cluster costs this share: a motion may repeat briefly between actions."""
SHORTEST_PERIOD = 0.5
LONGEST_PERIOD = 5.0
STILL = 0.3
"""Median distances below this are a body that hardly moves (Hellinger distance of the robust features)."""
MOTIONLESS = 0.4
"""Below so many times that the sequence is one motion that does not repeat."""
LENGTH_SPREAD = 0.15


def parse_optimal(
    atoms: NDArray[np.float32],
    fps: float,
    *,
    longest_period: float = LONGEST_PERIOD,
    sensitivity: float = 1.0,
    force_cyclic: bool = False,
    still: float = STILL,
    boundaries: Sequence[int] | None = None,
) -> Structure:
    """See ``parse_structure``."""
    n = len(atoms)
    shortest = max(3, round(SHORTEST_PERIOD * fps))
    longest = max(shortest, min(round(longest_period * fps), int(n / 1.8)))
    median = _median_beyond(atoms, shortest)
    novelty = NOVELTY_SHARE * max(median, still)
    if novelty <= 0:
        novelty = 1e-6
    penalty = PENALTY_SECONDS * fps * novelty / sensitivity
    sums = np.zeros((0, n + 1)) if n < 2 * shortest else repeat_costs(atoms, shortest, longest, 2.0 * novelty)
    if boundaries is None and median < MOTIONLESS * still and not force_cyclic:
        # Posture and noise must not be taken for motion.
        starts, periods = np.zeros(1, np.int64), np.zeros(1, np.int64)
    elif boundaries is None:
        starts, periods = best_segments(sums, shortest, novelty, penalty, force_cyclic)
        starts, periods = repeats_within(sums, starts, periods, shortest, novelty, WITHIN * penalty)
    else:
        starts = _given_starts(boundaries, n)
        stops = [*starts[1:], n]
        spans = zip(starts, stops, strict=True)
        periods = np.array([best_period(sums, shortest, int(a), int(b), novelty, force_cyclic) for a, b in spans])
    clusters = _clusters(atoms, starts, periods, novelty)
    if boundaries is None:
        clusters = _merged(atoms, clusters, novelty)
        clusters = [piece for cluster in clusters for piece in split_unlike(atoms, cluster, novelty)]
        clusters = settle(atoms, clusters, novelty, fps)
    if not force_cyclic:
        clusters = held(atoms, clusters, novelty)
    if force_cyclic and (boundaries is not None or len(clusters) == 1):
        clusters = [_one_round(cluster, shortest) for cluster in clusters]
    clusters = _kinds(atoms, clusters, novelty)
    found = tuple(clusters)
    reason = _reason(found, median, still, fps)
    return Structure(found, "optimal", novelty, texton_curve(atoms, found), _novelty(atoms, found), reason)


def _median_beyond(atoms: NDArray[np.float32], lag: int) -> float:
    """Median of the distances between frames further apart than a lag."""
    n = len(atoms)
    if n <= lag + 1:
        return float(np.median(atoms))
    return float(np.median(atoms[np.triu_indices(n, lag + 1)]))


def _given_starts(boundaries: Sequence[int], n: int) -> NDArray[np.int64]:
    starts = sorted({0, *(int(frame) for frame in boundaries)})
    if starts[0] < 0 or starts[-1] >= n:
        raise InputError(
            f"The boundaries {list(boundaries)} leave the sequence of {n} frames: give frames 1 to {n - 1}."
        )
    return np.array(starts, np.int64)


def _clusters(
    atoms: NDArray[np.float32], starts: NDArray[np.int64], periods: NDArray[np.int64], novelty: float
) -> list[Cluster]:
    clusters = []
    stops = [*starts[1:], len(atoms)]
    for first, stop, period in zip(starts.tolist(), stops, periods.tolist(), strict=True):
        if period:
            chain = texton_chain(atoms, first, int(stop), period, novelty, LENGTH_SPREAD)
            if len(chain) >= 2:
                textons = tuple((int(a), int(b) - 1) for a, b in itertools.pairwise(chain))
                length = float(np.median(np.diff(chain)))
                reason = f"It repeats about every {length:.0f} frames, and what comes next does not."
                clusters.append(Cluster(first, int(stop) - 1, True, textons, length, reason=reason))
                continue
        reason = "It does not repeat: no earlier frame within the longest period is near enough."
        span = (first, int(stop) - 1)
        clusters.append(Cluster(*span, False, (span,), float(stop - first), reason=reason))
    return clusters


def _merged(atoms: NDArray[np.float32], clusters: list[Cluster], novelty: float) -> list[Cluster]:
    """Join neighbours that are one motion at another speed, the most alike first."""
    joined = list(clusters)
    while len(joined) > 1:
        differences = [texton_difference(atoms, a, b) for a, b in itertools.pairwise(joined)]
        least = int(np.argmin(differences))
        if not differences[least] < SAME_MOTION * novelty:
            break
        first, second = joined[least], joined[least + 1]
        textons = first.textons + second.textons
        length = float(np.median([b - a + 1 for a, b in textons]))
        reason = f"One motion that changes its speed, from {first.period:.0f} to {second.period:.0f} frames a period."
        joined[least : least + 2] = [Cluster(first.first, second.last, True, textons, length, reason=reason)]
    return joined


def _one_round(cluster: Cluster, shortest: int) -> Cluster:
    """A cluster in which nothing was found to come again, as one round of something that does."""
    if cluster.cyclic or len(cluster) < shortest:
        return cluster
    return attrs.evolve(cluster, cyclic=True, reason="That it repeats is the user's word: it shows one round.")


def _kinds(atoms: NDArray[np.float32], clusters: list[Cluster], novelty: float) -> list[Cluster]:
    """Number the kinds of motion: clusters apart from each other may show the same one."""
    numbered: list[Cluster] = []
    for cluster in clusters:
        kind = max((other.kind for other in numbered), default=-1) + 1
        for other in numbered[:-1]:
            if texton_difference(atoms, other, cluster, adjacent=False) < SAME_MOTION * novelty:
                kind = other.kind
                break
        numbered.append(attrs.evolve(cluster, kind=kind))
    return numbered


def _novelty(atoms: NDArray[np.float32], clusters: tuple[Cluster, ...]) -> NDArray[np.float64]:
    """Distance of each frame to the one a period before, inside its cluster."""
    curve = np.full(len(atoms), np.nan)
    for cluster in clusters:
        if cluster.cyclic:
            period = round(cluster.period)
            frames = np.arange(cluster.first + period, cluster.last + 1)
            curve[frames] = atoms[frames, frames - period]
    return curve


def _reason(clusters: tuple[Cluster, ...], median: float, still: float, fps: float) -> str:
    if median < still:
        return f"The performer hardly moves: the median atom distance is {median:.2g}, under {still:.2g}."
    if len(clusters) == 1 and clusters[0].cyclic:
        return f"One motion throughout, a period about {clusters[0].period / fps:.2f} s."
    cyclic = sum(cluster.cyclic for cluster in clusters)
    return f"{len(clusters)} clusters, {cyclic} of them repeat; median atom distance {median:.2g}."
