"""The document in the window: title, places, unsaved work, media that moved, what cannot be written or read."""

from __future__ import annotations

import errno
import json
import shutil
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions import recovery
from app.actions.session import Session
from app.formats import atomic
from app.model.edits import scene
from app.storage.migrations import VERSION
from app.window import application, files, settings
from app.window.settings_dialog import SettingsDialog
from app.window.shell import Shell
from imitation.progress import Progress
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


def abandon(session: Session) -> Path:
    """End a session as a killed program does: its autosave stays, nobody is told; gives its folder."""
    session.autosave()
    session.runner.close()
    session.media.close()
    session._lock.let_go()
    return session.folder.path


def click(shell: Shell, name: str, answer: str) -> None:
    """Answer a question of the window."""
    QTest.mouseClick(shell.care.notices.open[name].buttons[answer], LEFT)
    settle()


def test_the_title_names_the_project_and_marks_changes(shell: Shell) -> None:
    """The window's title follows name, edits, undo and saving."""
    assert shell.windowTitle().startswith("small[*]")
    assert not shell.isWindowModified()
    shell.project.edit(scene.rename, "trot")
    assert shell.windowTitle().startswith("trot[*]")
    assert shell.isWindowModified()
    QTest.keyClick(shell, Qt.Key.Key_S, CONTROL)
    assert not shell.isWindowModified()
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert shell.windowTitle().startswith("small[*]")
    assert shell.isWindowModified()


