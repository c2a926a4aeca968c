"""Depth smoothing: eq. 12."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imitation.errors import InputError
from imitation.motion import smooth_depths


@settings(deadline=None, max_examples=40)
@given(
    count=st.integers(1, 25), keys=st.integers(1, 4), alpha=st.sampled_from([0.0, 0.1, 10.0]), seed=st.integers(0, 9999)
)
def test_equals_the_dense_minimum_of_equation_12(count: int, keys: int, alpha: float, seed: int) -> None:
    """The banded solution solves the normal equations of eq. 12."""
    depths = np.random.default_rng(seed).uniform(2, 5, (count, keys))
    first, second = np.diff(np.eye(count), axis=0), np.diff(np.eye(count), 2, axis=0)
    system = np.eye(count) + alpha * (first.T @ first + second.T @ second)
    np.testing.assert_allclose(smooth_depths(depths, alpha=alpha), np.linalg.solve(system, depths), rtol=1e-9)


@settings(deadline=None, max_examples=25)
@given(scale=st.floats(1e-3, 1e3), shift=st.floats(-10, 10), seed=st.integers(0, 9999))
def test_does_not_depend_on_the_unit(scale: float, shift: float, seed: int) -> None:
    """Eq. 12 is linear and keeps constants, so the unit of length does not matter."""
    depths = np.random.default_rng(seed).uniform(2, 5, (20, 3))
    moved = smooth_depths(scale * depths + shift, alpha=10)
    np.testing.assert_allclose(moved, scale * smooth_depths(depths, alpha=10) + shift, rtol=1e-8, atol=1e-8)


def test_clamped_depths_stay_and_draw_the_others() -> None:
    """Contacts and edited frames keep their depth to the bit."""
    depths = np.random.default_rng(0).uniform(2, 5, (30, 2))
    clamped = np.zeros((30, 2), bool)
    clamped[10:15, 0] = True
    smoothed = smooth_depths(depths, alpha=10, clamped=clamped)
    assert np.array_equal(smoothed[clamped], depths[clamped])
    assert not np.isclose(smoothed[~clamped], depths[~clamped]).any()


def test_unknown_depths_are_bridged() -> None:
    """A gap in a straight line is filled by that line, nearly."""
    depths = np.linspace(3, 4, 40)[:, None].copy()
    depths[15:20] = np.nan
    smoothed = smooth_depths(depths, alpha=0.0)
    np.testing.assert_allclose(smoothed[:, 0], np.linspace(3, 4, 40), atol=5e-3)


@pytest.mark.parametrize(
    ("depths", "alpha", "words"),
    [
        (np.zeros(5), 1.0, "need shape"),
        (np.zeros((5, 2)), -1.0, "must not be negative"),
        (np.full((5, 2), np.nan), 1.0, "no depth in any frame"),
    ],
)
def test_bad_depths_are_named(depths: np.ndarray, alpha: float, words: str) -> None:
    """Each bad input is one sentence that names it."""
    with pytest.raises(InputError, match=words):
        smooth_depths(depths, alpha=alpha)
