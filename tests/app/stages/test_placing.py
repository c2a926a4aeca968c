"""Placing in frame 0: a subject in the air is as large as it is on its first contact."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from app.formats import MeshFile
from app.model.character import Alignment
from app.stages.placing import place_character
from app.stages.results import PlacedContact, World
from imitation import CameraPath

LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
FRAMES = 12
BODY = np.random.default_rng(0).uniform([-0.5, -0.2, 0.0], [0.5, 0.2, 0.7], (60, 3))
BODY[:4] = [[-0.4, -0.2, 0], [-0.4, 0.2, 0], [0.4, -0.2, 0], [0.4, 0.2, 0]]
FACES = np.array([[0, 1, 2], [1, 2, 3]], np.int32)
PAIRS = {f"t{vertex}": vertex for vertex in (0, 1, 2, 3, 10, 20, 30, 40)}


@attrs.frozen
class Found:
    """A track as the stages see it."""

    positions: np.ndarray


@pytest.fixture
def world() -> World:
    """A camera 1.5 above level ground that looks along +Y."""
    K = np.array([[800.0, 0, 320], [0, 800, 180], [0, 0, 1]])
    T = -LEVEL @ np.array([0, 0, 1.5])
    path = CameraPath(np.tile(K, (FRAMES, 1, 1)), np.tile(LEVEL, (FRAMES, 1, 1)), np.tile(T, (FRAMES, 1)), "ok")
    return World(path, 1.0, np.eye(3), np.zeros(3), np.array([0.0, 0, 1]), 0.0, False, True, True, None, "")


def filmed(world: World, shifts: np.ndarray) -> list[Found]:
    """Tracks of a body that is shifted rigidly, by (frames, 3)."""
    return [
        Found(np.stack([world.cameras[t].project(BODY[v] + shifts[t]) for t in range(FRAMES)])) for v in PAIRS.values()
    ]


def placed(
    world: World, tracks: list[Found], contacts: dict[str, list[PlacedContact]]
) -> tuple[float, np.ndarray, str]:
    """Scale, vertices and note of the character."""
    choice, mesh = Alignment(up="z"), MeshFile(BODY, FACES)
    made = place_character(mesh, PAIRS, choice, world, tracks, [contacts.get(name, []) for name in PAIRS])
    return made.scale, made.vertices, made.note


def test_a_jump_in_frame_0_is_sized_by_the_first_contact(world: World) -> None:
    """Half a metre in the air the ground plane would make it a third too large; the landing says how large it is."""
    shifts = np.tile([0.2, 5.0, 0.0], (FRAMES, 1))
    shifts[:, 2] = np.maximum(0, 0.5 - 0.1 * np.arange(FRAMES))
    tracks = filmed(world, shifts)
    on_plane, _, _ = placed(world, tracks, {})
    assert on_plane > 1.3
    landed = PlacedContact(6, 11, BODY[0] + shifts[6], "as given", 0.0)
    scale, vertices, note = placed(world, tracks, {"t0": [landed]})
    assert scale == pytest.approx(1, abs=0.01)
    np.testing.assert_allclose(vertices, BODY + shifts[0], atol=0.05)
    assert "frame 6" in note


def test_a_subject_that_stands_is_placed_on_the_ground_as_before(world: World) -> None:
    """Where the plane and the first contact agree on the size, frame 0 keeps to the plane to the bit."""
    shifts = np.stack([0.05 * np.arange(FRAMES), np.full(FRAMES, 5.0), np.zeros(FRAMES)], axis=1)
    tracks = filmed(world, shifts)
    step = PlacedContact(6, 7, BODY[0] + shifts[6], "as given", 0.0)
    plain, with_step = placed(world, tracks, {}), placed(world, tracks, {"t0": [step]})
    assert plain[0] == with_step[0]
    assert np.array_equal(plain[1], with_step[1])
