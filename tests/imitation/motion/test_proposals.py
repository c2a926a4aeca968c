"""Proposed contacts and mirrored limbs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

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
