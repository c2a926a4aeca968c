"""The lag between two sides of a body."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.motion.stride import agreed_lags, measured_lag

FRAMES = 60
ALL = np.ones(FRAMES, bool)


def swing(lag: float, *, offset: float = 0.0, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    """A foot's path in the body's frame, in a cycle of 30 frames, later by a lag."""
    phase = 2 * np.pi * (np.arange(FRAMES) - lag) / 30
    path = np.stack([np.cos(phase), 0 * phase, np.maximum(np.sin(phase), 0)], axis=1)
    return path + offset + noise * np.random.default_rng(seed).normal(size=path.shape)


@pytest.mark.parametrize("lag", [-9, 0, 4, 15])
def test_a_lag_is_measured(lag: int) -> None:
    """With noise, another rest place and half of the frames hidden the lag comes out, up to a whole cycle."""
    seen = ALL.copy()
    seen[20:40] = False
    found = measured_lag(swing(lag, offset=0.3, noise=0.05), swing(0, noise=0.05, seed=1), seen, ALL)
    assert found is not None
    assert min((found - lag) % 30, (lag - found) % 30) <= 1


def test_what_cannot_be_measured_is_none() -> None:
    """Too few frames of both, a limb that does not move, two motions that have nothing in common."""
    few = np.arange(FRAMES) < 6
    assert measured_lag(swing(5), swing(0), few, ALL) is None
    assert measured_lag(np.zeros((FRAMES, 3)), np.zeros((FRAMES, 3)), ALL, ALL) is None
    other = np.random.default_rng(2).normal(size=(FRAMES, 3)).cumsum(axis=0)
    assert measured_lag(swing(5), other, ALL, ALL) is None


def test_a_limb_never_seen_shares_the_gait_of_the_others() -> None:
    """Given before measured before the others'; without any of these the mirror's own time, as the paper has it."""
    given = {"fore": None, "knee": None, "hind": None, "ear": 0}
    assert agreed_lags(given, {"hind": 14, "knee": 16}) == {"fore": 15, "knee": 16, "hind": 14, "ear": 0}
    assert agreed_lags({"fore": None}, {}) == {"fore": 0}
    assert agreed_lags({"fore": -3}, {"fore": 15}) == {"fore": -3}
    assert agreed_lags({"fore": None, "hind": None}, {"hind": 0}) == {"fore": 0, "hind": 0}
