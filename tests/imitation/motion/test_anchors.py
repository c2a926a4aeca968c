"""Anchors: eq. 2-4."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion import anchor_depths


def looking_down_z(count: int) -> CameraPath:
    """Cameras at the origin that look along +z, so that the depth of a point is its z."""
    K = np.array([[900.0, 0, 480], [0, 900, 270], [0, 0, 1]])
    return CameraPath(K=np.tile(K, (count, 1, 1)), R=np.tile(np.eye(3), (count, 1, 1)), T=np.zeros((count, 3)))


def dense_solution(count: int, known: dict[int, float], beta: float) -> np.ndarray:
    """Eq. 4 written out with dense matrices."""
    first, second = np.diff(np.eye(count), axis=0), np.diff(np.eye(count), 2, axis=0)
    chosen = np.zeros((count, count))
    right = np.zeros(count)
    for frame, depth in known.items():
        chosen[frame, frame], right[frame] = 1, depth
    return np.linalg.solve(chosen + beta * (first.T @ first + second.T @ second), right)


@settings(deadline=None, max_examples=40)
@given(
    count=st.integers(1, 30),
    beta=st.sampled_from([1e-4, 1e-2, 1.0]),
    seed=st.integers(0, 10**6),
)
def test_closed_form_equals_the_dense_minimum_of_equation_4(count: int, beta: float, seed: int) -> None:
    """The banded solution is the minimum of eq. 4 for any set of contacts."""
    random = np.random.default_rng(seed)
    frames = random.choice(count, random.integers(1, count + 1), replace=False)
    known = {int(frame): float(random.uniform(2, 9)) for frame in frames}
    contacts = {frame: np.array([0.1, 0.2, depth]) for frame, depth in known.items()}
    solved = anchor_depths(np.zeros((count, 2)), looking_down_z(count), contacts, beta=beta)
    if count > 1:
        np.testing.assert_allclose(solved, dense_solution(count, known, beta), rtol=1e-7)


def test_small_beta_interpolates_the_contacts() -> None:
    """With the printed weight 1e-4 the contacts are met to a fraction of a thousandth."""
    contacts = {0: (0, 0, 4.0), 10: (0, 0, 5.0), 30: (0, 0, 4.5)}
    solved = anchor_depths(np.zeros((40, 2)), looking_down_z(40), contacts)
    assert np.abs(solved[[0, 10, 30]] - [4, 5, 4.5]).max() < 1e-3


def test_one_contact_gives_its_depth_everywhere() -> None:
    """Without a second contact nothing says that the depth changes."""
    solved = anchor_depths(np.zeros((25, 2)), looking_down_z(25), {7: (0, 0, 3.0)})
    np.testing.assert_allclose(solved, 3.0, rtol=1e-6)


def test_robust_loss_keeps_a_sudden_change_sudden() -> None:
    """A step between dense contacts is blurred by eq. 3 and kept by the robust form."""
    depth = np.where(np.arange(40) < 20, 4.0, 6.0) + 0.01 * np.sin(np.arange(40))
    contacts = {frame: (0, 0, depth[frame]) for frame in range(40)}
    errors = {
        loss: np.abs(anchor_depths(np.zeros((40, 2)), looking_down_z(40), contacts, beta=5.0, loss=loss) - depth).max()
        for loss in ("quadratic", "robust")
    }
    assert errors["robust"] < 0.3 * errors["quadratic"]


@pytest.mark.parametrize(
    ("contacts", "beta", "words"),
    [
        ({}, 1e-4, "at least one contact"),
        ({50: (0, 0, 1)}, 1e-4, "frame 50 is outside"),
        ({-1: (0, 0, 1)}, 1e-4, "frame -1 is outside"),
        ({3: (0, 0, -2)}, 1e-4, "behind the camera"),
        ({3: (0, np.nan, 2)}, 1e-4, "three finite numbers"),
        ({3: (0, 0, 2)}, 0.0, "beta must be positive"),
    ],
)
def test_bad_contacts_are_named(contacts: dict, beta: float, words: str) -> None:
    """Each bad input is one sentence that names it."""
    with pytest.raises(InputError, match=words):
        anchor_depths(np.zeros((20, 2)), looking_down_z(20), contacts, beta=beta)


def test_track_and_cameras_of_different_length() -> None:
    """The lengths are said."""
    with pytest.raises(InputError, match="19 frames but there are 20 cameras"):
        anchor_depths(np.zeros((19, 2)), looking_down_z(20), {0: (0, 0, 1)})
