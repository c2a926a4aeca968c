"""The Motion graph under mouse and keys: every hand movement is one edit that undo takes back."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QToolButton

from app.actions.session import Session
from app.model.edits import performance as edits
from app.window.performance.graph_view import bow, on_bow
from app.window.shell import Shell
from tests.window.clipping import assert_nothing_clipped
from tests.window.conftest import _move, at, drag, settle, wait_for
from tests.window.performing_hands import JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands, entries, undo
from tests.window.performing_hands import analysed as analysed
from tests.window.performing_hands import hands as hands

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


def test_motions_become_key_motions(hands: PerformingHands) -> None:
    """A double click and Enter append, each as one entry; the path is lit, badges count; undo takes each back."""
    hands.twice(WALK)
    hands.click(SQUAT)
    assert hands.page.state.sequence_id == hands.page.state.motions[SQUAT].sequence
    hands.press(Qt.Key.Key_Return)
    assert hands.keys == [WALK, SQUAT]
    hands.found()
    picture = hands.canvas.picture
    assert [mark.badges for mark in picture.nodes if mark.badges] == [(1,), (2,)]
    lit = [(edge.start, edge.goal) for edge in picture.edges if edge.kind == "path"]
    path = hands.page.state.performance.path
    assert sorted(lit) == sorted(itertools.pairwise(path))
    assert len(lit) >= 1
    undo(hands)
    assert hands.keys == [WALK]
    undo(hands)
    assert hands.keys == []


def test_the_same_motion_once_more_is_played_longer(hands: PerformingHands) -> None:
    """Appending the last key motion again repeats it."""
    hands.twice(JACK)
    hands.twice(JACK)
    assert hands.keys == [JACK]
    assert hands.page.state.document.performance.keys[0].repeats == 2
    assert "2 times" in hands.shell.bar.undo.toolTip()


def test_x_forbids_and_allows(hands: PerformingHands) -> None:
    """X hatches a motion and the path goes another way; a key motion is refused in words; undo allows it again."""
    hands.compose(WALK, SQUAT)
    on_the_way = [node for node in hands.page.state.performance.path if node not in (WALK, SQUAT)]
    assert on_the_way == [MARCH]
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    assert hands.canvas.picture.mark(MARCH).forbidden
    hands.found()
    assert hands.page.state.problem or MARCH not in hands.page.state.performance.path
    hands.click(WALK)
    hands.press(Qt.Key.Key_X)
    assert not hands.canvas.picture.mark(WALK).forbidden
    assert "key motion 1" in hands.page.graph.errors.sentence.text()
    undo(hands)
    assert not hands.canvas.picture.mark(MARCH).forbidden


def test_the_slider_shows_what_another_size_gives(hands: PerformingHands) -> None:
    """While it is dragged the new graph and path are lit and nothing is edited; let go it is one entry."""
    page = hands.page
    hands.compose(WALK, SQUAT)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: page.state.problem, 30)
    before = entries(hands.shell)
    slider = page.database.slider
    y = slider.height() / 2

    def x(mu: float) -> float:
        return 7 + (slider.width() - 14) * mu / 2.0

    drag(slider, (x(0.9), y), (x(1.4), y), release=False, pause=15)
    wait_for(lambda: page.trial.result is not None and page.trial.result.path, 10)
    assert [edge for edge in hands.canvas.picture.edges if edge.kind == "path"]
    assert entries(hands.shell) == before
    QTest.mouseRelease(slider, LEFT, pos=at(x(1.4), y))
    assert entries(hands.shell) == before + 1
    assert 1.2 < page.state.document.performance.mu < 1.6
    wait_for(lambda: page.state.paths and page.trial.result is None, 30)
    assert [edge for edge in hands.canvas.picture.edges if edge.kind == "path"]
    undo(hands)
    assert page.state.document.performance.mu == 0.9
    assert slider.value() == 900


def test_pruned_transitions_are_faint_while_the_size_is_dragged(hands: PerformingHands) -> None:
    """A small graph keeps few transitions; the others are there, faint, as long as the slider is held."""
    slider = hands.page.database.slider
    y = slider.height() / 2
    kept = len(hands.canvas.picture.edges)
    drag(slider, (7 + (slider.width() - 14) * 0.45, y), (10, y), release=False, pause=15)
    wait_for(lambda: hands.page.trial.result is not None, 10)
    settle(60)
    kinds = [edge.kind for edge in hands.canvas.picture.edges]
    assert kinds.count("faint") > 0
    assert kinds.count("kept") <= kept
    QTest.mouseRelease(slider, LEFT, pos=at(10, y))
    wait_for(lambda: hands.page.trial.result is None, 20)
    assert not [edge for edge in hands.canvas.picture.edges if edge.kind == "faint"]


def test_nodes_stay_where_they_are_dragged(hands: PerformingHands) -> None:
    """A drag moves a node and edits nothing; another size of the graph leaves it there."""
    before = hands.place(JACK)
    drag(hands.canvas, (before.x(), before.y()), (before.x() + 60, before.y() - 25))
    assert not hands.shell.project.session.history.modified
    wanted = hands.place(JACK)
    mark = hands.canvas.picture.mark(JACK)
    hands.shell.project.edit(edits.set_mu, 1.3)
    settle(300)
    assert (hands.canvas.picture.mark(JACK).x, hands.canvas.picture.mark(JACK).y) == (mark.x, mark.y)
    assert wanted.x() > before.x() or wanted.y() < before.y()


def test_keys_lead_through_the_graph(hands: PerformingHands) -> None:
    """Page Down goes through all motions, arrows to the nearest in their direction, Escape ends a drag."""
    seen = []
    hands.canvas.setFocus()
    for _ in range(4):
        hands.press(Qt.Key.Key_PageDown)
        seen.append(hands.page.state.node)
    assert sorted(seen) == [WALK, JACK, SQUAT, MARCH]
    assert hands.canvas.hasFocus()
    marks = {mark.node: mark for mark in hands.canvas.picture.nodes}
    right = max(marks.values(), key=lambda mark: mark.x).node
    for _ in range(4):
        hands.press(Qt.Key.Key_Right)
    assert hands.page.state.node == right
    start = hands.place(WALK)
    drag(hands.canvas, (start.x(), start.y()), (start.x() + 40, start.y() + 20), release=False)
    hands.press(Qt.Key.Key_Escape)
    QTest.mouseRelease(hands.canvas, LEFT, pos=at(start.x() + 40, start.y() + 20))
    assert hands.place(WALK) == start


def test_a_filter_leaves_what_it_names(hands: PerformingHands) -> None:
    """Typed letters dim the others; Enter chooses the first that is left."""
    field = hands.page.graph.filter
    QTest.mouseClick(field, LEFT)
    QTest.keyClicks(field, "walk")
    assert [mark.name for mark in hands.canvas.picture.nodes if not mark.dim] == ["Walk/1"]
    assert "1 of 4" in hands.page.graph.header.caption.text()
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert hands.page.state.node == WALK


def test_a_node_plays_under_the_mouse(hands: PerformingHands) -> None:
    """Pictures of its frames follow each other while the mouse is over it, and stop when it leaves."""
    place = hands.place(WALK)
    _move(hands.canvas, place, LEFT, Qt.KeyboardModifier.NoModifier)
    wait_for(lambda: hands.canvas.step >= 3)
    assert hands.canvas.hover == WALK
    thumbnails = hands.page.thumbnails
    first = hands.page.state.motions[WALK].texton[0]
    sequence = hands.page.state.motions[WALK].sequence
    wait_for(lambda: thumbnails.picture(sequence, first) is not None, 60)
    _move(hands.canvas, at(2, 2), LEFT, Qt.KeyboardModifier.NoModifier)
    assert hands.canvas.hover == -1
    assert not hands.canvas._beat.isActive()


def test_a_transition_under_the_mouse_shows_its_two_frames(hands: PerformingHands) -> None:
    """A card with the frames that meet and what it costs, at an edge of the graph and at a cut of the timeline."""
    hands.compose(WALK, SQUAT)
    state, card = hands.page.state, hands.page.crossing
    start, goal = state.performance.path[:2]
    marks = {mark.node: mark for mark in hands.canvas.picture.nodes}
    lens = hands.canvas.lens
    ends = [lens.pixel(marks[node].x, marks[node].y) for node in (start, goal)]
    none = Qt.KeyboardModifier.NoModifier
    _move(hands.canvas, at(*on_bow(*bow(*ends, lens.size / 2), 0.5)), LEFT, none)
    assert not card.isVisible(), "the mouse may only pass"
    wait_for(card.isVisible)
    leave, enter = state.graph.transitions[start, goal]
    assert [frame for _, frame in card.frames] == [leave, enter]
    assert f"{state.graph.complete[start, goal]:.2f}" in card.words
    assert hands.page.rect().contains(card.geometry())
    _move(hands.canvas, at(2, 2), LEFT, none)
    assert not card.isVisible()
    cut = next(cut for cut in state.performance.cuts if cut.kind == "cut")
    _move(hands.lane, at(hands.lane.axis.x(cut.position) + 3, hands.lane.height() - 14), LEFT, none)
    wait_for(card.isVisible)
    assert [frame for _, frame in card.frames] == [cut.leave, cut.enter]
    _move(hands.lane, at(hands.lane.axis.x(1), 40), LEFT, none)
    assert not card.isVisible()


def test_wheel_and_drag_move_the_view(hands: PerformingHands) -> None:
    """The wheel zooms at the mouse, a drag of the surface pans, F shows everything again."""
    from PySide6.QtCore import QPoint
    from PySide6.QtGui import QWheelEvent
    from PySide6.QtWidgets import QApplication

    fitted = hands.canvas.lens
    place = QPointF(hands.place(WALK))
    event = QWheelEvent(
        place,
        hands.canvas.mapToGlobal(place),
        QPoint(),
        QPoint(0, -240),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(hands.canvas, event)
    assert hands.canvas.lens.size < fitted.size
    assert (QPointF(hands.place(WALK)) - place).manhattanLength() <= 2
    drag(hands.canvas, (4, 4), (44, 24))
    assert (QPointF(hands.place(WALK)) - place - QPointF(40, 20)).manhattanLength() <= 3
    hands.shell.setFocus()
    hands.press(Qt.Key.Key_F)
    assert hands.canvas.lens == fitted


def at_rest(hands: PerformingHands) -> None:
    """Wait for the work under way: a percentage that grows has its room a moment after it is written."""
    settle(50)
    wait_for(lambda: not hands.shell.project.progress, 60)
    settle(100)


@pytest.mark.parametrize("size", [(1180, 720), (1440, 900), (1920, 1080)])
def test_nothing_is_clipped(hands: PerformingHands, size: tuple[int, int]) -> None:
    """At three sizes every word has its room, with a path and without one."""
    hands.shell.resize(*size)
    hands.compose(WALK, SQUAT)
    at_rest(hands)
    assert_nothing_clipped(hands.shell)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: hands.page.composed.note.isVisible(), 30)
    at_rest(hands)
    assert_nothing_clipped(hands.shell)
    note = hands.page.composed.note
    assert note.sentence.heightForWidth(note.sentence.width()) <= note.sentence.height() + 1


def test_what_is_not_composed_yet_has_nothing_to_play(hands: PerformingHands) -> None:
    """Without key motions the row of the timeline shows neither frames nor a legend, and its buttons wait."""
    transport = hands.page.composed.transport
    assert not any(button.isEnabled() for button in transport.buttons.values())
    assert (transport.number.text(), transport.legend.entries) == ("", ())
    hands.compose(WALK, SQUAT)
    wait_for(lambda: all(button.isEnabled() for button in transport.buttons.values()))
    assert transport.number.text() == "0"
    assert [text for text, _, _ in transport.legend.entries] == ["hidden", "jump is seen", "poses far apart"]


def test_every_control_says_what_it_is(hands: PerformingHands) -> None:
    """Buttons without a text have a tooltip and a name for screen readers."""
    hands.compose(WALK, SQUAT)
    for each in hands.shell.findChildren(QToolButton):
        if each.isVisibleTo(hands.shell) and not each.text():
            assert each.toolTip(), each
            assert each.accessibleName(), each.toolTip()


def test_a_project_of_takes_opens_here(analysed: Path, tmp_path: Path, open_shell: Callable[[Session], Shell]) -> None:
    """Where there is neither film nor character, the Motion graph is what one sees first."""
    copy = tmp_path / analysed.name
    shutil.copytree(analysed, copy)
    shell = open_shell(Session.open(copy))
    assert shell.pages.currentWidget() is shell.performance


def test_an_empty_project_invites(open_shell: Callable[[Session], Shell]) -> None:
    """F3 shows one sentence, one primary button and the sample; nothing is computed."""
    shell = open_shell(Session.new())
    QTest.keyClick(shell, Qt.Key.Key_F3)
    page = shell.performance
    assert shell.pages.currentWidget() is page
    assert page.graph.nothing.isVisible()
    assert "drop one here" in page.graph.nothing.sentence.text()
    assert page.graph.nothing.add.isVisible()
    assert page.graph.nothing.sample.isVisible()
    assert not shell.timeline.isVisible()
    idle = (page.database, page.graph.filter, page.graph.forbid, page.graph.key, page.preview.footer, page.composed)
    assert not any(each.isVisible() for each in idle), "what has nothing to work on is not there"
    QTest.keyClick(shell, Qt.Key.Key_F1)
    assert shell.pages.welcoming
