"""What edits do, and what they refuse."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from app.model.document import Document
from app.model.edits import Edit, characters, contacts, poses, scene, tracks
from app.model.values import Clip, Interval, MediaRef, ModelError
from tests.app.strategies import CLIP, start


@pytest.fixture
def document() -> Document:
    """Two tracks and a character."""
    document = tracks.add_track(start(), 3, (10, 20), name="paw").document
    document = tracks.add_track(document, 0, (30, 40), name="nose").document
    return characters.add_character(document, MediaRef("cat.ply", "f"), name="cat").document


def test_spans_lie_between_clicks(document: Document) -> None:
    """A correction makes two spans of one."""
    for frame in (20, 9):
        document = tracks.set_click(document, "t1", frame, (1, 1)).document
    assert document.track("t1").spans == ((3, 9), (9, 20))


def test_a_click_where_the_track_had_ended_begins_it_again(document: Document) -> None:
    """End and restart: what lies between stays absent."""
    document = tracks.end_track(document, "t1", 10).document
    assert document.track("t1").absent == (Interval(10, 29),)
    document = tracks.set_click(document, "t1", 15, (7, 7)).document
    assert document.track("t1").absent == (Interval(10, 14),)


def test_contacts_that_touch_become_one(document: Document) -> None:
    """Two overlapping marks are one contact."""
    document = contacts.add_contact(document, "t1", 4, 8).document
    document = contacts.add_contact(document, "t1", 12, 7).document
    assert [contact.span for contact in document.track("t1").contacts] == [Interval(4, 12)]


def test_deleting_a_track_leaves_nothing_hanging(document: Document) -> None:
    """Pairs, mirrors, followers and the constant depth go with the track."""
    document = characters.set_pair(document, "c3", "t1", 5).document
    document = tracks.set_mirror(document, "t1", "t2").document
    document = scene.set_ground(document, "depth", depth_tracks=["t1"]).document
    document = poses.follow_track(document, "c3", 9, "t1").document
    document = tracks.delete_track(document, "t1").document
    assert "t1" not in document.character("c3").pairs
    assert not document.character("c3").following
    assert document.track("t2").mirror is None
    assert document.world.depth_tracks == ()


def test_mirrors_are_mutual(document: Document) -> None:
    """A new partner frees the old one."""
    document = tracks.add_track(document, 0, (1, 1), name="tail").document
    document = tracks.set_mirror(document, "t1", "t2").document
    document = tracks.set_mirror(document, "t1", "t4").document
    assert [track.mirror for track in document.tracks] == ["t4", None, "t1"]


def test_deleting_the_last_move_deletes_the_edit(document: Document) -> None:
    """An edited frame without moves is no edited frame."""
    document = poses.move_vertices(document, "c3", 5, {7: (0, 0, 1)}, {7: (0, 0, 1)}).document
    assert not poses.delete_move(document, "c3", 5, 7).document.character("c3").edits


def test_labels_are_what_a_person_would_say(document: Document) -> None:
    """Labels name the thing and the frame."""
    assert tracks.set_click(document, "t1", 3, (1, 1)).label == "Move paw, frame 3"
    assert tracks.set_click(document, "t1", 8, (1, 1)).label == "Correct paw, frame 8"
    assert contacts.add_contact(document, "t1", 4, 8).label == "Mark contact of paw, frames 4-8"


REFUSED: dict[str, Callable[[Document], Edit]] = {
    "outside the clip": lambda d: tracks.set_click(d, "t1", 30, (1, 1)),
    "two finite numbers": lambda d: tracks.set_click(d, "t1", 3, (math.nan, 1)),
    "outside the picture": lambda d: tracks.set_click(d, "t1", 3, (400, 1)),
    "no track 't9'": lambda d: tracks.set_click(d, "t9", 3, (1, 1)),
    "only this click": lambda d: tracks.remove_click(d, "t1", 3),
    "no click in frame 4": lambda d: tracks.remove_click(d, "t1", 4),
    "already called nose": lambda d: tracks.rename_track(d, "t1", "nose"),
    "must not be empty": lambda d: tracks.rename_track(d, "t1", "  "),
    "no click before frame 2": lambda d: tracks.end_track(d, "t1", 2),
    "has not ended": lambda d: tracks.restart_track(d, "t1", 5, (1, 1)),
    "its own mirror": lambda d: tracks.set_mirror(d, "t1", "t1"),
    "no contact in frame 4": lambda d: contacts.remove_contact(d, "t1", 4),
    "at least 3 points": lambda d: scene.add_lasso(d, 0, [(0, 0), (1, 1)]),
    "at least 3 selected": lambda d: scene.set_ground(d, "plane", plane_points=[(0, 0, 0)]),
    "need the file": lambda d: scene.set_camera(d, "file"),
    "positive number of pixels": lambda d: scene.set_camera(d, "solve", focal=0),
    "marks up to frame 3": lambda d: scene.set_clip(d, Clip(CLIP.media, 320, 180, 2, 25.0)),
    "No vertex was moved": lambda d: poses.move_vertices(d, "c3", 0, {}, {}),
    "not -1": lambda d: characters.set_pair(d, "c3", "t1", -1),
    "must be a positive number, not -1": lambda d: characters.set_alignment(d, "c3", scale=-1),
    "no pose edit in frame 4": lambda d: poses.delete_edit(d, "c3", 4),
    "is no control vertex": lambda d: poses.delete_control_vertex(d, "c3", 4),
}


@pytest.mark.parametrize("reason", REFUSED)
def test_bad_edits_are_refused_in_one_sentence(document: Document, reason: str) -> None:
    """An edit that the document cannot take raises ``ModelError`` and says why."""
    with pytest.raises(ModelError, match=reason) as refusal:
        REFUSED[reason](document)
    assert "\n" not in str(refusal.value)


def test_a_project_without_a_clip_says_what_to_do() -> None:
    """A click without a video asks for the video."""
    with pytest.raises(ModelError, match="add a video first"):
        tracks.add_track(Document(), 0, (1, 1))


def test_a_vertex_follows_one_track(document: Document) -> None:
    """Two tracks on one vertex would pull against each other."""
    document = characters.set_pair(document, "c3", "t1", 5).document
    with pytest.raises(ModelError, match="already follows paw"):
        characters.set_pair(document, "c3", "t2", 5)
