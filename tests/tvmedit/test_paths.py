"""Best paths against every path there is; lengths against every performance."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tvmedit
from imitation import InputError, NoSolution
from tvmedit.graph.dwell import dwell_frames, least_dwell
from tvmedit.graph.lengths import LengthSearch
from tvmedit.graph.search import path_key


def random_weights(seed: int, count: int, levels: int = 3) -> np.ndarray:
    """A half dense graph with ties."""
    random = np.random.default_rng(seed)
    weights = random.integers(1, levels + 1, (count, count)).astype(float)
    weights[random.random((count, count)) < 0.5] = np.inf
    np.fill_diagonal(weights, np.inf)
    return weights


def every_path(weights: np.ndarray, start: int, goal: int) -> list[tuple]:
    """All paths without repeated nodes, in the order of preference."""
    found = []

    def grow(path: list[int]) -> None:
        if path[-1] == goal:
            found.append(path_key(weights, path))
            return
        for node in np.flatnonzero(np.isfinite(weights[path[-1]])).tolist():
            if node not in path:
                grow([*path, node])

    grow([start])
    return sorted(found)


@settings(deadline=None, max_examples=80)
@given(seed=st.integers(0, 10**6), count=st.integers(2, 6), levels=st.sampled_from([1, 3, 1000]))
def test_best_paths_are_the_first_of_all_paths(seed: int, count: int, levels: int) -> None:
    """Best and next best agree with enumeration, ties included; Algorithm 1 has the same cost and never fewer edges."""
    weights = random_weights(seed, count, levels)
    expected = every_path(weights, 0, count - 1)
    if not expected:
        with pytest.raises(tvmedit.Unreachable):
            tvmedit.best_path(weights, 0, count - 1)
        return
    assert tuple(tvmedit.best_path(weights, 0, count - 1)) == expected[0][3]
    assert [tuple(p) for p in tvmedit.best_paths(weights, 0, count - 1, 5)] == [key[3] for key in expected[:5]]
    printed = path_key(weights, tvmedit.best_path(weights, 0, count - 1, method="paper"))
    assert printed[0] == expected[0][0]
    assert printed[1] >= expected[0][1]


def test_algorithm_1_is_not_exact() -> None:
    """The smallest counter-example: it goes through b although a is reached directly within the same cost."""
    s, a, b, t = range(4)
    weights = np.full((4, 4), np.inf)
    weights[s, a], weights[s, b], weights[b, a], weights[a, t] = 2, 1, 1, 3
    assert tvmedit.best_path(weights, s, t) == [s, a, t]
    assert tvmedit.best_path(weights, s, t, method="paper") == [s, b, a, t]


def test_forbidden_motions_are_avoided_and_never_keys() -> None:
    """The way round is taken; a forbidden key is an error; no way is said so."""
    weights = np.array([[np.inf, 1, 5], [np.inf, np.inf, 1], [np.inf, np.inf, np.inf]])
    assert tvmedit.best_path(weights, 0, 2) == [0, 1, 2]
    assert tvmedit.best_path(weights, 0, 2, forbidden=[1]) == [0, 2]
    with pytest.raises(InputError, match="forbidden"):
        tvmedit.best_path(weights, 0, 2, forbidden=[2])
    with pytest.raises(tvmedit.Unreachable, match="Motion 0 cannot be reached from motion 2"):
        tvmedit.best_path(weights, 2, 0)


@settings(deadline=None, max_examples=60)
@given(size=st.integers(1, 30), entry=st.integers(0, 29), leave=st.integers(0, 29))
def test_dwell_plays_every_frame_and_no_longer_than_needed(size: int, entry: int, leave: int) -> None:
    """It ends at the frame left after, holds every frame, and one round less would not."""
    node = tvmedit.Node(0, 100, 99 + size, True)
    entry, leave = 100 + entry % size, 100 + leave % size
    frames = dwell_frames(node, entry, least_dwell(node, entry, leave))
    assert frames[0] == entry
    assert frames[-1] == leave
    assert set(frames) == set(range(100, 100 + size))
    assert len(frames) - size < size


def every_length(
    nodes: list, weights: np.ndarray, frames: np.ndarray, keys: list[int], longest: int
) -> dict[int, float]:
    """Least bottleneck of every reachable length, by walking all performances."""
    best: dict[int, float] = {}
    seen: dict[tuple, float] = {}
    stack = [(keys[0], nodes[keys[0]].first, 1, 0, 0.0, 0)]
    while stack:
        node, entry, played, length, cost, cuts = stack.pop()
        state = (node, entry, played, length, cuts)
        if seen.get(state, np.inf) <= cost:
            continue
        seen[state] = cost
        motion = nodes[node]
        for other in [None, *np.flatnonzero(np.isfinite(weights[node])).tolist()]:
            leave = motion.last if other is None else int(frames[node, other, 0])
            total = length + least_dwell(motion, entry, leave)
            while total <= longest:
                if other is None:
                    if played == len(keys):
                        best[total] = min(best.get(total, np.inf), cost)
                elif cuts < 16:
                    count = played + (played < len(keys) and other == keys[played])
                    step = max(cost, float(weights[node, other]))
                    stack.append((other, int(frames[node, other, 1]), count, total, step, cuts + 1))
                total += len(motion)
    return best


@pytest.mark.parametrize("seed", range(6))
def test_wanted_lengths_are_reached_exactly_where_they_can_be(seed: int) -> None:
    """Every length up to 60 frames: the same lengths and the same least bottleneck as all performances walked."""
    random = np.random.default_rng(seed)
    sizes = random.integers(5, 12, 4)
    nodes = [tvmedit.Node(0, 100 * k, 100 * k + int(n) - 1, True) for k, n in enumerate(sizes)]
    weights = random_weights(seed + 50, 4, 5)
    weights[0, 1], weights[1, 2] = 3, 4
    frames = np.array(
        [[[a.first + random.integers(len(a)), b.first + random.integers(len(b))] for b in nodes] for a in nodes]
    )
    expected = every_length(nodes, weights, frames, [0, 2], 60)
    for wanted in range(15, 61):
        plan = LengthSearch(nodes, weights, frames, [0, 2], [1, 1], (), 60).plan(wanted)
        nearest = min(expected, key=lambda length: (abs(length - wanted), length))
        assert plan.length == nearest
        assert plan.cost <= expected[nearest]
        assert sum(stop.count for stop in plan.stops) == plan.length
        assert (
            max([0.0, *(weights[a.node, b.node] for a, b in zip(plan.stops[:-1], plan.stops[1:], strict=True))])
            == plan.cost
        )


def test_a_length_that_no_performance_has_is_no_solution() -> None:
    """Longer than asked in every case."""
    nodes = [tvmedit.Node(0, 0, 9, True), tvmedit.Node(0, 20, 29, True)]
    weights = np.array([[np.inf, 1], [np.inf, np.inf]])
    frames = np.array([[[-1, -1], [9, 20]], [[-1, -1], [-1, -1]]])
    with pytest.raises(NoSolution, match="longer"):
        LengthSearch(nodes, weights, frames, [0, 1], [1, 1], (), 15).plan(12)
