"""What carries a foot beside an edge: the paving behind a wall, the tread at whose end it stands."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.cameras import local_ground
from imitation.cameras.standing import standing_ground
from imitation.errors import NoSolution
from tests.imitation.cameras.scenes import handheld
from tests.imitation.cameras.test_ground import stairs


def wall_and_paving(seed: int, *, turn: float = 0.0) -> np.ndarray:
    """A near wall whose top is rich in points, seen from above; sparse paving 0.8 below and behind it."""
    random = np.random.default_rng(seed)
    top = np.c_[random.uniform(-2.5, 2.5, 600), random.uniform(1.8, 3.0, 600), np.full(600, 0.8)]
    paving = np.c_[random.uniform(-4, 4, 110), random.uniform(7, 14, 110), np.zeros(110)]
    hedge = np.c_[random.uniform(-4, 4, 150), random.uniform(14, 15, 150), random.uniform(0, 2, 150)]
    points = np.concatenate([top, paving, hedge]) + random.normal(size=(860, 3)) * 0.004
    across = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    return (points - [0, 3, 0]) @ across.T + [0, 3, 0]


@pytest.mark.parametrize("turn", [0.0, 0.15])
def test_a_wall_s_top_does_not_carry_a_foot_behind_it(turn: float) -> None:
    """Most points near the pixel lie on the wall; the foot stands lower, where its own points lie all round it."""
    cameras = handheld(3, travel=0.3)
    fooled = right = 0
    for seed in range(3):
        points = wall_and_paving(seed, turn=turn)
        for x in (-0.6, 0.0, 0.7):
            truth = np.array([x, 8.0, 0.0])
            pixel = cameras[1].project(truth)
            near = local_ground(points, cameras, 1, pixel).intersect(cameras[1], pixel)
            fooled += bool(near[2] > 0.4)
            found = standing_ground(points, cameras, 1, pixel)
            right += bool(np.linalg.norm(found.intersect(cameras[1], pixel) - truth) < 0.3)
    assert fooled >= 3
    assert right >= 8


def test_a_foot_on_the_wall_stays_on_it() -> None:
    """Points of the wall's top lie all round it: it is carried by the wall."""
    cameras, points = handheld(3, travel=0.3), wall_and_paving(1)
    for x, y in ((0.0, 2.3), (0.5, 2.6), (-0.8, 2.4)):
        truth = np.array([x, y, 0.8])
        pixel = cameras[1].project(truth)
        place = standing_ground(points, cameras, 1, pixel).intersect(cameras[1], pixel)
        assert np.linalg.norm(place - truth) < 0.05


def test_treads_are_found_as_before() -> None:
    """Feet on floor and treads take the step under them; the far ends of treads are as hard as for the local fit."""
    cameras = handheld(5, travel=0.5)
    misses = []
    for seed in range(4):
        points = stairs(seed)
        for x in (-1.2, 0.1, 1.0):
            for y, z in ((3.6, 0.0), (4.3, 0.0), (4.95, 0.3), (5.2, 0.3), (5.65, 0.6), (5.9, 0.6), (6.35, 0.9)):
                truth = np.array([x, y, z])
                pixel = cameras[2].project(truth)
                ground = standing_ground(points, cameras, 2, pixel)
                assert ground.name == local_ground(points, cameras, 2, pixel).name
                misses.append(np.linalg.norm(ground.intersect(cameras[2], pixel) - truth))
    assert np.median(misses) < 0.02
    assert (np.array(misses) < 0.1).mean() > 0.8


def test_without_points_there_is_no_ground() -> None:
    """Nothing near and nothing around: the local fit's sentence."""
    with pytest.raises(NoSolution, match="selected points"):
        standing_ground(np.array([[0, 5, 0.0]] * 3), handheld(3), 1, (240, 200))
