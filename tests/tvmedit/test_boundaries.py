"""Boundaries where motions that repeat meet actions that are done once."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import tvmedit
from tvmedit.structure.leaving import settle
from tvmedit.structure.segments import SLACK, best_segments, repeat_costs
from tvmedit.structure.structure import Cluster


def distances(points: np.ndarray) -> np.ndarray:
    """Distances between all points."""
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def circle(period: float, frames: int, centre: tuple[float, float]) -> np.ndarray:
    """Points that go round, a whole round each period."""
    angle = 2 * np.pi * np.arange(frames) / period
    return np.stack([np.cos(angle) + centre[0], np.sin(angle) + centre[1], np.zeros(frames)], axis=1)


def far_away(frames: int, seed: int) -> np.ndarray:
    """An action that never comes by where it was."""
    away = 4.0 + 0.6 * np.arange(frames)
    return np.stack([np.full(frames, 10.0 * seed), away, np.full(frames, 2.0)], axis=1)


@pytest.mark.parametrize("period", [7.0, 7.5, 10.5])
def test_a_period_between_two_whole_numbers_of_frames_repeats_as_well(period: float) -> None:
    """A quick motion at few frames a second: no cost of a repeat is over a quarter of a frame's step."""
    atoms = distances(circle(period, 60, (0.0, 0.0)))
    step = atoms[0, 1]
    sums = repeat_costs(atoms, 5, 12, 10.0)
    costs = np.diff(sums[round(period) - 5])[15:]
    assert costs.max() < 0.25 * step
    assert (np.diff(sums, axis=1) >= 0).all()


def test_repeats_are_never_dearer_than_at_whole_frames() -> None:
    """Looking between frames takes the least of what is there, whatever the distances."""
    points = np.random.default_rng(3).standard_normal((40, 6))
    atoms = distances(points)
    costs = np.diff(repeat_costs(atoms, 6, 9, 1e9), axis=1)
    for row, period in enumerate(range(6, 10)):
        slack = int(SLACK * period)
        for t in range(12, 40):
            assert costs[row, t] <= min(atoms[t, t - period - s] for s in range(-slack, slack + 1)) + 1e-6


def test_a_short_motion_between_two_actions_is_found() -> None:
    """Two rounds and a half between actions that are done once: too few to pay for both its neighbours."""
    run, first, second = circle(9.0, 22, (0.0, 0.0)), far_away(20, 1), far_away(20, 2)
    atoms = distances(
        np.concatenate([circle(12.0, 60, (30.0, 0.0)), first, run, second, circle(12.0, 60, (60.0, 0.0))])
    )
    structure = tvmedit.parse_structure(np.minimum(atoms, 1.6), fps=15)
    starts = [cluster.first for cluster in structure.clusters if cluster.cyclic]
    assert len(starts) == 3
    assert starts[1] == pytest.approx(80, abs=2)


def test_a_rest_begins_where_its_posture_has_been_left_for_the_last_time() -> None:
    """The action before it comes through the posture, sways out of it, and only then stands still."""
    sway = np.concatenate([np.linspace(6, 0, 13)[:-1], np.zeros(3), np.sin(np.linspace(0, np.pi, 9)), np.zeros(30)])
    atoms = distances(np.stack([sway, np.zeros_like(sway), np.zeros_like(sway)], axis=1)).astype(np.float32)
    action = Cluster(0, 11, False, ((0, 11),), 12.0)
    rest = Cluster(12, len(sway) - 1, True, ((12, 22), (23, 33), (34, 44)), 11.0)
    before, after = settle(atoms, [action, rest], 1.0, 15.0)
    assert 19 <= after.first <= 23
    assert before.last == after.first - 1
    assert before.textons == ((0, before.last),)
    assert all(first >= after.first for first, _ in after.textons)


def test_what_moves_keeps_its_boundary() -> None:
    """A motion is no rest, however much one of its rounds differs; nor is a rest moved that is held throughout."""
    points = np.concatenate([far_away(20, 1), circle(12.0, 60, (0.0, 0.0))])
    points[26:30] *= 1.5
    moving = [Cluster(0, 19, False, ((0, 19),), 20.0), Cluster(20, 79, True, ((20, 31), (32, 43)), 12.0)]
    assert settle(distances(points).astype(np.float32), moving, 0.5, 15.0) == moving
    held = np.concatenate([far_away(20, 1), np.zeros((40, 3))])
    still = [Cluster(0, 19, False, ((0, 19),), 20.0), Cluster(20, 59, True, ((20, 31), (32, 43)), 12.0)]
    assert settle(distances(held).astype(np.float32), still, 0.5, 15.0) == still


def test_the_cheapest_cut_is_still_the_cheapest() -> None:
    """Against every cut of a short sequence into at most three segments."""
    points = np.concatenate([circle(4.0, 14, (0.0, 0.0)), circle(5.0, 16, (9.0, 0.0))])
    atoms = np.minimum(distances(points), 2.0)
    sums = repeat_costs(atoms, 3, 6, 1.0)
    novelty, penalty = 0.5, 1.0

    def price(a: int, b: int) -> float:
        least = penalty + novelty * (b - a)
        for period in range(3, 7):
            if b - a >= np.ceil(1.8 * period):
                least = min(least, penalty + novelty * period + sums[period - 3, b] - sums[period - 3, a + period])
        return float(least)

    starts, _ = best_segments(sums, 3, novelty, penalty, False)
    ends = [*starts.tolist(), 30]
    found = sum(price(a, b) for a, b in itertools.pairwise(ends))
    every = [price(0, 30)] + [price(0, a) + price(a, 30) for a in range(1, 30)]
    every += [price(0, a) + price(a, b) + price(b, 30) for a in range(1, 29) for b in range(a + 1, 30)]
    assert found == pytest.approx(min(every))


def test_a_rest_is_one_motion_that_is_played_once() -> None:
    """Between two circles somebody stands still, swaying as it comes; a small motion that repeats is none."""
    random = np.random.default_rng(5)
    first, last = circle(15.0, 75, (0.0, 0.0)), circle(15.0, 75, (4.0, 0.0))
    sway = np.cumsum(random.normal(0.0, 0.01, (60, 3)), axis=0) + random.normal(0.0, 0.02, (60, 3)) + [0.0, 0.0, 2.0]
    points = np.concatenate([first, sway, last])
    structure = tvmedit.parse_structure(distances(points), fps=15)
    rest = next(cluster for cluster in structure.clusters if cluster.first <= 100 <= cluster.last)
    assert not rest.cyclic
    assert rest.textons == ((rest.first, rest.last),)
    assert len(rest) > 45
    assert [cluster.cyclic for cluster in structure.clusters] == [True, False, True]
    forced = tvmedit.parse_structure(distances(points), fps=15, force_cyclic=True)
    assert next(cluster for cluster in forced.clusters if cluster.first <= 100 <= cluster.last).cyclic
    small = 0.1 * first[:60] + [0.0, 0.0, 2.0]
    again = tvmedit.parse_structure(distances(np.concatenate([first, small, last])), fps=15)
    assert all(cluster.cyclic for cluster in again.clusters)
