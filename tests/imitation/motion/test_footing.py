"""Feet below the ground of their contacts are lifted onto it, softly, and nothing else is touched."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import InputError
from imitation.motion import lifted_feet

FRAMES = 40


def walker() -> tuple[np.ndarray, np.ndarray]:
    """Two legs of points, 1 high and .5 apart, at rest; and their motion: the left foot sinks by .04 in 10 to 20."""
    heights = np.linspace(0, 1, 41)
    left = np.stack([np.zeros(41), np.zeros(41), heights], axis=1)
    toes = np.array([[0.03, 0, 0.0], [0.05, 0, 0.0]])
    rest = np.concatenate([left, toes, left + np.array([0.5, 0, 0])])
    motion = np.tile(rest, (FRAMES, 1, 1))
    motion[10:21, :, 2] -= 0.04
    return rest, motion


def test_a_sunken_foot_stands_on_its_contact() -> None:
    """Not below it in any frame of the contact; the other leg and the hip are bit for bit as they were."""
    rest, motion = walker()
    contacts = {0: [(8, 22, (0.0, 0.0, 0.0))]}
    made = lifted_feet(motion, rest, contacts)
    foot = np.r_[0:3, 41:43]
    assert made[8:23][:, foot, 2].min() > -1e-12
    np.testing.assert_array_equal(made[:, 43:], motion[:, 43:])
    np.testing.assert_array_equal(made[:, 20:41], motion[:, 20:41])
    np.testing.assert_array_equal(made[..., :2], motion[..., :2])
    np.testing.assert_array_equal(made[30:], motion[30:])


def test_the_lift_sets_in_softly() -> None:
    """A foot that sinks evenly and comes up again is lifted without a jerk in time, and less up the leg."""
    rest, motion = walker()
    motion[:, :, 2] = rest[:, 2] - 0.05 * np.sin(np.linspace(0, np.pi, FRAMES))[:, None]
    lift = (lifted_feet(motion, rest, {0: [(0, FRAMES - 1, (0, 0, 0))]}) - motion)[..., 2]
    assert np.abs(np.diff(lift[:, 0], 2)).max() < 0.004
    along = lift[20, :41]
    assert (np.diff(along) <= 1e-12).all()
    assert along[0] > 0.045
    assert along[8] == 0


def test_what_is_above_its_level_stays() -> None:
    """Feet that hover, and a foot without contacts, are not pulled down nor lifted."""
    rest, motion = walker()
    above = motion + np.array([0, 0, 0.2])
    np.testing.assert_array_equal(lifted_feet(above, rest, {0: [(8, 22, (0, 0, 0))]}), above)
    np.testing.assert_array_equal(lifted_feet(motion, rest, {}), motion)
    np.testing.assert_array_equal(lifted_feet(motion, rest, {0: []}), motion)


def test_a_swing_between_two_steps_counts_from_the_lower() -> None:
    """From a step to one higher: the foot may still be as low as the first until it stands on the second."""
    rest, motion = walker()
    motion = np.tile(rest, (FRAMES, 1, 1))
    contacts = {0: [(0, 10, (0, 0, 0.0)), (25, 39, (0, 0, 0.2))]}
    motion[25:, :, 2] += 0.2
    made = lifted_feet(motion, rest, contacts)
    np.testing.assert_array_equal(made, motion)
    motion[14:20, :41, 2] -= 0.03
    assert lifted_feet(motion, rest, contacts)[14:20, 0, 2].min() > -1e-12


def test_bad_contacts_are_refused() -> None:
    """A vertex that is not there, frames outside the motion, a mesh of another size: one sentence."""
    rest, motion = walker()
    with pytest.raises(InputError, match="no vertex 999"):
        lifted_feet(motion, rest, {999: [(0, 1, (0, 0, 0))]})
    with pytest.raises(InputError, match="outside 40 frames"):
        lifted_feet(motion, rest, {0: [(30, 40, (0, 0, 0))]})
    with pytest.raises(InputError, match="do not belong together"):
        lifted_feet(motion, rest[:5], {})