def test_unsaved_work_of_a_project_is_a_question(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """The saved project opens; Recover brings the work as one entry, Undo takes it back; asked once only."""
    place = session.folder.path
    session.apply(scene.rename(session.document, "unsaved"))
    abandon(session)
    shell = open_shell(Session.open(place))
    assert shell.project.document.name == "small"
    (name,) = shell.care.notices.open
    assert "unsaved" in shell.care.notices.open[name].sentence.text()
    assert shell.care.notices.isVisible()
    click(shell, name, "Recover")
    assert shell.project.document.name == "unsaved"
    assert shell.isWindowModified()
    assert not shell.care.notices.isVisible()
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert shell.project.document.name == "small"


def test_later_means_later(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """Saved over and closed meanwhile, the work is offered again; thrown away takes two clicks and is for good."""
    place = session.folder.path
    session.apply(scene.rename(session.document, "unsaved"))
    abandon(session)
    shell = open_shell(Session.open(place))
    (name,) = shell.care.notices.open
    click(shell, name, "Later")
    assert not shell.care.notices.open
    shell.project.edit(scene.rename, "meanwhile")
    QTest.keyClick(shell, Qt.Key.Key_S, CONTROL)
    shell.files.open(place)
    assert shell.project.document.name == "meanwhile"
    (name,) = shell.care.notices.open
    click(shell, name, "Throw away")
    click(shell, name, "Keep it")
    click(shell, name, "Throw away")
    click(shell, name, "Throw away for good")
    assert not shell.care.notices.open
    shell.files.open(place)
    assert not shell.care.notices.open


def test_a_project_without_a_place_is_offered_again(open_shell: Callable[[Session], Shell], qapp: QApplication) -> None:
    """What was never saved comes back as such: with its work, without a place, undone to the empty project."""
    for work in recovery.never_saved():
        recovery.throw_away(work)
    session = Session.new()
    session.apply(scene.rename(session.document, "first steps"))
    place = abandon(session)
    shell = open_shell(Session.new())
    shell.care.offer_never_saved()
    (name,) = shell.care.notices.open
    assert "first steps" in shell.care.notices.open[name].sentence.text()
    click(shell, name, "Recover")
    assert shell.project.session.folder.path == place
    assert shell.project.document.name == "first steps"
    assert "not saved yet" in shell.bar.state.text()
    assert not shell.care.notices.open
    shell.close()
    assert not place.exists(), "closed by the person, who did not want to save"


def test_a_project_open_elsewhere_is_told(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """The second window says so and writes no autosave over the first one's."""
    second = open_shell(Session.open(session.folder.path))
    assert "open in another window" in second.care.notices.open["alone"].sentence.text()
    second.project.edit(scene.rename, "here too")
    session.apply(scene.rename(session.document, "there"))
    session.autosave()
    autosaved = session.folder.autosave_file.read_bytes()
    second.files.autosave()
    second.close()
    assert session.folder.autosave_file.read_bytes() == autosaved
    session.close()


def test_a_folder_that_cannot_be_written(shell: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Saving says so in a sentence and offers another place; nothing is lost."""

    def refused(descriptor: int) -> None:
        raise OSError(errno.EACCES, "Permission denied")

    shell.project.edit(scene.rename, "trot")
    with monkeypatch.context() as patched:
        patched.setattr(atomic.os, "fsync", refused)
        QTest.keyClick(shell, Qt.Key.Key_S, CONTROL)
        sentence = shell.care.notices.open["save"].sentence.text()
        assert "not saved" in sentence
        assert "Permission denied" in sentence
        shell.files.autosave()
        shell.files.autosave()
        assert "cannot be kept" in shell.care.notices.open["autosave"].sentence.text()
    assert shell.isWindowModified()
    monkeypatch.setattr("app.window.files.ask_place", lambda *_: tmp_path / "elsewhere")
    click(shell, "save", "Save as…")
    assert not shell.isWindowModified()
    assert Session.open(tmp_path / "elsewhere").document.name == "trot"
    assert not shell.care.notices.open


def test_older_projects_open_and_newer_ones_are_refused(shell: Shell, session: Session, tmp_path: Path) -> None:
    """A newer format is one sentence and the open project stays; an older one opens."""
    for name, version in (("newer", VERSION + 1), ("older", 1)):
        copy = tmp_path / f"{name}.motionwright"
        shutil.copytree(session.folder.path, copy)
        body = json.loads((copy / "project.json").read_text())
        body["version"] = version
        body["document"]["name"] = name
        if version == 1:
            for later in ("depth_tracks", "pitch", "roll", "height", "seen"):
                body["document"]["world"].pop(later, None)
        (copy / "project.json").write_text(json.dumps(body))
    shell.files.open(tmp_path / "newer.motionwright")
    assert shell.project.document.name == "small"
    assert "newer Motionwright" in shell.video.errors.sentence.text()
    shell.files.open(tmp_path / "older.motionwright")
    assert shell.project.document.name == "older"


def test_projects_opened_lately(
    shell: Shell, session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The menu and the welcome list them, with a picture after saving; what is gone is not listed; a click opens."""
    QTest.keyClick(shell, Qt.Key.Key_S, CONTROL)
    place = session.folder.path
    assert settings.thumbnail_of(place).is_file()
    gone = Session.new(tmp_path / "gone")
    settings.remember_project(gone.folder.path)
    gone.close()
    shutil.rmtree(gone.folder.path)
    menu = shell.bar.menu_button.menu()
    menu.aboutToShow.emit()
    recent = next(action.menu() for action in menu.actions() if action.text() == "Open recent")
    assert recent.actions()[0].text() == place.stem
    assert "gone" not in [action.text() for action in recent.actions()]
    shell.files.new()
    settle()
    assert shell.pages.welcoming
    assert shell.welcome.cards[0].text().startswith(place.stem)
    assert "today" in shell.welcome.cards[0].text()
    QTest.mouseClick(shell.welcome.cards[0], LEFT)
    assert shell.project.session.folder.path == place


def test_settings_are_in_force_and_remembered(shell: Shell) -> None:
    """Autosave, memory and look are taken at once; the 3D drawing at the next start; all are kept."""
    QTest.keyClick(shell, Qt.Key.Key_Comma, CONTROL)
    dialog = shell.findChild(SettingsDialog)
    assert dialog is not None
    wait_for(lambda: dialog.size.text().endswith("MB"))
    for box, text in ((dialog.autosave, "15 seconds"), (dialog.memory, "512 MB"), (dialog.viewport, "Processor alone")):
        box.setFocus()
        QTest.keyClicks(box, text[:4])
        box.activated.emit(box.currentIndex())
        assert box.currentText() == text
    assert shell.care.autosaver.interval() == 15_000
    assert shell.project.session.cache.budget == 512 << 20
    assert "starts again" in dialog.note.text()
    assert (settings.autosave_seconds(), settings.memory_megabytes(), settings.viewport()) == (15, 512, "raster")
    settings.settings().setValue("autosave", "often")
    assert settings.autosave_seconds() == 60
    for name in ("autosave", "memory", "viewport"):
        settings.settings().remove(name)
    wait_for(dialog.clear.isEnabled)
    QTest.mouseClick(dialog.clear, LEFT)
    wait_for(lambda: dialog.size.text() == "0 MB")
    QTest.mouseClick(dialog.close_button, LEFT)
    settle()
    assert shell.findChild(SettingsDialog) is None


@pytest.mark.parametrize("at_start", [False, True])
def test_beside_a_damaged_project_its_autosave_opens_as_a_copy(
    open_shell: Callable[[Session], Shell], session: Session, monkeypatch: pytest.MonkeyPatch, at_start: bool
) -> None:
    """The sentence has a button; the copy has no place, finds media and results, and leaves the project as it is."""
    place = session.folder.path
    (character,) = session.document.characters
    session.result(session.stages.animation(character.id))
    before = {file: file.read_bytes() for file in session.folder.results.rglob("*") if file.is_file()}
    session.apply(scene.rename(session.document, "what I did last"))
    abandon(session)
    (place / "project.json").write_text('{"version": 2, "na')
    if at_start:
        first, refused = application._first(place, False)
        shell = open_shell(first)
        shell.care.refuse(place, refused)
    else:
        shell = open_shell(Session.new())
        shell.files.open(place)
    notice = shell.care.notices.open["damaged"]
    assert "what I did last" in notice.sentence.text()
    click(shell, "damaged", "Open the autosave as a copy")
    project = shell.project
    assert project.document.name == "what I did last"
    assert not project.session.titled
    assert shell.isWindowModified()
    assert len(project.document.tracks) == len(session.document.tracks)
    assert project.state(project.session.stages.animation(character.id)) == "fresh", "it is solved anew"
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    assert project.session.media.locate(project.document.characters[0].mesh).is_file()
    assert (place / "project.json").read_text() == '{"version": 2, "na'
    assert (place / "autosave.json").is_file()
    assert {file: file.read_bytes() for file in before} == before
    assert "lost" not in " ".join(shell.care.notices.open)
    project.cancel_work()
    wait_for(lambda: not project.progress)


def test_a_damaged_project_alone_is_told(open_shell: Callable[[Session], Shell], tmp_path: Path) -> None:
    """Without an autosave that can be read there is a sentence, and nothing to press."""
    place = tmp_path / "broken.motionwright"
    place.mkdir()
    (place / "project.json").write_text("{")
    (place / "autosave.json").write_text("{")
    shell = open_shell(Session.new())
    shell.files.open(place)
    assert shell.pages.errors.sentence.text()
    assert not shell.care.notices.open


def test_saving_elsewhere_does_not_stop_what_is_written(
    shell: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While a file is being written it is asked what shall be done first; done, or stopped, the project is saved."""
    here = shell.project.session.folder.path
    for number, answer, ended in ((1, "Save when it is done", "done"), (2, "Stop it and save now", "cancelled")):
        target = tmp_path / f"elsewhere {number}.motionwright"
        monkeypatch.setattr(files, "ask_place", lambda *_, target=target: target)
        go_on = threading.Event()

        def write(progress: Progress, go_on: threading.Event = go_on) -> str:
            while not go_on.is_set():
                progress(0.5)
                time.sleep(0.01)
            return "film.mp4"

        job = shell.project.call("Rendering film.mp4", write)
        QTest.keyClick(shell, Qt.Key.Key_S, CONTROL | Qt.KeyboardModifier.ShiftModifier)
        assert "Rendering film.mp4" in shell.care.notices.open["writing"].sentence.text()
        assert shell.project.session.folder.path == here
        assert job.state == "running"
        click(shell, "writing", answer)
        settle(100)
        if answer.startswith("Save when"):
            assert shell.project.session.folder.path == here
            go_on.set()
        wait_for(lambda target=target: shell.project.session.folder.path == target)
        assert job.state == ended
        here = target
    assert json.loads((here / "project.json").read_text())["document"]["name"] == "small"
    assert not shell.isWindowModified()
