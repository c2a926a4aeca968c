"""Contacts in the world: a stray one follows the other feet, sure frames say where."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from app.model.tracks import Contact
from app.model.values import Interval
from app.model.world import WorldChoice
from app.stages.results import PlacedContact, World
from app.stages.worldframe import agreed, make_world, place_contact, place_on_background
from imitation import CameraPath, InputError, NoSolution

LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
FRAMES = 30


@attrs.frozen
class Found:
    """A track as the stages see it."""

    positions: np.ndarray
    confidence: np.ndarray


@pytest.fixture
def world() -> World:
    """A camera 1.5 above level ground that looks along +Y."""
    K = np.array([[800.0, 0, 320], [0, 800, 180], [0, 0, 1]])
    T = -LEVEL @ np.array([0, 0, 1.5])
    path = CameraPath(np.tile(K, (FRAMES, 1, 1)), np.tile(LEVEL, (FRAMES, 1, 1)), np.tile(T, (FRAMES, 1)), "ok")
    up = np.array([0.0, 0, 1])
    return World(path, 1.0, np.eye(3), np.zeros(3), up, 0.0, False, True, True, None, "")


def seen(world: World, place: np.ndarray) -> Found:
    """A track that stays where this place is seen, surely."""
    pixel = world.cameras[0].project(place)
    return Found(np.tile(pixel, (FRAMES, 1)), np.ones(FRAMES))


def test_a_stray_contact_goes_to_the_depth_of_the_other_feet(world: World) -> None:
    """Three firm feet at depth 4; a fourth on few points at depth 6 comes to them on its own ray."""
    firm = [PlacedContact(5 * k, 5 * k + 4, np.array([0.1 * k, 4.0, 0]), "level", 0.0, 0.9) for k in range(3)]
    stray = PlacedContact(12, 16, np.array([0.3, 6.0, 0.2]), "level local fit to 4 of 40 points", 0.0, 0.1)
    tracks = {"paw": seen(world, np.array([0.0, 4, 0])), "other": seen(world, stray.place)}
    mended = agreed({"paw": firm, "other": [stray]}, tracks, world)
    assert mended["paw"] == firm
    place = mended["other"][0].place
    assert world.cameras[14].depth(place) == pytest.approx(4.0)
    assert np.abs(world.cameras[14].project(place) - tracks["other"].positions[14]).max() < 1e-9
    assert "other feet" in mended["other"][0].ground


def test_a_well_supported_contact_is_believed(world: World) -> None:
    """A foot on many points stays where it is, however far from the others."""
    firm = [PlacedContact(5 * k, 5 * k + 4, np.array([0.1 * k, 4.0, 0]), "level", 0.0, 0.9) for k in range(3)]
    far = PlacedContact(12, 16, np.array([0.3, 6.0, 0]), "level", 0.0, 0.8)
    tracks = {"paw": seen(world, firm[0].place), "other": seen(world, far.place)}
    assert agreed({"paw": firm, "other": [far]}, tracks, world)["other"] == [far]


def test_a_contact_is_where_its_sure_frames_meet_the_plane(world: World) -> None:
    """Frames in which the track is lost do not move the contact."""
    place = np.array([0.2, 5.0, 0.0])
    track = seen(world, place)
    track.positions[6:] += [30, 25]
    track.confidence[6:] = 0.3
    made = place_contact(Contact(Interval(2, 12)), "paw", track, WorldChoice(ground="plane"), world)
    assert np.abs(made.place - place).max() < 1e-6


def test_a_contact_without_its_track_says_so(world: World) -> None:
    """A contact in frames where the point is not in the picture is refused in one sentence."""
    track = Found(np.full((FRAMES, 2), np.nan), np.zeros(FRAMES))
    with pytest.raises(InputError, match="paw is not in the picture in frames 2-12"):
        place_contact(Contact(Interval(2, 12)), "paw", track, WorldChoice(ground="plane"), world)


def test_failed_cameras_make_no_world() -> None:
    """A failed solve is named, not used."""
    path = CameraPath(np.eye(3)[None], np.eye(3)[None], np.zeros((1, 3)), "failed", reason="Too dark.")
    with pytest.raises(InputError, match="Too dark"):
        make_world(WorldChoice(), path)


def test_a_contact_on_the_measured_background_says_how_sure_it_is(world: World) -> None:
    """The median of the places that the surest frames give; without depth there the local ground, and why."""
    place = np.array([0.3, 4.0, 0.0])
    track = seen(world, place)
    track.confidence[3] = 0.1
    asked: list[int] = []

    class Known:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            asked.append(frame)
            return place + np.array([0, 0.01 * (frame % 2), 0]), 0.02

    contact = Contact(Interval(2, 9))
    found = place_on_background(contact, "paw", track, WorldChoice(ground="background"), world, Known())  # type: ignore[arg-type]
    assert 3 not in asked
    assert len(asked) == 5
    assert found.ground == "the measured background"
    assert np.abs(found.place - place).max() <= 0.01
    assert 0.02 < found.residual < 0.03
    assert found.support == 1

    class Nothing:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            raise NoSolution("No background depth is known near pixel (3, 4) of frame 2.")

    instead = place_on_background(contact, "paw", track, WorldChoice(ground="background"), world, Nothing())  # type: ignore[arg-type]
    assert "the ground plane" in instead.ground
    assert instead.ground.endswith("for no background depth is known near pixel (3, 4) of frame 2")
    np.testing.assert_allclose(instead.place, place, atol=1e-6)

    class Straying:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            return place, 0.3

    class Apart:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            return place * (1 + frame), 0.01

    class Sky:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            return world.cameras[frame].lift(pixel, 60.0), 0.01

    bad = ((Straying(), "strays there"), (Apart(), "differs from frame to frame"), (Sky(), "far from the recovered"))
    for known, why in bad:
        choice = WorldChoice(ground="background")
        instead = place_on_background(contact, "paw", track, choice, world, known)  # type: ignore[arg-type]
        assert why in instead.ground
        np.testing.assert_allclose(instead.place, place, atol=1e-6)


def test_a_foot_that_slides_says_nothing_against_the_background(world: World) -> None:
    """The track moves half a metre over the floor during its contact; the measured floor is the same in every frame."""
    place = np.array([0.3, 4.0, 0.0])
    track = seen(world, place)
    for frame in range(FRAMES):
        track.positions[frame] = world.cameras[frame].project(place + np.array([0.06 * frame, 0.03 * frame, 0]))

    class Floor:
        def place(self, frame: int, pixel: np.ndarray) -> tuple[np.ndarray, float]:
            ray = world.cameras[frame].rays(pixel)
            centre = world.cameras[frame].centre
            return centre - ray * centre[2] / ray[2], 0.01

    contact = Contact(Interval(2, 9))
    found = place_on_background(contact, "paw", track, WorldChoice(ground="background"), world, Floor())  # type: ignore[arg-type]
    assert found.ground == "the measured background"
    assert abs(found.place[2]) < 1e-6
    assert found.residual < 0.012
