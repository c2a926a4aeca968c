"""Mirrored limbs from the program: who follows whom, and by how much later, without being told."""

from __future__ import annotations

from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from app.model.document import Document
from app.model.edits import characters, tracks
from app.model.values import Clip, MediaRef
from app.stages import animation
from app.stages.media import Media
from app.stages.results import PlacedContact, World
from imitation.propagation import placed_frame
from tests.imitation.propagation.conftest import Walker, film

FRAMES = 46
HIDDEN = range(18, 40)


@attrs.frozen
class Found:
    """A track as the stages see it."""

    positions: np.ndarray
    confidence: np.ndarray


@pytest.fixture(scope="module")
def walker() -> Walker:
    """One and a half strides of a quadruped."""
    return film("quadruped", FRAMES, "flat", 60.0, seed=4)


def document(walker: Walker, lag: int | None) -> Document:
    """Its key points clicked and paired; the right fore leg is hidden for most of a stride."""
    made = Document(clip=Clip(MediaRef("a.mp4", "1"), 4000, 4000, FRAMES, 25.0))
    made = characters.add_character(made, MediaRef("a.ply", "2"), name="hound", up="z").document
    (character,) = made.characters
    for name, track in walker.tracks.items():
        for frame in (0, 22, FRAMES - 1):
            place = np.clip(track[frame], 0, 3999)
            if frame == 0:
                made = tracks.add_track(made, frame, place, name=name).document
            elif not (name.startswith("right front") and frame in HIDDEN):
                made = tracks.set_click(made, made.tracks[-1].id, frame, place).document
        made = characters.set_pair(made, character.id, made.tracks[-1].id, walker.pairs[name]).document
    ids = {track.name: track.id for track in made.tracks}
    for name in ids:
        if name.startswith("right"):
            made = tracks.set_mirror(made, ids[name], ids[name.replace("right", "left")], lag=lag).document
        if name.startswith("right front"):
            made = tracks.set_occluded(made, ids[name], HIDDEN[0], HIDDEN[-1], True).document
    return characters.set_solve(made, character.id, symmetry=True).document


def solved(walker: Walker, made: Document) -> np.ndarray:
    """The base stage on exact tracks and cameras."""
    up = np.array([0.0, 0, 1])
    world = World(walker.cameras, 1.0, np.eye(3), np.zeros(3), up, 0.0, True, True, True, None, "")
    names = [track.name for track in made.tracks]
    found = [Found(walker.tracks[name], np.ones(FRAMES)) for name in names]
    contacts = [
        [PlacedContact(*span, "as given", 0.0) for span in walker.walk.contacts.get(name, [])]
        if not name.startswith("right front") else []
        for name in names
    ]  # fmt: skip
    stage = animation.base(made, made.characters[0])
    pairs = {track.id: walker.pairs[track.name] for track in made.tracks}
    placed = placed_frame(walker.rest, walker.faces, walker.cameras[0], pairs)
    context = SimpleNamespace(media=Media(lambda media: media), progress=lambda _: None, emit=lambda _: None)
    return stage.compute(context, stage.inputs, world, placed, *found, *contacts).vertices


@pytest.mark.slow
def test_the_program_lets_a_hidden_leg_step_half_a_stride_later(walker: Walker) -> None:
    """Who mirrors whom is all that is said: hidden for 22 frames the paw is nearer to its true steps than in step."""
    paw = walker.pairs["right front paw"]
    error = {}
    for lag in (None, 0):
        vertices = solved(walker, document(walker, lag))
        error[lag] = float(np.linalg.norm((vertices - walker.walk.vertices)[list(HIDDEN), paw], axis=1).mean())
    assert error[None] < 0.7 * error[0]


def test_a_given_lag_is_kept_on_both_sides(walker: Walker) -> None:
    """What is later for the one is earlier for the other, and reaches the stage."""
    made = document(walker, 15)
    by_name = {track.name: track for track in made.tracks}
    assert by_name["right front paw"].mirror_lag == 15
    assert by_name["left front paw"].mirror_lag == -15
    inputs = animation.base(made, made.characters[0]).inputs
    assert (by_name["right front paw"].id, (by_name["left front paw"].id, 15)) in inputs[3]
