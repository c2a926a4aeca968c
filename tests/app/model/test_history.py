"""Undo is exact, whatever was done."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.model.document import Document
from app.model.edits import scene, tracks
from app.model.history import History
from app.model.values import ModelError
from tests.app.strategies import EditMaker, edit_makers, start


@given(st.lists(edit_makers(), max_size=40))
@settings(max_examples=60, deadline=None)
def test_undo_all_gives_the_very_first_document_and_redo_all_the_last(makers: list[EditMaker]) -> None:
    """Any random sequence of edits, undone fully, gives the exact state; redone fully, the last one."""
    first = start()
    history = History(first)
    for maker in makers:
        try:
            edit = maker(history.document)
        except ModelError:
            continue
        history.apply(edit.document, edit.label, frame=edit.frame)
    last, steps = history.document, history.present
    for _ in range(steps):
        history.undo()
    assert history.document is first
    for _ in range(steps):
        history.redo()
    assert history.document is last


def test_a_gesture_is_one_entry() -> None:
    """A drag of many moves becomes one entry that undo takes back whole."""
    history = History(tracks.add_track(start(), 0, (5, 5), name="paw").document)
    before = history.document
    for x in range(10):
        edit = tracks.set_click(history.document, "t1", 0, (x, 5.0))
        history.apply(edit.document, edit.label, gesture="drag 1")
    assert history.undo_label == "Move paw, frame 0"
    history.undo()
    assert history.document is before
    assert history.redo_label == "Move paw, frame 0"


def test_a_second_gesture_is_a_second_entry() -> None:
    """Two drags of the same point stay two entries, also under one gesture name once it was closed."""
    history = History(tracks.add_track(start(), 0, (5, 5)).document)
    for x in (6.0, 7.0):
        edit = tracks.set_click(history.document, "t1", 0, (x, 5.0))
        history.apply(edit.document, edit.label, gesture="drag")
        history.close_gesture()
    assert history.present == 2


def test_a_gesture_that_comes_back_leaves_no_entry() -> None:
    """A drag that ends where it began is nothing to undo."""
    history = History(tracks.add_track(start(), 0, (5, 5)).document)
    for x in (6.0, 5.0):
        edit = tracks.set_click(history.document, "t1", 0, (x, 5.0))
        history.apply(edit.document, edit.label, gesture="drag")
    assert history.undo_label is None


def test_an_edit_after_undo_drops_the_redo_branch() -> None:
    """What was undone cannot come back once something else was done."""
    history = History(start())
    history.apply(scene.rename(history.document, "one").document, "one")
    history.undo()
    history.apply(scene.rename(history.document, "two").document, "two")
    assert history.redo_label is None
    assert history.document.name == "two"


def test_modified_follows_the_saved_version() -> None:
    """Undo back to the saved version is unmodified again; a dropped saved version never is."""
    history = History(start())
    assert not history.modified
    history.apply(scene.rename(history.document, "one").document, "one")
    history.mark_saved()
    assert not history.modified
    history.undo()
    assert history.modified
    history.redo()
    assert not history.modified
    history.undo()
    history.apply(scene.rename(history.document, "two").document, "two")
    assert history.modified


def test_the_ends_of_history_are_said() -> None:
    """Undo at the beginning and redo at the end are refused in one sentence."""
    history = History(Document())
    with pytest.raises(ModelError, match="nothing to undo"):
        history.undo()
    with pytest.raises(ModelError, match="nothing to redo"):
        history.redo()
    with pytest.raises(ModelError, match="no version 7"):
        history.jump(7)
