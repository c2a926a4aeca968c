"""Rays: the picture is met, depth follows from what is known, and turns up to half a circle are found."""

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.geometry import Camera, axis_rotation
from tests.imitation.deformation.shapes import ball, farthest
from tests.imitation.deformation.test_energy import camera_before

BALL = ball()


def pixels(camera: Camera, vertices: np.ndarray, handles: list[int]) -> dict[int, np.ndarray]:
    """Where the handles are seen."""
    return {v: camera.project(vertices[v]) for v in handles}


def test_rays_of_the_rest_pose_leave_it_alone() -> None:
    """The rest pose seen at its own pixels stays."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    posed = Deformer(vertices, faces).solve({}, pixels(camera, vertices, farthest(vertices, 12)), camera)
    assert np.abs(posed - vertices).max() <= 1e-6


@pytest.mark.parametrize("degrees", [60, 120, 175])
def test_a_turned_body_is_found_from_rays_alone(degrees: float) -> None:
    """Without any earlier pose the turn about the vertical is found from several starts."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    middle = vertices.mean(axis=0)
    moved = (vertices - middle) @ axis_rotation([0, 0, 1], np.radians(degrees)).T + middle
    posed = Deformer(vertices, faces).solve({}, pixels(camera, moved, farthest(vertices, 16)), camera)
    assert np.abs(posed - moved).max() <= 1e-3


def test_rays_are_met_in_the_picture() -> None:
    """Handles on rays are seen within a twentieth of a pixel of where they were asked to be."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    handles = farthest(vertices, 10)
    bumped = vertices + 0.05 * np.sin(4 * vertices[:, [2, 0, 1]])
    posed = Deformer(vertices, faces).solve(
        {handles[0]: bumped[handles[0]]}, pixels(camera, bumped, handles[1:]), camera
    )
    assert np.abs(camera.project(posed[handles[1:]]) - camera.project(bumped[handles[1:]])).max() < 0.5
    assert np.abs(posed - bumped).mean() < 0.05


def test_depths_pull_weakly_along_the_ray() -> None:
    """A depth moves the body along the view and hardly in the picture."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    handles = farthest(vertices, 6)
    rays = pixels(camera, vertices, handles)
    deformer = Deformer(vertices, faces)
    asked = {v: float(camera.depth(vertices[v])) + 0.5 for v in handles}
    firm = FrameConstraints({}, rays, camera, asked, depth_softness=0.9)
    loose = FrameConstraints({}, rays, camera, asked, depth_softness=0.001)
    near, far = (float(camera.depth(deformer.solve_pose(c).vertices[handles]).mean()) for c in (loose, firm))
    base = float(camera.depth(vertices[handles]).mean())
    assert base - 1e-6 <= near < far <= base + 0.5


def test_a_lone_ray_moves_the_body_without_turning_it() -> None:
    """One ray: the body keeps its distance and turn, and the report says what is open."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    vertex = farthest(vertices, 1)[0]
    pose = Deformer(vertices, faces).solve_pose(
        FrameConstraints({}, {vertex: camera.project(vertices[vertex]) + np.array([40, 0])}, camera)
    )
    shift = pose.vertices - vertices
    assert np.abs(shift - shift.mean(axis=0)).max() <= 1e-9
    assert 0.1 < np.linalg.norm(shift[0]) < 0.3
    assert any("parallel" in warning for warning in pose.warnings)


def test_a_body_behind_the_camera_is_named() -> None:
    """A start behind the camera is not passed over in silence."""
    vertices, faces = BALL
    camera = camera_before(vertices, 6)
    handles = farthest(vertices, 8)
    away = vertices - [0, 12, 0]
    pose = Deformer(vertices, faces).solve_pose(
        FrameConstraints({}, pixels(camera, vertices, handles), camera), start=away, iterations=2
    )
    behind = camera.depth(pose.vertices[handles]).min() <= 0
    assert behind == any("behind the camera" in warning for warning in pose.warnings)
