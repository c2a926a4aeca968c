"""Media in the window: drops that say what they will do, files that moved, copying them into the project."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton

from app.actions import bringing
from app.actions.session import Session
from app.formats import write_mesh, write_video
from app.formats.images import write_image
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
PLAIN = Qt.KeyboardModifier.NoModifier
COPY = Qt.DropAction.CopyAction
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


def noise(frames: int = 8) -> list[np.ndarray]:
    """Frames of noise that moves by a pixel a frame."""
    picture = np.random.default_rng(0).integers(40, 215, (90, 172, 3), np.uint8)
    return [np.ascontiguousarray(picture[:, t : t + 160]) for t in range(frames)]


@pytest.fixture
def empty(open_shell: Callable[[Session], Shell], qapp: QApplication) -> Shell:
    """The window on an empty project."""
    return open_shell(Session.new())


def data_of(*paths: Path) -> QMimeData:
    """What is dragged."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    return data


def hang(shell: Shell, data: QMimeData) -> None:
    """Drag something over the window."""
    event = QDragEnterEvent(QPoint(300, 300), COPY, data, LEFT, PLAIN)
    QApplication.sendEvent(shell, event)
    assert event.isAccepted()


def fall(shell: Shell, data: QMimeData) -> None:
    """Let it fall; Qt lets only that fall which has hung over the window."""
    hang(shell, data)
    QApplication.sendEvent(shell, QDropEvent(QPointF(300, 300), COPY, data, LEFT, PLAIN))
    settle()


def test_a_drop_says_what_it_will_do(empty: Shell, tmp_path: Path) -> None:
    """Video, mesh, folders of pictures and of meshes, and what cannot be used, one sentence each."""
    write_video(tmp_path / "dog.mp4", noise(), 25)
    write_mesh(tmp_path / "wolf.ply", CORNERS, FACES)
    for folder, suffix in (("stills", "png"), ("takes", "obj")):
        (tmp_path / folder).mkdir()
        for number in range(3):
            (tmp_path / folder / f"{number}.{suffix}").touch()
    (tmp_path / "notes.txt").touch()
    names = ("dog.mp4", "wolf.ply", "stills", "takes", "notes.txt")
    hang(empty, data_of(*(tmp_path / name for name in names)))
    assert empty.drops.isVisible()
    assert [text for _, text in empty.drops.lines] == [
        "Use dog.mp4 as the clip",
        "Add wolf.ply as a character",
        "Use stills as the clip, a folder of pictures",
        "Add takes as a sequence, a folder of meshes",
        "notes.txt is nothing that can be used here",
    ]
    QApplication.sendEvent(empty, QDragLeaveEvent())
    assert not empty.drops.isVisible()
    assert empty.project.document.clip is None


def test_a_project_is_opened_and_only_one(shell: Shell, tmp_path: Path) -> None:
    """Of two projects the first is opened, which is said before."""
    for name in ("one", "two"):
        Session.new(tmp_path / name).close()
    data = data_of(*(tmp_path / f"{name}.motionwright" for name in ("one", "two")))
    hang(shell, data)
    assert shell.drops.lines[0][1] == "Open the project one"
    assert "One project at a time" in shell.drops.lines[1][1]
    fall(shell, data)
    assert not shell.drops.isVisible()
    assert shell.project.document.name == "one"


def test_several_files_fall_at_once(empty: Shell, tmp_path: Path) -> None:
    """A folder of pictures becomes the clip, two meshes two characters; each can be undone."""
    (tmp_path / "stills").mkdir()
    for number, picture in enumerate(noise(5)):
        write_image(tmp_path / "stills" / f"{number}.png", picture)
    for name in ("wolf", "fox"):
        write_mesh(tmp_path / f"{name}.ply", CORNERS, FACES)
    fall(empty, data_of(tmp_path / "stills", tmp_path / "wolf.ply", tmp_path / "fox.ply"))
    wait_for(lambda: empty.project.document.clip is not None)
    assert empty.project.frame_count == 5
    assert [each.name for each in empty.project.document.characters] == ["wolf", "fox"]
    hang(empty, data_of(tmp_path / "stills"))
    assert empty.drops.lines[0][1] == "Use stills as the clip instead of stills, a folder of pictures"
    empty.drops.leave()


def test_a_folder_of_meshes_becomes_a_sequence(empty: Shell, tmp_path: Path) -> None:
    """Frames of varying topology go to the Motion graph."""
    (tmp_path / "takes").mkdir()
    for number in range(4):
        extra = [[0.5, 0.5, 0.5 + number]] * (number % 2)
        write_mesh(tmp_path / "takes" / f"{number}.ply", np.array([*CORNERS, *extra]), FACES)
    fall(empty, data_of(tmp_path / "takes"))
    wait_for(lambda: empty.project.document.sequences)
    assert empty.workspace == "performance"
    assert empty.project.document.sequences[0].source_count == 4


