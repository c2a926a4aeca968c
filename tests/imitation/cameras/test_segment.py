"""The ends of a thing of known length, seen in one picture."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation.cameras import Plane
from imitation.cameras.segment import seen_segment
from imitation.errors import InputError, NoSolution
from tests.imitation.cameras.scenes import handheld

FLOOR = Plane(np.array([0.0, 0, 1]), 0.0)


def scene(*, post: bool) -> tuple:
    """Floor, a wall behind, and a leaning bar before it with points along it or without."""
    random = np.random.default_rng(2)
    floor = np.c_[random.uniform(-3, 3, 200), random.uniform(2, 8, 200), np.zeros(200)]
    wall = np.c_[random.uniform(-3, 3, 200), np.full(200, 8.0), random.uniform(0, 3, 200)]
    ends = np.array([[-0.5, 4.0, 0.2], [0.5, 5.0, 1.0]])
    bar = ends[0] + random.uniform(0, 1, (12, 1)) * (ends[1] - ends[0]) + random.normal(size=(12, 3)) * 0.004
    cameras = handheld(3, travel=0.4)
    return attrs.evolve(cameras, points=np.concatenate([floor, wall, bar] if post else [floor, wall])), ends


def test_a_bar_is_measured_along_its_points() -> None:
    """A bar that leans away from the camera, before a wall: within two percent."""
    cameras, ends = scene(post=True)
    first, second, how = seen_segment(cameras, 1, *cameras[1].project(ends), plane=FLOOR)
    assert "recovered points" in how
    assert np.linalg.norm(second - first) == pytest.approx(np.linalg.norm(ends[1] - ends[0]), rel=0.02)
    assert np.abs(cameras[1].project(np.stack([first, second])) - cameras[1].project(ends)).max() < 1e-6


@pytest.mark.parametrize("flip", [False, True])
def test_a_post_without_points_stands_on_the_ground(flip: bool) -> None:
    """Upright in the picture: from its foot on the floor, whichever end is named first."""
    cameras, _ = scene(post=False)
    post = np.array([[0.4, 4.5, 0.0], [0.4, 4.5, 0.9]])[:: -1 if flip else 1]
    first, second, how = seen_segment(cameras, 1, *cameras[1].project(post), plane=FLOOR)
    if "recovered" not in how:
        assert how == "upright on the ground"
        np.testing.assert_allclose([first, second], post, atol=0.03)


def test_marks_on_the_floor_and_nothing_at_all() -> None:
    """Two marks on the floor; a depth where there is no ground; a sentence where there is nothing."""
    cameras, _ = scene(post=False)
    bare = attrs.evolve(cameras, points=np.zeros((0, 3)))
    marks = np.array([[-0.6, 4.5, 0.0], [0.9, 5.0, 0.0]])
    pixels = cameras[1].project(marks)
    first, second, how = seen_segment(bare, 1, *pixels, plane=FLOOR)
    assert how == "on the ground"
    np.testing.assert_allclose([first, second], marks, atol=1e-9)
    first, second, how = seen_segment(bare, 1, *pixels, depth=2.0)
    np.testing.assert_allclose(cameras[1].depth(np.stack([first, second])), 2.0)
    with pytest.raises(NoSolution, match="track two points"):
        seen_segment(bare, 1, *pixels)
    with pytest.raises(InputError, match="same place"):
        seen_segment(bare, 1, pixels[0], pixels[0])
