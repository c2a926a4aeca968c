"""Sessions: open, save, save elsewhere, recover; undo finds results without solving."""

from __future__ import annotations

import errno
import gc
import shutil
import weakref
from contextlib import closing
from pathlib import Path

import pytest

from app.actions.marks import apply_marks, character_named, track_named
from app.actions.places import unsaved_folder
from app.actions.session import Session
from app.model.edits import scene, tracks
from app.model.values import ModelError
from imitation import InputError
from tests.app.strategies import start


def with_clip(session: Session) -> None:
    """Give the session a clip and a track, without any file."""
    session.history.apply(start(), "Begin")
    session.apply(tracks.add_track(session.document, 0, (5, 5), name="paw"))


def test_a_new_project_has_no_place_until_saved(tmp_path: Path) -> None:
    """An unsaved project works, refuses to save without a place, and leaves nothing behind when closed."""
    session = Session.new()
    with_clip(session)
    with pytest.raises(InputError, match="no place yet"):
        session.save()
    session.close()
    assert not any(unsaved_folder().iterdir())


def test_save_as_moves_on_to_the_new_place(tmp_path: Path) -> None:
    """After saving elsewhere the session goes on there and is unmodified; the old project stays as it was saved."""
    with closing(Session.new(tmp_path / "one")) as session:
        with_clip(session)
        session.save_as(tmp_path / "two")
        assert not session.history.modified
        assert session.folder.path.name == "two.motionwright"
        assert len(session.history.versions) == 3
        session.apply(scene.rename(session.document, "second"))
        session.save()
    with closing(Session.open(tmp_path / "one")) as first, closing(Session.open(tmp_path / "two")) as second:
        assert first.document.clip is None
        assert second.document.name == "second"


def test_save_as_onto_a_project_is_refused(tmp_path: Path) -> None:
    """Another project is never overwritten, and the session stays where it is."""
    Session.new(tmp_path / "two").close()
    with closing(Session.new(tmp_path / "one")) as session:
        with pytest.raises(InputError, match="project already"):
            session.save_as(tmp_path / "two")
        assert session.folder.path.name == "one.motionwright"


