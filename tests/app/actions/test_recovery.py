"""Work of runs that ended badly: kept until somebody decides, taken up with undo, thrown away for good."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from contextlib import closing
from pathlib import Path

import pytest

from app.actions import recovery
from app.actions.places import unsaved_folder
from app.actions.session import Session
from app.model.edits import scene, tracks
from app.storage.lock import in_use
from tests.app.strategies import start

ABANDON = """
import sys, time
from pathlib import Path
from app.actions.session import Session
from app.model.edits import scene
session = Session.open(Path(sys.argv[1])) if len(sys.argv) > 1 else Session.new()
session.apply(scene.rename(session.document, "filmed"))
session.autosave()
print(session.folder.path, flush=True)
time.sleep(60)
"""


@pytest.fixture(autouse=True)
def private_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Unsaved projects of these tests lie in a place of their own."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))


def killed(*arguments: str) -> Path:
    """Run a program that autosaves and is killed; gives the folder it worked in."""
    command = [sys.executable, "-c", textwrap.dedent(ABANDON), *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        place = Path(program.stdout.readline().strip())
        assert in_use(place)
        assert not recovery.never_saved(), "what is open is offered to nobody"
        program.send_signal(signal.SIGKILL)
    return place


def test_a_never_saved_project_that_is_killed_is_offered_again() -> None:
    """It is found, told apart by what it holds, and taken up without a place; undo goes back to the empty project."""
    place = killed()
    (work,) = recovery.never_saved()
    assert work.document.name == "filmed"
    session = recovery.take_up(work)
    assert session.folder.path == place
    assert not session.titled
    assert session.history.modified
    assert not recovery.never_saved(), "it is open now"
    session.undo()
    assert session.document.name == "Untitled"
    session.close()
    assert not place.exists()


def test_work_taken_up_and_killed_again_is_offered_again() -> None:
    """Taking work up writes it as this run's autosave before the old file goes."""
    killed()
    (work,) = recovery.never_saved()
    session = recovery.take_up(work)
    session.runner.close()
    session._lock.let_go()
    (again,) = recovery.never_saved()
    assert again.document == work.document


def test_never_saved_work_is_thrown_away_with_its_place() -> None:
    """Nothing of it is left."""
    place = killed()
    (work,) = recovery.never_saved()
    recovery.throw_away(work)
    assert not place.exists()
    assert not recovery.never_saved()


def test_unsaved_work_of_a_saved_project_waits_for_an_answer(tmp_path: Path) -> None:
    """New autosaves, saves and closings leave it alone; it is offered until it is recovered or thrown away."""
    Session.new(tmp_path / "film").close()
    killed(str(tmp_path / "film"))
    with closing(Session.open(tmp_path / "film")) as session:
        assert session.document.name == "film"
        (work,) = recovery.pending(session)
        session.apply(scene.rename(session.document, "other"))
        session.autosave()
        session.save()
        session.forget_autosave()
    with closing(Session.open(tmp_path / "film")) as session:
        (work,) = recovery.pending(session)
        assert work.document.name == "filmed"
        recovery.recover(session, work)
        assert session.document.name == "filmed"
        assert session.undo().label == "Recover unsaved work"
        assert session.document.name == "other"
        assert not work.file.exists()
        session.forget_autosave()
    with closing(Session.open(tmp_path / "film")) as session:
        assert not recovery.pending(session)


def test_two_crashes_are_two_offers(tmp_path: Path) -> None:
    """The newest comes first, and each is thrown away alone."""
    Session.new(tmp_path / "film").close()
    for name in ("first", "second"):
        session = Session.open(tmp_path / "film")
        recovery.pending(session)
        session.apply(scene.rename(session.document, name))
        session.autosave()
        session.runner.close()
        session._lock.let_go()
        time.sleep(0.02)
    with closing(Session.open(tmp_path / "film")) as session:
        newest, oldest = recovery.pending(session)
        assert [newest.document.name, oldest.document.name] == ["second", "first"]
        recovery.throw_away(newest)
        assert [each.document.name for each in recovery.pending(session)] == ["first"]
    assert (tmp_path / "film.motionwright").is_dir()


def test_a_project_open_elsewhere_offers_nothing(tmp_path: Path) -> None:
    """What another window has not saved yet is its own; the second window knows that it is not alone."""
    with closing(Session.new(tmp_path / "film")) as first:
        first.apply(scene.rename(first.document, "here"))
        first.autosave()
        with closing(Session.open(tmp_path / "film")) as second:
            assert first.alone
            assert not second.alone
            assert not recovery.pending(second)
            second.apply(scene.rename(second.document, "there"))
            assert not second.autosave()
            second.forget_autosave()
        assert first.folder.autosave_file.exists()
    assert not in_use(tmp_path / "film.motionwright")


def test_places_without_work_are_swept() -> None:
    """A run that was killed before anything was done leaves a place that is gone a day later."""
    session = Session.new()
    session.runner.close()
    session._lock.let_go()
    place = session.folder.path
    assert not recovery.never_saved()
    assert place.exists()
    day = time.time() - 2 * recovery.ABANDONED
    os.utime(place, (day, day))
    assert not recovery.never_saved()
    assert not any(unsaved_folder().iterdir())


def test_what_it_holds() -> None:
    """Work is told apart by its counts."""
    document = start()
    assert recovery.what_it_holds(document) == document.name
    document = tracks.add_track(document, 0, (5, 5), name="paw").document
    document = tracks.add_track(document, 1, (5, 9), name="hoof").document
    assert recovery.what_it_holds(document) == f"{document.name}: 2 points, 2 clicks"
