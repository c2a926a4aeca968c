"""Rotations: inverses, best fits, degenerate sets."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from imitation.geometry import (
    axis_rotation,
    kabsch,
    nearest_rotation,
    quaternion_matrix,
    quaternion_of,
    quaternion_product,
    rotation_of,
)

vectors = st.lists(st.floats(-3, 3), min_size=3, max_size=3).map(np.array)


@settings(deadline=None)
@given(vectors, vectors)
def test_quaternions_multiply_like_matrices(first: np.ndarray, second: np.ndarray) -> None:
    """There and back, and the product of two."""
    a, b = rotation_of(first), rotation_of(second)
    np.testing.assert_allclose(quaternion_matrix(quaternion_of(a)), a, atol=1e-12)
    product = quaternion_product(quaternion_of(a), quaternion_of(b))
    np.testing.assert_allclose(quaternion_matrix(product), a @ b, atol=1e-12)
    assert np.linalg.det(a) > 0.999


@settings(deadline=None)
@given(vectors, vectors, st.integers(0, 99))
def test_kabsch_undoes_a_rigid_motion(turn: np.ndarray, shift: np.ndarray, seed: int) -> None:
    """Points moved rigidly are taken back onto each other exactly."""
    points = np.random.default_rng(seed).normal(size=(5, 3))
    moved = points @ rotation_of(turn).T + shift
    rotation, translation = kabsch(points, moved)
    np.testing.assert_allclose(rotation, rotation_of(turn), atol=1e-9)
    np.testing.assert_allclose(points @ rotation.T + translation, moved, atol=1e-9)


def test_points_on_a_line_do_not_turn_about_it() -> None:
    """Two points leave the turn about their line at zero; one leaves every turn at zero."""
    line = np.array([[0.0, 0, 0], [2, 0, 0]])
    rotation, _ = kabsch(line, line @ axis_rotation([0, 0, 1], 0.4).T)
    np.testing.assert_allclose(rotation, axis_rotation([0, 0, 1], 0.4), atol=1e-5)
    np.testing.assert_allclose(kabsch(line[:1], line[:1] + 1)[0], np.eye(3), atol=1e-12)
    np.testing.assert_array_equal(nearest_rotation(np.zeros((3, 3))), np.eye(3))


def test_a_mirrored_set_gives_a_rotation() -> None:
    """The best fit is never a reflection."""
    points = np.random.default_rng(0).normal(size=(9, 3))
    rotation, _ = kabsch(points, points * [1, 1, -1])
    assert np.linalg.det(rotation) > 0.999
