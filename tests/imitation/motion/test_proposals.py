"""Proposed contacts and mirrored limbs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from imitation.cameras import CameraPath, Ground, Plane
from imitation.errors import InputError
from imitation.motion import mirror_motion, propose_contacts
from imitation.motion.symmetry import body_frames, sagittal_normal
from resources.world import make_body, make_camera, walk


@pytest.mark.parametrize("style", ["handheld", "static"])
def test_contacts_of_a_walk_are_proposed(style: str) -> None:
    """Most planted frames are proposed and few others, for a shaking and for a still camera."""
    body = make_body("quadruped", vertices=900)
    made = walk(body, 61, "flat", seed=3)
    cameras = make_camera(made.centre, body.diagonal, azimuth=70, seed=3, style=style)
    depth = float(cameras[0].depth(made.centre[0]))
    hits = misses = false = 0
    for name in made.contacts:
        track = np.stack([cameras[t].project(made.key_points[name][t]) for t in range(61)])
        track += 0.2 * np.random.default_rng(1).normal(size=track.shape)
        proposed = np.zeros(61, bool)
        for first, last in propose_contacts(track, cameras, depth=depth):
            proposed[first : last + 1] = True
        planted = made.planted(name)
        hits += int((proposed & planted).sum())
        misses += int((~proposed & planted).sum())
        false += int((proposed & ~planted).sum())
    assert hits > 0.85 * (hits + misses)
    assert false < 0.2 * (hits + misses)


def test_a_track_that_always_moves_has_no_contact() -> None:
    """The nose of a walker never stands still for long."""
    body = make_body("quadruped", vertices=900)
    made = walk(body, 41, "flat", seed=3)
    cameras = make_camera(made.centre, body.diagonal, azimuth=90, seed=3)
    track = np.stack([cameras[t].project(made.key_points["nose"][t]) for t in range(41)])
    assert propose_contacts(track, cameras, depth=float(cameras[0].depth(made.centre[0]))) == []


def test_gaps_end_a_contact() -> None:
    """A frame without a position is in no contact."""
    body = make_body("quadruped", vertices=900)
    cameras = make_camera(np.zeros((20, 3)), body.diagonal, seed=1)
    track = np.stack([cameras[t].project(np.zeros(3)) for t in range(20)])
    track[9] = np.nan
    assert propose_contacts(track, cameras) == [(0, 8), (10, 19)]


@pytest.mark.parametrize(("length", "options"), [(19, {}), (20, {"tolerance": 0.0}), (20, {"depth": -1.0})])
def test_bad_proposals_are_refused(length: int, options: dict) -> None:
    """Lengths that differ and numbers that are not positive are one sentence."""
    cameras = make_camera(np.zeros((20, 3)), 1.0, seed=1)
    with pytest.raises(InputError):
        propose_contacts(np.zeros((length, 2)), cameras, **options)


def symmetric_body() -> tuple[np.ndarray, np.ndarray]:
    """Six points on the middle and the left of a body, and two on the right that mirror the last two."""
    visible = np.array(
        [[0.0, 0, 0], [1, 0, 0.1], [0.5, 0, 0.5], [0.1, 0, 0.3], [1, 0.3, -0.5], [0.0, 0.3, -0.5], [0.5, 0.2, 0.1]]
    )
    return visible, visible[[4, 5]] * [1, -1, 1]


def test_a_hidden_limb_moves_as_its_mirror() -> None:
    """A body that turns and walks while a limb swings sideways: the hidden one swings to the other side."""
    rest, hidden = symmetric_body()
    count = 30
    swing = 0.2 * np.sin(np.arange(count) / 5)
    own = np.tile(rest, (count, 1, 1))
    own[:, 4] += np.stack([0.5 * swing, swing, 0 * swing], axis=1)
    expected = np.tile(hidden, (count, 1, 1))
    expected[:, 0] += np.stack([0.5 * swing, -swing, 0 * swing], axis=1)
    turns = Rotation.from_rotvec(np.linspace(0, 1, count)[:, None] * [0.2, 0.1, 1.0]).as_matrix()
    travel = np.linspace(0, 2, count)[:, None] * [1.0, 0.5, 0.1]
    world = np.einsum("nij,nkj->nki", turns, own) + travel[:, None]
    truth = np.einsum("nij,nkj->nki", turns, expected) + travel[:, None]
    found = mirror_motion(world, rest, hidden, np.array([4, 5]), np.array([0.0, 1.0, 0.0]))
    assert np.linalg.norm(found - truth, axis=2).max() < 0.03
    assert np.array_equal(found[0], hidden)


def test_body_frames_of_a_rigid_motion_are_exact() -> None:
    """Rotation and centre of a rigid body come out to rounding."""
    rest, _ = symmetric_body()
    turns = Rotation.from_rotvec(np.linspace(0, 2, 9)[:, None] * [0.3, 0.4, 0.5]).as_matrix()
    rotation, centre = body_frames(np.einsum("nij,kj->nki", turns, rest) + 1.0, rest)
    np.testing.assert_allclose(rotation, turns, atol=1e-9)
    np.testing.assert_allclose(centre, turns @ rest.mean(axis=0) + 1.0, atol=1e-9)


@pytest.mark.parametrize("kind", ["quadruped", "biped"])
def test_plane_of_symmetry_of_a_walking_body(kind: str) -> None:
    """The plane is found within ten degrees in a pose whose legs are no mirror images, from a hint askew by 30."""
    body = make_body(kind, vertices=900)
    posed = walk(body, 12, "flat", seed=3).vertices[5]
    turn = Rotation.from_rotvec([0.0, 0.0, 0.7])
    normal = sagittal_normal(turn.apply(posed), turn.apply([0.5, np.cos(np.pi / 6), 0.0]))
    assert abs(normal @ turn.apply([0.0, 1.0, 0.0])) > np.cos(np.radians(10))


def leap(style: str) -> tuple[CameraPath, np.ndarray, np.ndarray]:
    """A body that crouches on the ground, leaps and lands, filmed; its two feet and three other points in the picture.

    Frames 0-9 it stands and the trunk sinks; 10-24 it is in the air with its top near 17; 25-39 it stands.
    """
    frames = np.arange(40)
    height = np.minimum(0.5 * (1 - ((frames - 17) / 7.5) ** 4).clip(0), 0.49)
    feet = np.array([[-0.1, 0, 0], [0.1, 0, 0.0]])
    trunk = np.array([[0, 0, 0.9], [-0.2, 0, 1.3], [0.2, 0, 1.3]])
    sway = 0.02 * np.cumsum(np.where((frames > 10) & (frames < 25), 0, np.sin(frames / 2)))
    body = np.tile(np.concatenate([feet, trunk]), (40, 1, 1))
    body[:, :, 2] += height[:, None]
    body[:, 2:, 2] += sway[:, None]
    cameras = make_camera(np.tile([0.0, 0.0, 0.7], (40, 1)), 1.8, azimuth=80, seed=5, style=style)
    pixels = np.stack([cameras[t].project(body[t]) for t in range(40)])
    return cameras, pixels[:, :2], pixels[:, 2:]


@pytest.mark.parametrize("style", ["handheld", "static"])
def test_a_leap_is_no_contact_of_both_feet(style: str) -> None:
    """At its top the feet are still for some frames, at a height where there is no ground: they are not proposed."""
    cameras, feet, trunk = leap(style)
    floor = Ground("floor", plane=Plane(np.array([0.0, 0, 1]), 0.0))
    for foot in range(2):
        before = propose_contacts(feet[:, foot], cameras)
        now = propose_contacts(
            feet[:, foot], cameras, ground=lambda t, pixel: floor.intersect(cameras[t], pixel),
            others=np.concatenate([feet[:, 1 - foot, None], trunk], axis=1),
        )  # fmt: skip
        assert any(first < 20 and last > 14 for first, last in before)
        assert not any(first < 23 and last > 11 for first, last in now), now
        assert any(first <= 2 and last >= 7 for first, last in now), now
        assert any(first <= 27 and last >= 37 for first, last in now), now


def test_a_long_stand_is_a_contact_though_nothing_moves() -> None:
    """A second of stillness is no leap, also for a camera that stands still."""
    cameras = make_camera(np.zeros((30, 3)), 1.8, azimuth=80, seed=5, style="static")
    still = np.stack([cameras[t].project(np.zeros(3)) for t in range(30)])
    other = np.stack([cameras[t].project(np.array([0, 0, 1.0])) for t in range(30)])
    assert propose_contacts(still, cameras, others=other[:, None]) == [(0, 29)]
    short = np.where(np.arange(30)[:, None] < 8, still, np.nan)
    assert propose_contacts(short, cameras, others=other[:, None]) == []


def test_others_of_another_clip_are_refused() -> None:
    """Other tracks need the clip's length."""
    cameras = make_camera(np.zeros((20, 3)), 1.0, seed=1)
    with pytest.raises(InputError, match="Other tracks"):
        propose_contacts(np.zeros((20, 2)), cameras, others=np.zeros((19, 3, 2)))
