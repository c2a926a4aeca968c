"""Bad input gets one sentence."""

from typing import Any

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.errors import InputError
from imitation.geometry import prepare_mesh
from tests.imitation.deformation.shapes import ball
from tests.imitation.deformation.test_energy import camera_before

BALL = ball(2)
CAMERA = camera_before(BALL[0], 6)


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        (np.where(np.arange(162)[:, None] == 7, np.nan, BALL[0]), BALL[1], "first is vertex 7"),
        (BALL[0], np.zeros((0, 3), int), "no triangles"),
        (BALL[0], BALL[1] + 1, "does not exist"),
        (BALL[0], BALL[1].astype(float), "whole numbers"),
        (np.zeros((5, 3)), np.array([[0, 1, 2]]), "one place"),
        (np.eye(3), np.array([[0, 1, 1]]), "no surface"),
        (BALL[0][:, :2], BALL[1], "shape"),
    ],
)
def test_meshes_that_cannot_be_used(vertices: Any, faces: Any, words: str) -> None:
    """Each broken mesh is named in one sentence."""
    with pytest.raises(InputError, match=words) as caught:
        prepare_mesh(vertices, faces)
    assert str(caught.value).count(". ") == 0


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (FrameConstraints({500: [0, 0, 0]}), "vertex 500"),
        (FrameConstraints({-1: [0, 0, 0]}), "vertex -1"),
        (FrameConstraints({3: [0, np.nan, 0]}), "finite"),
        (FrameConstraints({3: [0, 0]}), "3 finite numbers"),
        (FrameConstraints({}, {3: [1, 1]}), "without a camera"),
        (FrameConstraints({}, {3: [1, np.inf]}, CAMERA), "finite"),
        (FrameConstraints({3: [0, 0, 0]}, softness={3: 0.0}), "softness"),
        (FrameConstraints({}, {3: [1, 1]}, CAMERA, {4: 1.0}), "no ray"),
        (FrameConstraints({}, {3: [1, 1]}, CAMERA, {3: -1.0}), "in front of the camera"),
    ],
)
def test_constraints_that_cannot_be_used(asked: FrameConstraints, words: str) -> None:
    """Each wrong constraint is named in one sentence."""
    with pytest.raises(InputError, match=words):
        Deformer(*BALL).solve_pose(asked)


def test_two_targets_for_one_place() -> None:
    """Two vertices that are one at rest cannot be held in two places, but may share one."""
    vertices, faces = BALL
    soup = vertices[faces].reshape(-1, 3)
    deformer = Deformer(soup, np.arange(len(soup)).reshape(-1, 3))
    twin = next(int(k) for k in range(1, len(soup)) if np.array_equal(soup[k], soup[0]))
    with pytest.raises(InputError, match="different targets"):
        deformer.solve({0: soup[0], twin: soup[0] + 1})
    posed = deformer.solve({0: soup[0] + 1, twin: soup[0] + 1})
    np.testing.assert_allclose(posed, soup + 1, atol=1e-9)


@pytest.mark.parametrize("count", [1, 2])
def test_too_few_points_keep_the_turn_and_say_so(count: int) -> None:
    """One or two points move the body; what they leave open is in the report."""
    vertices, faces = BALL
    pose = Deformer(vertices, faces).solve_pose(FrameConstraints({v: vertices[v] + 1 for v in range(count)}))
    np.testing.assert_allclose(pose.vertices, vertices + 1, atol=1e-9)
    assert any("open" in warning for warning in pose.warnings)


def test_collinear_points_say_so() -> None:
    """Three points on one line leave the turn about it open."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0.2], [2, 1, 0]])
    faces = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    pose = Deformer(vertices, faces).solve_pose(FrameConstraints({v: vertices[v] for v in range(3)}))
    np.testing.assert_allclose(pose.vertices, vertices, atol=1e-9)
    assert any("open" in warning for warning in pose.warnings)


def test_open_meshes_have_no_volume_to_keep() -> None:
    """Asking for the volume of a mesh with a hole is an error."""
    with pytest.raises(InputError, match="closed mesh"):
        Deformer(BALL[0], BALL[1][1:], keep_volume=True)


def test_wrong_options() -> None:
    """Unknown methods, negative weights, stiffness of the wrong size, and starts of another mesh are refused."""
    options: list[dict[str, Any]] = [{"method": "arap"}, {"stretch_weight": -1}, {"stiffness": [1, 2]}]
    for option in options:
        with pytest.raises(InputError):
            Deformer(*BALL, **option)
    with pytest.raises(InputError, match="start pose"):
        Deformer(*BALL).solve({0: [0, 0, 0]}, start=np.zeros((3, 3)))
