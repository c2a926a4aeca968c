"""The window as a whole: opening, saving, dropping, errors, closing in the midst of work, sizes."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel

from app.actions.session import Session
from app.formats import write_mesh, write_video
from app.window import theme
from app.window.key_sheet import KeySheet
from app.window.shell import Shell
from tests.window.clipping import assert_nothing_clipped
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
CONTROL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def empty(open_shell: Callable[[Session], Shell], qapp: QApplication) -> Shell:
    """The window on an empty project."""
    return open_shell(Session.new())


@pytest.fixture
def noise_clip(tmp_path: Path) -> Path:
    """A video of 12 frames of noise that moves by a pixel a frame."""
    picture = np.random.default_rng(0).integers(40, 215, (90, 172, 3), np.uint8)
    path = tmp_path / "noise.mp4"
    write_video(path, [np.ascontiguousarray(picture[:, t : t + 160]) for t in range(12)], 25)
    return path


def drop(shell: Shell, path: Path) -> None:
    """Drop a file on the window."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    event = QDropEvent(QPointF(300, 300), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier)
    shell.dropEvent(event)


def test_an_empty_project_invites(empty: Shell) -> None:
    """One sentence, one primary button; no timeline, nothing that cannot be used."""
    assert empty.pages.currentWidget() is empty.welcome
    assert empty.welcome.open.property("primary") == "true"
    assert not empty.timeline.isVisible()
    assert not empty.bar.undo.isEnabled()


def test_a_dropped_video_opens_and_undo_takes_it_away(empty: Shell, noise_clip: Path) -> None:
    """The picture appears in the Video workspace; undo goes back to the welcome."""
    drop(empty, noise_clip)
    wait_for(lambda: not empty.video.canvas.picture.isNull())
    assert empty.pages.currentWidget() is empty.video
    assert empty.project.frame_count == 12
    assert empty.timeline.isVisible()
    while empty.project.session.history.undo_label is not None:
        empty.do("undo")
    settle()
    assert empty.pages.currentWidget() is empty.welcome


def test_a_dropped_mesh_becomes_a_character(empty: Shell, tmp_path: Path) -> None:
    """The Character workspace shows the mesh, standing, before anything is paired."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    write_mesh(tmp_path / "thing.ply", vertices, faces)
    drop(empty, tmp_path / "thing.ply")
    assert empty.workspace == "character"
    wait_for(lambda: empty.character.mesh.viewport is not None and len(empty.character.mesh.viewport.vertices) == 4)
    assert empty.project.document.characters[0].name == "thing"


def test_what_cannot_be_used_is_said_in_one_sentence(empty: Shell, tmp_path: Path) -> None:
    """A text file and a broken video: a bar, no box, the project as it was."""
    (tmp_path / "notes.txt").write_text("hello")
    (tmp_path / "broken.mp4").write_bytes(b"no video at all")
    for name in ("notes.txt", "broken.mp4"):
        drop(empty, tmp_path / name)
        bar = empty.welcome.errors
        assert bar.isVisible()
        assert bar.sentence.text().count(".") >= 1
        assert name.split(".")[0] in bar.sentence.text()
        bar.hide()
    assert empty.project.document.clip is None


def test_save_and_open_again(empty: Shell, noise_clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl+S asks once for a place; the state says saved; the project opens with the same document."""
    drop(empty, noise_clip)
    assert "not saved" in empty.bar.state.text()
    monkeypatch.setattr("app.window.files.ask_place", lambda *_: tmp_path / "mine")
    QTest.keyClick(empty, Qt.Key.Key_S, CONTROL)
    assert "saved" in empty.bar.state.text()
    document = empty.project.document
    empty.project.edit(__import__("app.model.edits.scene", fromlist=["rename"]).rename, "Other")
    assert "unsaved" in empty.bar.state.text()
    QTest.keyClick(empty, Qt.Key.Key_Z, CONTROL)
    assert "unsaved" not in empty.bar.state.text()
    path = empty.project.session.folder.path
    empty.files.open(path)
    settle()
    assert empty.project.document == document


def test_unsaved_changes_are_asked_about(empty: Shell, noise_clip: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stay keeps the window and the project."""
    drop(empty, noise_clip)
    asked: list[str] = []
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda _, name: asked.append(name) or "stay")
    empty.close()
    assert asked
    assert empty.isVisible()
    assert empty.project is not None
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda *_: "discard")


def test_discarded_work_does_not_come_back(
    open_shell: Callable[[Session], Shell], noise_clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Work that was autosaved and then not wanted is not recovered at the next start."""
    shell = open_shell(Session.new(tmp_path / "film"))
    drop(shell, noise_clip)
    shell.files.autosave()
    assert shell.project is not None
    assert shell.project.session.folder.recoverable() is not None
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda *_: "discard")
    shell.close()
    again = Session.open(tmp_path / "film", recover=True)
    assert again.document.clip is None
    assert again.history.undo_label is None
    again.close()


def test_work_is_seen_and_can_be_cancelled(shell: Shell) -> None:
    """A new point starts work: the chip shows it; its cancel button stops it within a moment."""
    shell.do("tool_point")
    QTest.mouseClick(shell.video.canvas, LEFT, pos=QPoint(300, 200))
    assert shell.project.progress
    assert shell.bar.job.isVisible()
    assert shell.bar.job_text.text()
    shell.do("cancel_work")
    wait_for(lambda: not shell.project.progress, 5)
    assert not shell.bar.job.isVisible()
    assert not shell.video.errors.isVisible(), "a cancelled job is no error"


