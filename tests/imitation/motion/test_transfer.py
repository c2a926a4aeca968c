"""Track transfer: eq. 5-6, corrections and the clock of planted feet."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imitation.errors import InputError
from imitation.motion import transfer_track
from imitation.motion.transfer import correction_curve, swing_clock


def boundary_of(random: np.random.Generator, count: int, dimensions: int) -> dict[int, np.ndarray]:
    """One to six random boundary values."""
    frames = random.choice(count, random.integers(1, min(count, 6) + 1), replace=False)
    return {int(frame): random.normal(size=dimensions) for frame in frames}


@settings(deadline=None, max_examples=60)
@given(count=st.integers(1, 25), dimensions=st.integers(1, 3), seed=st.integers(0, 10**6))
def test_printed_form_is_the_least_squares_solution(count: int, dimensions: int, seed: int) -> None:
    """The closed form equals eq. 5 in the least-squares sense under the exact conditions of eq. 6."""
    random = np.random.default_rng(seed)
    source = random.normal(size=(count, dimensions))
    boundary = boundary_of(random, count, dimensions)
    free = [frame for frame in range(count) if frame not in boundary]
    fixed = sorted(boundary)
    difference = np.diff(np.eye(count), axis=0)
    expected = np.empty_like(source)
    expected[fixed] = [boundary[frame] for frame in fixed]
    if free:
        right = difference @ source - difference[:, fixed] @ expected[fixed]
        expected[free] = np.linalg.lstsq(difference[:, free], right, rcond=None)[0]
    np.testing.assert_allclose(transfer_track(source, boundary), expected, atol=1e-9)


@settings(deadline=None, max_examples=60)
@given(count=st.integers(2, 40), smooth=st.booleans(), seed=st.integers(0, 10**6))
def test_boundary_values_are_met_to_the_bit(count: int, smooth: bool, seed: int) -> None:
    """Eq. 6 holds exactly, and a target that starts where the source does keeps the source's track."""
    random = np.random.default_rng(seed)
    source = random.normal(size=(count, 3))
    boundary = boundary_of(random, count, 3)
    track = transfer_track(source, boundary, smooth=smooth)
    for frame, place in boundary.items():
        assert np.array_equal(track[frame], place)
    assert np.array_equal(transfer_track(source, {0: source[0]}, smooth=smooth), source)


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 10**6), smooth=st.booleans())
def test_a_boundary_value_reaches_its_neighbours_and_no_further(seed: int, smooth: bool) -> None:
    """Changing one of five boundary values leaves frames beyond the neighbouring ones bit-identical."""
    random = np.random.default_rng(seed)
    source = random.normal(size=(60, 3))
    frames = [0, 12, 25, 40, 55]
    boundary = {frame: random.normal(size=3) for frame in frames}
    before = transfer_track(source, boundary, smooth=smooth)
    after = transfer_track(source, boundary | {25: random.normal(size=3)}, smooth=smooth)
    same = (before == after).all(axis=1)
    assert same[:13].all()
    assert same[40:].all()
    assert not same[13:40].any()


def test_smooth_correction_has_no_velocity_jump_and_no_overshoot() -> None:
    """One correction of 10 between zeros: linear jumps in velocity, the cubic does not and stays within 0..10."""
    frames, values = [0, 20, 40], np.array([[0.0], [10.0], [0.0]])
    linear = correction_curve(41, frames, values, smooth=False)[:, 0]
    cubic = correction_curve(41, frames, values, smooth=True)[:, 0]
    assert np.abs(np.diff(linear, 2)).max() == pytest.approx(1.0)
    assert np.abs(np.diff(cubic, 2)).max() < 0.16
    assert cubic.min() >= 0
    assert cubic.max() <= 10
    assert (np.diff(cubic[:21]) >= 0).all()


def test_correction_is_held_outside_the_edited_frames() -> None:
    """Before the first and after the last boundary value only the offset is added (eq. 5)."""
    source = np.random.default_rng(3).normal(size=(30, 2))
    track = transfer_track(source, {10: source[10] + 1, 20: source[20] + 2}, smooth=True)
    np.testing.assert_allclose(track[:10], source[:10] + 1)
    np.testing.assert_allclose(track[21:], source[21:] + 2)


def test_correction_stands_still_while_a_foot_is_planted() -> None:
    """The clock runs only in swing, so the correction is constant in a contact and an edit in it moves all of it."""
    planted = np.zeros(60, bool)
    planted[10:25] = planted[40:50] = True
    curve = correction_curve(60, [0, 18, 59], np.array([[0.0], [1.0], [3.0]]), clock=swing_clock(planted))[:, 0]
    assert np.ptp(curve[10:25]) == 0
    assert curve[10] == 1
    assert np.ptp(curve[40:50]) == 0
    assert 1 < curve[45] < 3


def test_two_edits_in_one_contact_are_both_met() -> None:
    """A contact with two different corrections has to move; it does so over the frames between."""
    curve = correction_curve(30, [0, 12, 20], np.array([[0.0], [1.0], [2.0]]), clock=swing_clock(np.ones(30, bool)))
    assert curve[12, 0] == 1
    assert curve[20, 0] == 2
    assert np.isfinite(curve).all()


def test_gaps_stay_gaps() -> None:
    """A frame without source has no target either."""
    source = np.ones((10, 2))
    source[4:6] = np.nan
    track = transfer_track(source, {0: (0.0, 0.0), 9: (0.0, 0.0)})
    assert np.isnan(track[4:6]).all()
    assert np.isfinite(np.delete(track, [4, 5], axis=0)).all()


@pytest.mark.parametrize(
    ("boundary", "words"),
    [
        ({}, "with a boundary value"),
        ({12: (0, 0)}, "frame 12 is outside"),
        ({3: (0, 0, 0)}, "frame 3 needs 2 finite"),
        ({3: (0, np.inf)}, "frame 3 needs 2 finite"),
        ({5: (0, 0)}, "absent in edited frame 5"),
    ],
)
def test_bad_boundary_values_are_named(boundary: dict, words: str) -> None:
    """Each bad boundary value is one sentence that names it."""
    source = np.zeros((10, 2))
    source[5] = np.nan
    with pytest.raises(InputError, match=words):
        transfer_track(source, boundary)
