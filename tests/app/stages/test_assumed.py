"""Horizon, camera height and lengths that the user gives; what is assumed without them, and that it is said."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.model.world import KnownLength, SeenLength, WorldChoice
from app.stages.assumed import ASSUMED_DEPTH, ASSUMED_HEIGHT
from app.stages.worldframe import make_world
from imitation import CameraPath
from imitation.errors import InputError
from tests.imitation.cameras.scenes import handheld

K = np.array([[900.0, 0, 320], [0, 900, 240], [0, 0, 1]])
LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@attrs.frozen
class Found:
    """A track as the stages see it."""

    positions: np.ndarray
    confidence: np.ndarray


def turning(pitch: float, roll: float = 0.0, height: float = 1.6) -> CameraPath:
    """A camera at a height that pans by 20 degrees about the vertical, held at a pitch and a roll; its true world."""
    held = Rotation.from_euler("ZX", [-roll, pitch], degrees=True).as_matrix()
    turns = [Rotation.from_euler("z", angle, degrees=True).as_matrix() for angle in np.linspace(0, 20, 5)]
    rotations = np.stack([held @ LEVEL @ turn for turn in turns])
    shifts = -np.einsum("nij,j->ni", rotations, [0, 0, height])
    return CameraPath(np.tile(K, (5, 1, 1)), rotations, shifts, "rotation")


def unknown(path: CameraPath) -> CameraPath:
    """The same cameras in a world of their own: the first one at the origin, looking along Z."""
    return CameraPath(path.K, path.R @ path.R[0].T, np.zeros((len(path), 3)), path.verdict)


@pytest.mark.parametrize(("pitch", "roll"), [(0.0, 0.0), (7.0, 0.0), (-3.0, 2.0), (25.0, -10.0)])
def test_a_given_pitch_puts_feet_where_they_stand(pitch: float, roll: float) -> None:
    """Points of the ground, seen by a tilted camera that only turns, come back to their places."""
    path = turning(pitch, roll)
    choice = WorldChoice(ground="plane", pitch=pitch, roll=roll, height=1.6)
    world = make_world(choice, unknown(path))
    feet = np.array([[0.2, 6.0, 0], [1.0, 9.0, 0], [-0.8, 7.0, 0]])
    places = []
    for foot in feet:
        for frame in range(5):
            ray = world.cameras[frame].rays(path[frame].project(foot))
            centre = world.cameras[frame].centre
            places.append(centre - centre[2] / ray[2] * ray)
    places = np.array(places).reshape(3, 5, 3)
    assert np.ptp(places, axis=1).max() < 1e-9
    between = lambda array: np.linalg.norm(array - np.roll(array, 1, axis=0), axis=1)  # noqa: E731
    np.testing.assert_allclose(between(places[:, 0]), between(feet), atol=1e-9)
    assert world.metric
    assert f"tilted by {pitch:g} degrees" in world.note


def test_a_wrong_pitch_stretches_the_ground() -> None:
    """Two degrees matter at a shallow look: that is why they can be given."""
    path = turning(2.0)
    feet = np.array([[0.0, 7.0, 0], [0.0, 9.0, 0]])
    spread = []
    for pitch in (None, 2.0):
        world = make_world(WorldChoice(ground="plane", pitch=pitch), unknown(path))
        camera = world.cameras[0]
        rays = camera.rays(path[0].project(feet))
        places = camera.centre - camera.centre[2] / rays[:, 2:] * rays
        spread.append(float(np.linalg.norm(places[1] - places[0])))
    assert spread[1] == pytest.approx(2.0)
    assert abs(spread[0] - 2.0) > 0.5


def test_what_is_assumed_is_said() -> None:
    """Without a pitch the camera is level, without a height it is at 1.6 m and no metre is known."""
    world = make_world(WorldChoice(ground="plane"), unknown(turning(0.0)))
    assert "1.6 m under a level camera is assumed" in world.note
    assert not world.metric
    assert world.cameras.centres[0, 2] == pytest.approx(ASSUMED_HEIGHT)
    given = make_world(WorldChoice(ground="plane", height=2.5), unknown(turning(0.0)))
    assert given.cameras.centres[0, 2] == pytest.approx(2.5)
    assert given.metric
    assert "whose tilt is assumed" in given.note
    assert "camera's height" in given.note


def test_a_height_scales_a_recovered_scene() -> None:
    """With parallax the height of the first camera above the found ground is a known length."""
    random = np.random.default_rng(0)
    floor = np.c_[random.uniform(-3, 3, 200), random.uniform(2, 8, 200), np.zeros(200)]
    true = handheld(6, travel=0.5)
    path = attrs.evolve(true.transformed(0.37, np.eye(3), np.zeros(3)), points=0.37 * floor)
    world = make_world(WorldChoice(height=float(true.centres[0, 2])), path)
    assert world.metric
    assert world.cameras.centres[0, 2] == pytest.approx(true.centres[0, 2], rel=1e-3)
    assert world.scale == pytest.approx(1 / 0.37, rel=1e-3)


def test_two_still_tracks_give_the_scale() -> None:
    """Two points of the background, tracked while the camera moves, and the metres between them."""
    random = np.random.default_rng(0)
    floor = np.c_[random.uniform(-3, 3, 200), random.uniform(2, 8, 200), np.zeros(200)]
    true = handheld(8, travel=1.0)
    ends = np.array([[-0.4, 5.0, 0.3], [0.6, 5.5, 1.2]])
    tracks = [Found(np.stack([true[t].project(end) for t in range(8)]), np.ones(8)) for end in ends]
    path = attrs.evolve(true.transformed(0.37, np.eye(3), np.zeros(3)), points=0.37 * floor)
    metres = float(np.linalg.norm(ends[1] - ends[0]))
    first, second = (tuple(track.positions[3]) for track in tracks)
    seen = SeenLength(3, first, second, metres, ("t1", "t2"))
    world = make_world(WorldChoice(seen=seen), path, tracks)
    assert world.scale == pytest.approx(1 / 0.37, rel=1e-4)
    assert "stand still" in world.note
    # A point that moves cannot be located so: it counts in its frame alone, on the ground.
    walking = np.array([[0.0, 4.0 + 0.2 * t, 0.0] for t in range(8)])
    moving = [
        Found(np.stack([true[t].project(walking[t] + side) for t in range(8)]), np.ones(8))
        for side in ([0, 0, 0], [0.5, 0, 0])
    ]
    seen = SeenLength(3, (0.0, 0.0), (1.0, 1.0), 0.5, ("t1", "t2"))
    world = make_world(WorldChoice(seen=seen), path, moving)
    assert world.scale == pytest.approx(1 / 0.37, rel=0.02)


def test_a_length_at_a_constant_depth_makes_the_depth_metric() -> None:
    """A static camera from above: a known length in the picture says how far away the assumed depth is."""
    path = CameraPath(np.tile(K, (3, 1, 1)), np.tile(LEVEL, (3, 1, 1)), np.zeros((3, 3)), "static")
    seen = SeenLength(0, (200.0, 240.0), (380.0, 240.0), 0.4)
    world = make_world(WorldChoice(ground="depth", from_above=True, seen=seen), path)
    assert world.depth == pytest.approx(0.4 * 900 / 180)
    assert world.metric
    plain = make_world(WorldChoice(ground="depth", from_above=True), path)
    assert plain.depth == ASSUMED_DEPTH


def test_a_length_between_places_is_as_before() -> None:
    """Two places in the cameras' own units."""
    path = unknown(turning(0.0))
    known = KnownLength((0.0, 0.0, 1.0), (0.0, 0.0, 3.0), 1.0)
    assert make_world(WorldChoice(ground="plane", length=known), path).scale == pytest.approx(0.5)


def test_a_pitch_levels_a_world_without_ground() -> None:
    """With a constant depth the horizon still says what is up."""
    path = unknown(turning(10.0))
    world = make_world(WorldChoice(ground="depth", pitch=10.0), path)
    assert world.levelled
    forward = world.cameras.R[0, 2]
    assert np.degrees(np.arcsin(forward[2])) == pytest.approx(-10)


def test_ends_in_one_place_are_refused() -> None:
    """A length between a pixel and itself is one sentence."""
    seen = SeenLength(0, (200.0, 240.0), (200.1, 240.0), 0.4)
    with pytest.raises(InputError, match="same place"):
        make_world(WorldChoice(ground="plane", seen=seen), unknown(turning(0.0)))
