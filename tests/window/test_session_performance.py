"""A whole session with captured takes: from an empty window to an exported performance, by mouse and keys alone."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
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
from app.window.performance.strip import BOX
from app.window.shell import Shell
from app.window.timeline.lanes import RULER
from tests.window.conftest import at, drag, hover, settle, wait_for
from tests.window.performing_hands import JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands, give_keys
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


def take_back(hands: PerformingHands) -> None:
    """Ctrl+Z."""
    give_keys(hands.shell)
    hands.press(Qt.Key.Key_Z, CONTROL)


def correct_the_motions(hands: PerformingHands) -> None:
    """Drag a boundary of the gymnastics, then say that everything in it repeats; undo takes both back."""
    page, state = hands.page, hands.page.state
    gym = next(each for each in state.document.sequences if each.name == "Gym")
    QTest.mouseClick(page.library.cards, LEFT, pos=page.library.cards.box(gym.id).center().toPoint())
    view = page.strip.view
    wait_for(lambda: len(view.strip.boundaries) == 2)
    before = view.strip.boundaries
    x, y = view.axis.x(before[0]), RULER + BOX[0] + 10.0
    drag(view, (x, y), (view.axis.x(before[0] + 3), y))
    wait_for(lambda: view.strip.boundaries == (before[0] + 3, before[1]))
    assert "by hand" in page.strip.header.caption.text()
    wait_for(lambda: state.fresh and not hands.shell.project.progress, 60)
    assert next(m.last for m in state.motions if m.sequence == gym.id) == before[0] + 2, "the graph follows"
    take_back(hands)
    wait_for(lambda: view.strip.boundaries == before)
    fold = page.library.sections[1]
    QTest.mouseClick(fold.head, LEFT)
    settle(50)
    page.library.body.ensureWidgetVisible(page.library.structure.cyclic)
    box_ = page.library.structure.cyclic
    QTest.mouseClick(box_, LEFT, pos=QPoint(8, box_.height() // 2))
    assert state.document.sequence(gym.id).structure.force_cyclic
    wait_for(lambda: state.fresh and not hands.shell.project.progress, 60)
    assert all(motion.cyclic for motion in state.motions if motion.sequence == gym.id)
    take_back(hands)
    assert not state.document.sequence(gym.id).structure.force_cyclic
    wait_for(lambda: state.fresh and len(hands.canvas.picture.nodes) == 4 and not hands.shell.project.progress, 60)
    settle(50)
    give_keys(hands.shell)


def choose_another_size(hands: PerformingHands) -> None:
    """Drag the size of the graph: the path is lit on the way, and it is one entry in the end."""
    page, slider = hands.page, hands.page.database.slider
    entries, y = hands.shell.project.session.history.present, slider.height() / 2
    span = slider.width() - 14
    begin = 7 + span * page.state.document.performance.mu / 2
    drag(slider, (begin, y), (7 + span * 0.99, y), release=False, pause=15)
    wait_for(lambda: page.trial.result is not None and page.trial.result.path, 10)
    assert [edge for edge in hands.canvas.picture.edges if edge.kind == "path"]
    QTest.mouseRelease(slider, LEFT, pos=at(7 + span * 0.99, y))
    assert hands.shell.project.session.history.present == entries + 1
    assert page.state.document.performance.mu > 1.9
    hands.found()
    wait_for(lambda: page.trial.result is None, 30)


def choose_another_path(hands: PerformingHands) -> None:
    """The second best is a click away, and so is the best again."""
    state, chooser = hands.page.state, hands.page.composed.options.paths
    assert chooser.count() == len(state.paths) > 1
    for number in (1, 0):
        QTest.mouseClick(chooser, LEFT)
        popup = chooser.view()
        wait_for(popup.isVisible)
        settle(QApplication.doubleClickInterval() + 50)  # before that a click is taken for the end of the first one
        place = popup.visualRect(chooser.model().index(number, 0)).center()
        hover(popup.viewport(), place)
        lit = {(edge.start, edge.goal) for edge in hands.canvas.picture.edges if edge.kind == "path"}
        assert lit == set(pairwise(state.paths[number].path)), "it is lit before it is chosen"
        QTest.mouseClick(popup.viewport(), LEFT, pos=place)
        wait_for(lambda number=number: state.document.performance.alternative == number)
        hands.found()
        assert list(state.performance.path) == list(state.paths[number].path)


def want_a_length(hands: PerformingHands) -> None:
    """A number of frames is met, or the nearest is taken with the reason; then any length again."""
    options, state = hands.page.composed.options, hands.page.state
    frames = state.frame_count
    QTest.mouseClick(options.wanted, LEFT)
    QTest.mouseClick(options.frames, LEFT)
    QTest.keyClicks(options.frames, str(frames + 2))
    QTest.keyClick(options.frames, Qt.Key.Key_Return)
    assert state.document.performance.length == frames + 2
    wait_for(lambda: state.paths and (len(state.paths[0]) == frames + 2 or state.paths[0].note), 30)
    settle(50)
    assert (state.frame_count == frames + 2) == (not options.note.text())
    QTest.mouseClick(options.wanted, LEFT)
    assert state.document.performance.length is None
    hands.found()


def compare(hands: PerformingHands) -> None:
    """At a cut: as filmed the performer is elsewhere, placed it goes on, blended there are in-betweens."""
    page, state = hands.page, hands.page.state
    blend = next(blend for blend in state.blends.blends if blend.shapes)
    position = blend.cut.position
    state.show_position(position)
    seen = {}
    for mode in ("filmed", "placed", "blended"):
        QTest.mouseClick(page.preview.mode_buttons[mode], LEFT)
        wait_for(lambda: page.preview.shown == position and page.preview._count > 0)
        settle(100)
        wait_for(lambda mode=mode: page.preview.frame.blended == (mode == "blended"))
        seen[mode] = page.preview.frame.vertices.mean(axis=0)
        score = next(joint for joint in hands.lane.shown.joints if joint.position == position)
        assert (score.blended is not None) == (mode == "blended")
    assert np.linalg.norm(seen["filmed"] - seen["placed"]) > 10 * np.linalg.norm(seen["blended"] - seen["placed"])
    hands.shell.setFocus()


@pytest.mark.timeout(900)
def test_from_an_empty_window_to_an_exported_performance(
    open_shell: Callable[[Session], Shell], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Drop takes, say the rate, correct a boundary, force repeats, compose, reorder, repeat, forbid, another size,
    another path, a wanted length, compare, play, undo all, save, export, open again.
    """
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

    correct_the_motions(hands)

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
    choose_another_size(hands)
    choose_another_path(hands)
    want_a_length(hands)
    composed = state.document.performance

    wait_for(lambda: state.placed is not None and state.blends is not None, 120)
    settle(50)
    cuts = [joint for joint in hands.lane.shown.joints if joint.kind == "cut"]
    assert len(cuts) == len(state.performance.path) - 1
    assert all(joint.score is not None and joint.after < joint.before for joint in cuts)

    wait_for(lambda: page.preview.shown >= 0, 60)
    compare(hands)
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