def test_closing_in_the_midst_of_work_is_safe(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """The window closes while points are being followed; no thread is left (checked by the fixture)."""
    shell = open_shell(session)
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    shell.do("tool_point")
    for x in (250, 300, 350):
        QTest.mouseClick(shell.video.canvas, LEFT, pos=QPoint(x, 200))
    shell.close()
    assert not shell.isVisible()


def test_a_failed_job_is_one_sentence_with_details(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of the program in a stage: a bar with a sentence, the trace folded away."""

    def fail(*_: object, **__: object) -> object:
        raise RuntimeError("boom")

    monkeypatch.setattr("imitation.tracking.track_span", fail)
    shell.do("tool_point")
    QTest.mouseClick(shell.video.canvas, LEFT, pos=QPoint(300, 200))
    wait_for(lambda: shell.video.errors.isVisible(), 30)
    assert "Traceback" not in shell.video.errors.sentence.text()
    assert "boom" in shell.video.errors.details.toPlainText()


def test_tabs_and_keys_switch_workspaces(shell: Shell) -> None:
    """F2 and the tab show the Character workspace, the frame stays; F1 goes back."""
    shell.project.show_frame(7)
    wait_for(lambda: shell.video.frame == 7)
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: shell.character.frame == 7)
    assert shell.bar.tabs["character"].isChecked()
    assert shell.timeline.lanes.frame == 7
    QTest.mouseClick(shell.bar.tabs["video"], LEFT)
    assert shell.pages.currentWidget() is shell.video


def test_undo_button_names_what_it_takes_back(shell: Shell) -> None:
    """The tooltip says the entry; a moved history says where it shows."""
    track = shell.project.document.tracks[0]
    from app.model.edits import tracks

    shell.project.edit(tracks.rename_track, track.id, "muzzle")
    assert "muzzle" in shell.bar.undo.toolTip()
    QTest.mouseClick(shell.bar.undo, LEFT)
    assert shell.project.document.track(track.id).name == track.name
    assert "muzzle" in shell.bar.redo.toolTip()
    assert shell.video.notes.message.startswith("Undone")


def test_light_and_dark(shell: Shell) -> None:
    """The look changes while the window is open, and back."""
    dark = shell.grab().toImage().pixelColor(700, 24).lightness()
    shell.do("light")
    settle()
    assert shell.grab().toImage().pixelColor(500, 24).lightness() > 150 > dark
    shell.do("light")
    settle()
    assert theme.active() is theme.DARK


def test_the_sheet_of_keys_shows(shell: Shell) -> None:
    """? opens a sheet that names the keys; it closes by Escape."""
    shell.do("keys")
    sheet = shell.findChild(KeySheet)
    assert sheet is not None
    assert any("Ctrl+Z" in label.text() for label in sheet.findChildren(QLabel))
    QTest.keyClick(sheet, Qt.Key.Key_Escape)
    settle()
    assert shell.findChild(KeySheet) is None


@pytest.mark.parametrize("size", [(1024, 700), (1180, 720), (1440, 900), (1920, 1080)])
@pytest.mark.parametrize("workspace", ["video", "character", "performance"])
def test_nothing_is_clipped(shell: Shell, size: tuple[int, int], workspace: str) -> None:
    """At three sizes no inspector is wider than its column and no button or label cuts its text."""
    shell.resize(*size)
    shell.project.select_track(shell.project.document.tracks[0].id)
    shell.show_workspace(workspace)
    wait_for(lambda: shell.pages.currentWidget() is shell.pages.in_sight)
    wait_for(lambda: workspace != "character" or shell.character.mesh.viewport is not None)
    settle(100)
    settle(100)
    assert_nothing_clipped(shell)


def test_every_control_says_what_it_is(shell: Shell) -> None:
    """Buttons without a text have a tooltip and a name for screen readers."""
    from PySide6.QtWidgets import QToolButton

    for each in shell.findChildren(QToolButton):
        if each.isVisibleTo(shell) and not each.text():
            assert each.toolTip(), each
            assert each.accessibleName(), each.toolTip()


def test_workspaces_never_import_each_other_and_modules_are_short() -> None:
    """The folders of the workspaces know nothing of each other; no module has more than 400 lines."""
    window = Path(__file__).resolve().parents[2] / "app" / "window"
    for name, other in itertools.permutations(("video", "character", "performance"), 2):
        for path in (window / name).glob("*.py"):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ImportFrom) and node.module:
                    assert not node.module.startswith(f"app.window.{other}"), path
    for path in window.rglob("*.py"):
        assert len(path.read_text().splitlines()) <= 400, path
    assert len((window / "shell.py").read_text().splitlines()) <= 300


def test_only_the_viewport_knows_the_3d_library() -> None:
    """The 3D library and VTK are imported in app/window/viewport alone, so that the window opens fast."""
    window = Path(__file__).resolve().parents[2] / "app" / "window"
    for path in window.rglob("*.py"):
        if path.parent.name == "viewport":
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [each.name for each in node.names] if isinstance(node, ast.Import) else []
            assert not any(name.split(".")[0] in ("pyvista", "pyvistaqt", "vtkmodules", "vtk") for name in names), path
