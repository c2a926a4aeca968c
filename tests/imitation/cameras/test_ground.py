"""Planes, grounds and worlds against exact truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from imitation.cameras import (
    CameraPath,
    constant_depth,
    constant_depth_track,
    fit_plane,
    local_ground,
    plane_ground,
    world_from_ground,
)
from imitation.errors import InputError, NoSolution
from tests.imitation.cameras.scenes import handheld

numbers = st.floats(-2, 2, allow_nan=False)


def stairs(seed: int, noise: float = 0.004) -> np.ndarray:
    """Points on the floor, three treads and risers, and a wall, with noise and a tenth of outliers."""
    random = np.random.default_rng(seed)
    parts = [np.c_[random.uniform(-3, 3, 300), random.uniform(2, 4.6, 300), np.zeros(300)]]
    for step in range(3):
        y, z = 4.6 + 0.7 * step, 0.3 + 0.3 * step
        parts.append(np.c_[random.uniform(-3, 3, 90), random.uniform(y, y + 0.7, 90), np.full(90, z)])
        parts.append(np.c_[random.uniform(-3, 3, 60), np.full(60, y), random.uniform(z - 0.3, z, 60)])
    parts.append(np.c_[random.uniform(-4, 4, 200), np.full(200, 7.0), random.uniform(0.9, 4, 200)])
    points = np.concatenate(parts)
    points += random.normal(size=points.shape) * noise
    wrong = random.random(len(points)) < 0.05
    points[wrong] += random.normal(size=(wrong.sum(), 3)) * 0.4
    return points


@settings(deadline=None, max_examples=60)
@given(numbers, numbers, numbers, numbers, st.integers(0, 1000))
def test_plane_through_its_own_points_is_exact(a: float, b: float, c: float, offset: float, seed: int) -> None:
    """Points on a plane give that plane to rounding, whatever its direction."""
    normal = np.array([a, b, c])
    if np.linalg.norm(normal) < 0.1:
        normal = np.array([0, 0, 1.0])
    normal /= np.linalg.norm(normal)
    random = np.random.default_rng(seed)
    points = random.normal(size=(30, 3))
    points -= np.outer(points @ normal - offset, normal)
    plane = fit_plane(points)
    assert abs(plane.normal @ normal) == pytest.approx(1, abs=1e-9)
    assert np.abs(plane.height(points)).max() < 1e-8


def test_plane_leaves_out_what_does_not_lie_on_it() -> None:
    """A third of the points lies elsewhere; the plane is still found to the noise, twice with the same bits."""
    random = np.random.default_rng(3)
    points = np.c_[random.uniform(-2, 2, (400, 2)), random.normal(size=400) * 0.005]
    points[:130, 2] = random.uniform(0.1, 2, 130)
    first, second = fit_plane(points, up=(0, 0, 1)), fit_plane(points, up=(0, 0, 1))
    assert np.degrees(np.arccos(min(1, first.normal[2]))) < 0.1
    assert abs(first.offset) < 0.003
    assert not first.used[:130].any()
    assert first.normal.tobytes() == second.normal.tobytes()
    assert first.offset == second.offset


def test_expected_up_prefers_the_floor_to_a_larger_wall() -> None:
    """With ``up`` the floor is taken although most points lie on the wall."""
    random = np.random.default_rng(4)
    wall = np.c_[random.uniform(-3, 3, 500), np.full(500, 6.0), random.uniform(0, 4, 500)]
    floor = np.c_[random.uniform(-3, 3, 150), random.uniform(2, 6, 150), np.zeros(150)]
    plane = fit_plane(np.concatenate([wall, floor]), up=(0.1, -0.1, 1))
    assert plane.normal == pytest.approx([0, 0, 1], abs=1e-6)


@pytest.mark.parametrize(
    "points", [np.zeros((2, 3)), np.full((5, 3), np.nan), np.zeros((5, 2))], ids=["two", "nan", "flat array"]
)
def test_bad_points_are_refused(points: np.ndarray) -> None:
    """Too few, not finite and wrongly shaped points each get one sentence."""
    with pytest.raises(InputError):
        fit_plane(points)


def test_points_on_a_line_fix_no_plane() -> None:
    """Points on a line are sound input without an answer."""
    with pytest.raises(NoSolution, match="line"):
        fit_plane(np.outer(np.linspace(0, 1, 20), (1, 2, 3)))


def test_a_contact_takes_the_step_under_it() -> None:
    """Feet on floor, treads of every height: found within centimetres along the ray; named, with residual."""
    cameras = handheld(5, travel=0.5)
    misses = []
    for seed in range(4):
        points = stairs(seed)
        for x in (-1.2, 0.1, 1.0):
            for y, z in ((3.6, 0.0), (4.3, 0.0), (4.95, 0.3), (5.65, 0.6), (6.35, 0.9)):
                truth = np.array([x, y, z])
                ground = local_ground(points, cameras, 2, cameras[2].project(truth))
                misses.append(np.linalg.norm(ground.intersect(cameras[2], cameras[2].project(truth)) - truth))
                assert "local fit" in ground.name
                assert ground.residual < 0.06
    misses = np.array(misses)
    # A pixel seen at a grazing angle turns a millimetre of height into centimetres along the ray.
    assert np.median(misses) < 0.02
    assert (misses < 0.1).mean() > 0.95


def test_a_contact_far_from_points_has_no_ground() -> None:
    """Where nothing was recovered the local fit says so and names the way out."""
    cameras = handheld(3)
    with pytest.raises(NoSolution, match="selected points"):
        local_ground(np.array([[0, 5, 0.0]] * 3), cameras, 1, (240, 200))


def test_selected_points_give_the_table() -> None:
    """A plane through selected points is met where the truth is, and is named."""
    cameras = handheld(3)
    random = np.random.default_rng(0)
    table = np.c_[random.uniform(-1, 1, 20), random.uniform(4, 6, 20), np.full(20, 0.7)]
    ground = plane_ground(table)
    truth = np.array([0.2, 4.5, 0.7])
    assert ground.intersect(cameras[1], cameras[1].project(truth)) == pytest.approx(truth, abs=1e-9)
    assert ground.name == "plane through 20 of 20 selected points"
    sky = cameras[1].project(np.array([0, 50.0, 40.0]))
    with pytest.raises(NoSolution, match="does not meet"):
        ground.intersect(cameras[1], sky)


def test_constant_depth_keeps_the_depth_and_the_pixel() -> None:
    """The salamander's back: every frame's place has the depth and projects on the track; absent frames stay NaN."""
    cameras = handheld(6)
    track = np.random.default_rng(1).uniform(50, 200, (6, 2))
    track[3] = np.nan
    places = constant_depth_track(track, cameras, 2.5)
    for t in (0, 1, 2, 4, 5):
        assert cameras[t].depth(places[t]) == pytest.approx(2.5)
        assert cameras[t].project(places[t]) == pytest.approx(track[t])
    assert np.isnan(places[3]).all()
    assert constant_depth(2.5).name == "constant depth 2.5"
    with pytest.raises(InputError):
        constant_depth(-1.0)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.05, 20))
def test_world_is_recovered_from_ground_and_length(seed: int, scale: float) -> None:
    """A scene turned, moved and scaled at will comes back upright, in metres, with its ground at height 0."""
    random = np.random.default_rng(seed)
    cameras = handheld(6, travel=1.0)
    rotation = Rotation.random(rng=random).as_matrix()
    translation = random.normal(size=3)
    floor = np.c_[random.uniform(-2, 2, (60, 1)), random.uniform(2, 6, (60, 1)), np.zeros((60, 1))]
    there = CameraPath(K=cameras.K, R=cameras.R, T=cameras.T, points=floor).transformed(scale, rotation, translation)
    plane = fit_plane(there.points)
    world = world_from_ground(
        plane, there, length=(there.points[0], there.points[1], np.linalg.norm(floor[0] - floor[1]))
    )
    back = there.transformed(*world)
    assert np.abs(back.points[:, 2]).max() < 1e-9
    assert back.centres[:, 2] == pytest.approx(cameras.centres[:, 2], abs=1e-8)
    assert np.linalg.norm(back.points[3] - back.points[9]) == pytest.approx(np.linalg.norm(floor[3] - floor[9]))
    assert np.median(back.points, axis=0)[2] == pytest.approx(0, abs=1e-9)
    forward = back.R[0, 2]
    assert forward[0] == pytest.approx(0, abs=1e-9)
    assert forward[1] > 0
    by_height = there.transformed(*world_from_ground(plane, there, camera_height=float(cameras.centres[0, 2])))
    assert by_height.centres[:, 2] == pytest.approx(cameras.centres[:, 2], abs=1e-8)


def test_known_length_must_be_a_length() -> None:
    """Two equal points, a negative distance, and two lengths at once are refused."""
    cameras = handheld(3)
    plane = fit_plane(np.c_[np.random.default_rng(0).uniform(-1, 1, (9, 2)), np.zeros(9)])
    for bad in (((0, 0, 0), (0, 0, 0), 1.0), ((0, 0, 0), (1, 0, 0), -1.0)):
        with pytest.raises(InputError, match="known length"):
            world_from_ground(plane, cameras, length=bad)
    with pytest.raises(InputError, match="one known length"):
        world_from_ground(plane, cameras, length=((0, 0, 0), (1, 0, 0), 1.0), camera_height=1.0)