@pytest.fixture
def moved(tmp_path: Path) -> Path:
    """A project whose clip and mesh were moved to another folder beside it."""
    (tmp_path / "shoot").mkdir()
    write_video(tmp_path / "shoot" / "dog.mp4", noise(), 25)
    write_mesh(tmp_path / "shoot" / "wolf.ply", CORNERS, FACES)
    session = Session.new(tmp_path / "walk")
    bringing.add_clip(session, tmp_path / "shoot" / "dog.mp4")
    bringing.add_character(session, tmp_path / "shoot" / "wolf.ply", up="z")
    session.save()
    session.close()
    (tmp_path / "shoot").rename(tmp_path / "takes")
    return session.folder.path


def test_moved_media_are_offered_where_they_lie(open_shell: Callable[[Session], Shell], moved: Path) -> None:
    """One click on what was found takes its neighbour along; the picture appears; undo knows both."""
    shell = open_shell(Session.open(moved))
    notices = shell.care.notices
    wait_for(lambda: len(notices.open) == 2)
    first = next(iter(notices.open.values()))
    assert "dog.mp4 (the clip) is not where it was" in first.sentence.text()
    assert "takes" in first.sentence.text()
    QTest.mouseClick(first.buttons["Use it"], LEFT)
    wait_for(lambda: not notices.open)
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    assert shell.project.document.characters[0].mesh.path.endswith("takes/wolf.ply")
    assert not shell.video.errors.isVisible()
    labels = [version.label for version in shell.project.session.history.versions]
    assert labels[-2:] == ["Find the clip again", "Find wolf again"]


def test_moved_media_are_shown_by_hand(
    open_shell: Callable[[Session], Shell], moved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Far away they are not found; a wrong file is refused in words and asked for again; the right one is taken."""
    far = tmp_path / "a" / "b" / "c" / "d"
    far.mkdir(parents=True)
    (tmp_path / "takes").rename(far / "takes")
    write_video(tmp_path / "long.mp4", noise(12), 25)
    shell = open_shell(Session.open(moved))
    notices = shell.care.notices
    wait_for(lambda: len(notices.open) == 2)
    name, first = next(iter(notices.open.items()))
    assert "Use it" not in first.buttons
    monkeypatch.setattr("app.window.files.ask_medium", lambda *_: tmp_path / "long.mp4")
    QTest.mouseClick(first.buttons["Find it…"], LEFT)
    assert "another clip" in shell.video.errors.sentence.text()
    wait_for(lambda: name in notices.open)
    monkeypatch.setattr("app.window.files.ask_medium", lambda *_: far / "takes" / "dog.mp4")
    QTest.mouseClick(notices.open[name].buttons["Find it…"], LEFT)
    wait_for(lambda: not notices.open)
    wait_for(lambda: not shell.video.canvas.picture.isNull())


def test_media_are_copied_in_when_wanted(empty: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Save as leaves a linked clip where it is and asks; the copy is made in the background, one entry, and saved."""
    write_video(tmp_path / "dog.mp4", noise(), 25)
    fall(empty, data_of(tmp_path / "dog.mp4"))
    monkeypatch.setattr("app.window.files.ask_place", lambda *_: tmp_path / "walk")
    QTest.keyClick(empty, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    notice = empty.care.notices.open["collect"]
    assert "dog.mp4 stays where it is" in notice.sentence.text()
    answer = next(text for text in notice.buttons if text.startswith("Copy into the project"))
    QTest.mouseClick(notice.buttons[answer], LEFT)
    wait_for(lambda: not empty.project.document.clip.media.linked)
    assert not empty.isWindowModified()
    assert empty.project.session.history.undo_label == "Copy media into the project"
    assert (tmp_path / "walk.motionwright" / "media" / "dog.mp4").is_file()
    monkeypatch.setattr("app.window.files.ask_place", lambda *_: tmp_path / "other")
    empty.do("save_as_whole")
    wait_for(lambda: not empty.project.progress)
    assert (tmp_path / "other.motionwright" / "media" / "dog.mp4").is_file()


def test_many_media_are_copied_with_a_bar(
    empty: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qapp: QApplication
) -> None:
    """Saving elsewhere waits behind a bar; Cancel leaves no project there and the work unsaved."""
    write_video(tmp_path / "dog.mp4", noise(), 25)
    fall(empty, data_of(tmp_path / "dog.mp4"))
    empty.do("collect")
    wait_for(lambda: not empty.project.document.clip.media.linked)
    monkeypatch.setattr("app.window.file_commands.LARGE", 0)
    monkeypatch.setattr("app.window.waiting.PATIENCE", 0)
    monkeypatch.setattr("app.window.files.ask_place", lambda *_: tmp_path / "walk")
    cancelling = QTimer()

    def cancel() -> None:
        bar = qapp.activeModalWidget()
        if bar is not None:
            QTest.mouseClick(bar.findChild(QPushButton), LEFT)

    def endless(source: Path, target: Path, progress: Callable[[float], None]) -> None:
        target.mkdir(parents=True)
        while True:
            progress(0.5)
            time.sleep(0.01)

    cancelling.timeout.connect(cancel)
    cancelling.start(20)
    with monkeypatch.context() as patched:
        patched.setattr("app.actions.session.copy_files", endless)
        assert not empty.files.save()
    cancelling.stop()
    assert not (tmp_path / "walk.motionwright").exists()
    assert empty.isWindowModified()
    assert empty.files.save()
    assert (tmp_path / "walk.motionwright" / "media" / "dog.mp4").is_file()
    assert not empty.isWindowModified()
