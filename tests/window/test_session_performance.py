"""A whole session with captured takes: from an empty window to an exported performance, by mouse and keys alone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.actions.performing_frames import performance_frames
from app.actions.session import Session
from app.formats.tvm import open_mesh_frames
from app.window.performance.blocks import box
from app.window.performance.export_dialog import ExportDialog
from app.window.shell import Shell
from app.window.timeline.lanes import RULER
from tests.window.conftest import drag, settle, wait_for
from tests.window.performing_hands import JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands
from tests.window.session_hands import CONTROL, Hands
from tests.window.small_performance import FPS, write_take

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
PLAIN = Qt.KeyboardModifier.NoModifier


def drop_on(widget: QWidget, path: Path) -> None:
    """Drop a file or folder on a part of the window."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    place, action = QPoint(widget.width() // 2, 40), Qt.DropAction.CopyAction
    enter = QDragEnterEvent(place, action, data, LEFT, PLAIN)
    QApplication.sendEvent(widget, enter)
    assert enter.isAccepted(), f"{path.name} is not taken"
    QApplication.sendEvent(widget, QDropEvent(QPointF(place), action, data, LEFT, PLAIN))


def test_from_an_empty_window_to_an_exported_performance(
    open_shell: Callable[[Session], Shell], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Drop takes, say the rate, compose, reorder, repeat, forbid, play, undo all, save, export, open again."""
    monkeypatch.setenv("HOME", str(tmp_path))
    walk, gym = write_take(tmp_path, "Walk", "ply"), write_take(tmp_path, "Gym")
    shell = open_shell(Session.new())
    hands, page = PerformingHands(shell), shell.performance
    state = page.state
    QTest.keyClick(shell, Qt.Key.Key_F3)
    assert page.graph.nothing.add.isVisible()

    drop_on(page.library, walk)
    wait_for(lambda: len(state.document.sequences) == 1, 30)
    assert "fps" in state.document.sequences[0].guessed, "a folder of meshes says no rate"
    settle(50)
    QTest.mouseClick(page.library.sections[0].head, LEFT)
    settle(50)
    rate = page.library.facts.rate
    QTest.mouseClick(rate, LEFT)
    QTest.keyClicks(rate, str(FPS))
    QTest.keyClick(rate, Qt.Key.Key_Return)
    drop_on(page.library, gym)
    wait_for(lambda: len(state.document.sequences) == 2, 30)
    wait_for(lambda: len(state.motions) == 4 and len(hands.canvas.picture.nodes) == 4, 120)
    assert [sequence.fps for sequence in state.document.sequences] == [FPS, FPS]
    settle(50)

    hands.compose(WALK, JACK, SQUAT)
    QTest.mouseClick(hands.lane, LEFT, pos=hands.on_button(0, 1))
    hands.found()
    _, right = box(hands.block(2), hands.lane.axis)
    drag(hands.lane, hands.on_block(1), (right - 4, RULER + 20.0))
    assert hands.keys == [WALK, SQUAT, JACK]
    hands.found()
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: page.composed.note.isVisible(), 30)
    QTest.mouseClick(page.composed.note.use, LEFT)
    hands.found()
    assert MARCH not in state.performance.path
    assert state.document.performance.mu > 0.9
    composed = state.document.performance

    wait_for(lambda: state.placed is not None and state.blends is not None, 120)
    settle(50)
    cuts = [joint for joint in hands.lane.shown.joints if joint.kind == "cut"]
    assert len(cuts) == len(state.performance.path) - 1
    assert all(joint.score is not None and joint.after < joint.before for joint in cuts)

    wait_for(lambda: page.preview.shown >= 0, 60)
    hands.press(Qt.Key.Key_Home)
    hands.press(Qt.Key.Key_Space)
    wait_for(lambda: page.preview.shown >= 10, 30)
    hands.press(Qt.Key.Key_Space)
    assert not state.playback.playing

    steps = shell.project.session.history.present
    for _ in range(steps):
        hands.press(Qt.Key.Key_Z, CONTROL)
    assert not state.document.sequences
    assert page.graph.nothing.add.isVisible()
    for _ in range(steps):
        hands.press(Qt.Key.Key_Y, CONTROL)
    assert state.document.performance == composed
    hands.found()
    wait_for(lambda: state.blends is not None, 120)

    target = tmp_path / "moves.motionwright"
    Hands(shell).answer(target, lambda: QTest.keyClick(shell, Qt.Key.Key_S, CONTROL))
    assert shell.project.session.titled
    assert not shell.project.session.history.modified

    QTest.keyClick(shell, Qt.Key.Key_E, CONTROL)
    settle(50)
    dialog = page.findChild(ExportDialog)
    wait_for(lambda: not dialog._still.startswith("Looking"), 30)
    dialog.place.setFocus()
    dialog.place.selectAll()
    QTest.keyClicks(dialog.place, str(tmp_path / "performance"))
    said: list[str] = []
    dialog.done.connect(said.append)
    QTest.mouseClick(dialog.export_button, LEFT)
    wait_for(lambda: said, 120)

    expected = performance_frames(shell.project.session)
    with open_mesh_frames(tmp_path / "performance") as frames:
        assert len(frames) == len(expected) == state.frame_count
        assert float(frames.fps or 0) in (0.0, FPS)
        for position in (0, len(expected) // 2, len(expected) - 1):
            written, meant = frames[position], expected[position]
            assert written.vertices.shape == meant.vertices.shape
            assert np.abs(written.vertices - meant.vertices).max() < 1e-4
            assert written.colours is not None
    length = state.frame_count
    shell.close()

    again = open_shell(Session.open(target))
    QTest.keyClick(again, Qt.Key.Key_F3)
    page = again.performance
    wait_for(lambda: page.state.placed is not None, 60)
    assert page.state.frame_count == length
    assert page.state.document.performance == composed
    settle(50)
    assert page.composed.view.shown.blocks