def test_save_as_that_fails_leaves_no_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A full disk is said in one sentence; the place stays free, and the session goes on where it was."""
    with closing(Session.new(tmp_path / "one")) as session:
        with_clip(session)
        session.folder.media.mkdir()
        (session.folder.media / "clip.mp4").write_bytes(b"clip")

        def full(*_: object, **__: object) -> None:
            raise OSError(errno.ENOSPC, "No space left on device")

        with monkeypatch.context() as patched:
            patched.setattr("app.actions.session.shutil.copytree", full)
            with pytest.raises(InputError, match="disk is full"):
                session.save_as(tmp_path / "two")
        assert not (tmp_path / "two.motionwright").exists()
        assert session.folder.path.name == "one.motionwright"
        assert session.history.modified
        session.save_as(tmp_path / "two")
        assert (session.folder.media / "clip.mp4").read_bytes() == b"clip"


def test_what_was_undone_is_not_recovered(tmp_path: Path) -> None:
    """An autosave whose work was taken back is dropped at the next autosave."""
    with closing(Session.new(tmp_path / "film")) as session:
        session.apply(scene.rename(session.document, "undone"))
        assert session.autosave()
        session.undo()
        assert not session.autosave()
        assert session.folder.recoverable() is None


def test_unsaved_work_is_recovered(tmp_path: Path) -> None:
    """What was autosaved before a crash comes back on top of the saved project, and can be undone."""
    session = Session.new(tmp_path / "film")
    with_clip(session)
    assert session.autosave()
    session.runner.close()
    with closing(Session.open(tmp_path / "film", recover=True)) as again:
        assert again.document.tracks[0].name == "paw"
        assert again.history.undo_label == "Recover unsaved work"
        again.undo()
        assert again.document.clip is None


def test_listeners_hear_before_and_after(tmp_path: Path) -> None:
    """Edits, undo and redo tell what was and what is; edits that change nothing are not told."""
    heard = []
    with closing(Session.new(tmp_path / "film")) as session:
        stop = session.subscribe(lambda before, after: heard.append((before.name, after.name)))
        session.apply(scene.rename(session.document, "a"))
        session.apply(scene.rename(session.document, "a"))
        session.undo()
        session.redo()
        stop()
        session.undo()
    assert heard == [("film", "a"), ("a", "film"), ("film", "a")]


def test_a_session_as_it_is_knows_no_later_edits(tmp_path: Path) -> None:
    """What writes a film in another thread goes on with the document it began with, and finds the same results."""
    with closing(Session.new(tmp_path / "a")) as session:
        session.apply(scene.rename(session.document, "before"))
        still, heard = session.as_it_is(), []
        session.subscribe(lambda before, after: heard.append(after))
        session.apply(scene.rename(session.document, "after"))
        assert (still.document.name, session.document.name) == ("before", "after")
        assert len(heard) == 1
        assert still.cache is session.cache
        assert still.history.undo_label is None
        assert still.stages.cameras.key == session.stages.cameras.key


def test_stages_are_made_once_a_version(tmp_path: Path) -> None:
    """The stages of one version are the same objects; an edit makes new ones with other keys where it reaches."""
    with closing(Session.new(tmp_path / "film")) as session:
        with_clip(session)
        before = session.stages
        assert session.stages is before
        session.apply(tracks.set_click(session.document, "t1", 9, (8, 8)))
        assert session.stages.track("t1").key != before.track("t1").key
        assert session.stages.cameras.key == before.cameras.key
        session.undo()
        assert session.stages.track("t1").key == before.track("t1").key


def test_a_correction_leaves_the_other_spans(tmp_path: Path) -> None:
    """A click added between two others changes the span they made and no other."""
    with closing(Session.new(tmp_path / "film")) as session:
        with_clip(session)
        for frame in (10, 20):
            session.apply(tracks.set_click(session.document, "t1", frame, (8, 8)))
        before = {stage.key for stage in session.stages.spans("t1")}
        session.apply(tracks.set_click(session.document, "t1", 15, (8, 9)))
        after = {stage.key for stage in session.stages.spans("t1")}
    assert len(before) == 3
    assert len(before & after) == 2
    assert len(after - before) == 2


def test_a_closed_session_gives_up_its_results(solved_project: Path, tmp_path: Path) -> None:
    """At once: the window looks for no garbage among what was there when it opened."""
    session = Session.open(shutil.copytree(solved_project, tmp_path / "film"))
    character = session.document.characters[0].id
    held = weakref.ref(session.result(session.stages.animation(character)))
    assert held() is not None
    gc.disable()
    try:
        session.close()
        assert held() is None
    finally:
        gc.enable()


def test_names_and_colours_cost_no_solving(tmp_path: Path) -> None:
    """Renaming, colouring and hiding a track leave its result fresh."""
    with closing(Session.new(tmp_path / "film")) as session:
        with_clip(session)
        before = session.stages.track("t1").key
        session.apply(tracks.rename_track(session.document, "t1", "left paw"))
        session.apply(tracks.set_track_look(session.document, "t1", colour=3, visible=False))
        assert session.stages.track("t1").key == before


def test_marks_by_name(tmp_path: Path) -> None:
    """Tracks and characters are found by name, and what is there is named when they are not."""
    with closing(Session.new(tmp_path / "film")) as session:
        with_clip(session)
        assert track_named(session.document, "paw").id == "t1"
        with pytest.raises(InputError, match="the tracks are paw"):
            track_named(session.document, "fin")
        with pytest.raises(InputError, match="Which character"):
            character_named(session.document, None)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "no JSON file"),
        ("[]", "holds no marks"),
        ('{"tracks": {"paw": {}}}', "not as docs/formats.md says"),
        ('{"tracks": {"paw": {"clicks": {"99": [1, 1]}}}}', "outside the clip"),
        ('{"characters": {"cat": {}}}', "has no mesh"),
    ],
)
def test_bad_marks_are_one_sentence(tmp_path: Path, text: str, reason: str) -> None:
    """A damaged or wrong file of marks says what is wrong."""
    file = tmp_path / "marks.json"
    file.write_text(text)
    with closing(Session.new(tmp_path / "film")) as session:
        with_clip(session)
        with pytest.raises((InputError, ModelError), match=reason):
            apply_marks(session, file)


def test_a_project_from_elsewhere_opens(tmp_path: Path) -> None:
    """A copied project folder opens at its new place."""
    Session.new(tmp_path / "film").close()
    shutil.move(tmp_path / "film.motionwright", tmp_path / "moved.motionwright")
    with closing(Session.open(tmp_path / "moved.motionwright")) as session:
        assert session.document.name == "film"
