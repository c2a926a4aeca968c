"""The character on the subject in the first frame."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from imitation.errors import InputError
from imitation.geometry import Camera
from imitation.motion import align_character
from imitation.motion.alignment import Similarity

CAMERA = Camera(
    K=[[900, 0, 480], [0, 900, 270], [0, 0, 1]],
    R=[[1, 0, 0], [0, -0.2588190451, -0.9659258263], [0, 0.9659258263, -0.2588190451]],
    T=[0.1, 1.2, 4.0],
)
BODY = np.random.default_rng(0).uniform([-0.5, -0.2, 0.0], [0.5, 0.2, 0.7], (60, 3))
BODY[:4] = [[-0.4, -0.2, 0], [-0.4, 0.2, 0], [0.4, -0.2, 0], [0.4, 0.2, 0]]
PAIRS = {f"track {vertex}": vertex for vertex in (0, 1, 2, 3, 10, 20, 30, 40)}


def placed(scale: float, turn: float, shift: np.ndarray) -> np.ndarray:
    """The body as the camera films it: scaled, turned about the vertical, shifted along the ground z = 0."""
    return scale * Rotation.from_rotvec([0, 0, turn]).apply(BODY) + shift


@settings(deadline=None, max_examples=15)
@given(scale=st.floats(0.5, 2.0), turn=st.floats(-3.1, 3.1), x=st.floats(-0.4, 0.4), y=st.floats(-0.3, 0.8))
def test_truth_is_found_from_pixels_and_ground(scale: float, turn: float, x: float, y: float) -> None:
    """Eight pixels and the ground it stands on give scale, heading and place."""
    truth = placed(scale, turn, np.array([x, y, 0.0]))
    pixels = {name: CAMERA.project(truth[vertex]) for name, vertex in PAIRS.items()}
    found = align_character(BODY, PAIRS, CAMERA, pixels, ground=((0.0, 0.0, 1.0), 0.0))
    np.testing.assert_allclose(found.apply(BODY), truth, atol=1e-4)
    assert max(found.residuals.values()) < 1e-2


def test_contacts_give_the_size_without_a_ground() -> None:
    """Two planted feet with known places stand for the ground; the rotation is free."""
    truth = placed(1.3, 0.7, np.array([0.2, 0.3, 0.0]))
    pixels = {name: CAMERA.project(truth[vertex]) for name, vertex in PAIRS.items()}
    places = {"track 0": truth[0], "track 3": truth[3]}
    found = align_character(BODY, PAIRS, CAMERA, pixels, places)
    np.testing.assert_allclose(found.apply(BODY), truth, atol=1e-4)


def test_a_depth_stands_in_for_both() -> None:
    """Where only a depth is known the size follows from it."""
    truth = placed(1.0, 0.4, np.array([0.0, 0.0, 0.0]))
    pixels = {name: CAMERA.project(truth[vertex]) for name, vertex in PAIRS.items()}
    depth = float(CAMERA.depth(truth[list(PAIRS.values())].mean(axis=0)))
    found = align_character(BODY, PAIRS, CAMERA, pixels, depth=depth)
    np.testing.assert_allclose(found.apply(BODY), truth, atol=2e-3)


def test_manual_values_come_on_top() -> None:
    """Turning and scaling about a point keeps it, and the shift moves it."""
    base = Similarity(2.0, Rotation.from_rotvec([0, 0, 1]).as_matrix(), np.array([1.0, 2, 3]))
    about = base.apply(BODY[7])
    turn = Rotation.from_rotvec([0, 0, 0.5]).as_matrix()
    moved = base.then(1.5, turn, (0.0, 0.0, 0.25), about=about)
    np.testing.assert_allclose(moved.apply(BODY[7]), about + np.array([0, 0, 0.25]), atol=1e-12)
    np.testing.assert_allclose(moved.apply(BODY), 1.5 * (base.apply(BODY) - about) @ turn.T + about + [0, 0, 0.25])


@pytest.mark.parametrize(
    ("pairs", "options", "words"),
    [
        ({"track 0": 0, "track 1": 1}, {"depth": 3.0}, "at least three pairs"),
        (PAIRS | {"track 0": 99}, {"depth": 3.0}, "vertex 99, but the character has 60"),
        (PAIRS, {}, "size open"),
    ],
)
def test_bad_alignments_are_named(pairs: dict, options: dict, words: str) -> None:
    """Each bad input is one sentence that names it."""
    pixels = dict.fromkeys(pairs, (480.0, 270.0))
    with pytest.raises(InputError, match=words):
        align_character(BODY, pairs, CAMERA, pixels, **options)
