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
from app.window.performance.blocks import box
from app.window.shell import Shell
from app.window.timeline.lanes import RULER
from tests.window.clipping import assert_nothing_clipped
from tests.window.conftest import _move, at, drag, settle, wait_for
from tests.window.performing_hands import JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands
from tests.window.small_performance import build_small_performance

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture(scope="module")
def analysed(tmp_path_factory: pytest.TempPathFactory, private_places: None) -> Path:
    """A project of two takes with its motion graph."""
    return build_small_performance(tmp_path_factory.mktemp("moves"))


@pytest.fixture
def hands(analysed: Path, tmp_path: Path, open_shell: Callable[[Session], Shell]) -> PerformingHands:
    """Hands on the Motion graph of a window, the graph in sight."""
    copy = tmp_path / analysed.name
    shutil.copytree(analysed, copy)
    shell = open_shell(Session.open(copy))
    QTest.keyClick(shell, Qt.Key.Key_F3)
    made = PerformingHands(shell)
    made.ready()
    return made


def entries(shell: Shell) -> int:
    """How many entries the history has up to the present."""
    assert shell.project is not None
    return shell.project.session.history.present


def undo(hands: PerformingHands) -> None:
    """Ctrl+Z."""
    hands.press(Qt.Key.Key_Z, CONTROL)


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


def test_blocks_are_dragged_to_another_place(hands: PerformingHands) -> None:
    """A drag in the lane reorders, once; Ctrl+Right does the same; undo goes back."""
    hands.compose(WALK, JACK, SQUAT)
    before = entries(hands.shell)
    _, right = box(hands.block(2), hands.lane.axis)
    drag(hands.lane, hands.on_block(0), (right - 4, RULER + 20.0))
    assert hands.keys == [JACK, SQUAT, WALK]
    assert entries(hands.shell) == before + 1
    undo(hands)
    hands.found()
    assert hands.keys == [WALK, JACK, SQUAT]
    QTest.mouseClick(hands.lane, LEFT, pos=at(*hands.on_block(0)))
    hands.press(Qt.Key.Key_Right, CONTROL)
    assert hands.keys == [JACK, WALK, SQUAT]


def test_repeats_by_the_buttons_on_a_block(hands: PerformingHands) -> None:
    """+ and - play a motion longer and shorter, never less than once; the performance grows by its rounds."""
    hands.compose(WALK, SQUAT)
    frames = hands.page.state.frame_count
    QTest.mouseClick(hands.lane, LEFT, pos=hands.on_button(0, 1))
    assert hands.page.state.document.performance.keys[0].repeats == 2
    wait_for(lambda: hands.page.state.frame_count > frames, 30)
    settle(20)
    QTest.mouseClick(hands.lane, LEFT, pos=hands.on_button(0, -1))
    assert hands.page.state.document.performance.keys[0].repeats == 1
    wait_for(lambda: hands.page.state.frame_count == frames, 30)
    settle(20)
    QTest.mouseClick(hands.lane, LEFT, pos=hands.on_button(0, -1))
    assert hands.page.state.document.performance.keys[0].repeats == 1
    undo(hands)
    assert hands.page.state.document.performance.keys[0].repeats == 2


def test_delete_removes_the_chosen_key_motion(hands: PerformingHands) -> None:
    """A click chooses a block, Delete takes its key motion away, undo brings it back."""
    hands.compose(WALK, JACK, SQUAT)
    QTest.mouseClick(hands.lane, LEFT, pos=at(*hands.on_block(1)))
    hands.press(Qt.Key.Key_Delete)
    assert hands.keys == [WALK, SQUAT]
    undo(hands)
    assert hands.keys == [WALK, JACK, SQUAT]


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


def test_out_of_reach_offers_the_smallest_mu(hands: PerformingHands) -> None:
    """The gap says which motions, what mu would do; Use sets it and the path is there; undo brings the gap back."""
    page = hands.page
    hands.compose(WALK, SQUAT)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: page.composed.note.isVisible(), 30)
    sentence = page.composed.note.sentence.text()
    assert "Walk/1" in sentence
    assert "Gym/2" in sentence
    assert "Smallest mu" in sentence
    assert not hands.page.errors.isVisible(), "the lane says it, and nobody else"
    assert any(block.gap for block in hands.lane.shown.blocks)
    QTest.mouseClick(page.composed.note.use, LEFT)
    wait_for(lambda: page.state.paths, 30)
    assert page.state.document.performance.mu > 0.9
    assert not page.composed.note.isVisible()
    undo(hands)
    wait_for(lambda: page.composed.note.isVisible(), 30)
    assert page.state.document.performance.mu == 0.9


def test_another_motion_takes_the_place_of_one_out_of_reach(hands: PerformingHands) -> None:
    """Pick another, then a double click: the key motion is replaced; undo brings it back."""
    hands.compose(WALK, SQUAT)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: hands.page.composed.note.isVisible(), 30)
    hands.press(Qt.Key.Key_X)
    hands.shell.project.edit(edits.set_forbidden, hands.page.state.motions[JACK].motion, True)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: hands.page.composed.note.isVisible(), 30)
    QTest.mouseClick(hands.page.composed.note.pick, LEFT)
    hands.shell.project.edit(edits.clear_forbidden)
    hands.twice(MARCH)
    assert hands.keys == [WALK, MARCH]
    undo(hands)
    assert hands.keys == [WALK, SQUAT]


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


def test_a_node_is_carried_to_the_timeline(hands: PerformingHands) -> None:
    """Dropped between two blocks it becomes a key motion there, and stays where it stood in the graph."""
    hands.compose(WALK, SQUAT)
    mark = hands.canvas.picture.mark(JACK)
    left, _ = box(hands.block(1), hands.lane.axis)
    goal = hands.canvas.mapFromGlobal(hands.lane.mapToGlobal(at(left + 3, RULER + 30)))
    start = hands.place(JACK)
    drag(hands.canvas, (start.x(), start.y()), (goal.x(), goal.y()), release=False)
    assert hands.lane.insertion == 1
    assert hands.page.carried.isVisible()
    QTest.mouseRelease(hands.canvas, LEFT, pos=goal)
    assert hands.keys == [WALK, JACK, SQUAT]
    assert not hands.page.carried.isVisible()
    assert hands.canvas.picture.mark(JACK).x == mark.x
    undo(hands)
    assert hands.keys == [WALK, SQUAT]


def test_keys_lead_through_the_graph(hands: PerformingHands) -> None:
    """Tab goes through all motions, arrows to the nearest in their direction, Escape ends a drag."""
    seen = []
    for _ in range(4):
        hands.press(Qt.Key.Key_Tab)
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


def test_time_belongs_to_the_performance(hands: PerformingHands) -> None:
    """Home, End, arrows, Up and Down move its playhead; Space plays it at its own rate and stops."""
    hands.compose(WALK, SQUAT)
    state = hands.page.state
    hands.shell.setFocus()
    hands.press(Qt.Key.Key_End)
    assert state.position == state.frame_count - 1
    hands.press(Qt.Key.Key_Home)
    hands.press(Qt.Key.Key_Right)
    hands.press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert state.position == 11
    hands.press(Qt.Key.Key_Down)
    cut = next(cut for cut in state.performance.cuts if cut.kind == "cut")
    assert state.position == cut.position
    assert hands.shell.project.frame == 0
    hands.press(Qt.Key.Key_Space)
    assert state.playback.playing
    wait_for(lambda: state.position != cut.position)
    hands.press(Qt.Key.Key_Space)
    assert not state.playback.playing


def test_a_click_in_the_lane_seeks(hands: PerformingHands) -> None:
    """The ruler scrubs; a click on a cost chooses its cut, which can be left hard and blended again."""
    hands.compose(WALK, SQUAT)
    state = hands.page.state
    wait_for(lambda: state.placed is not None, 60)
    drag(hands.lane, (hands.lane.axis.x(5), 8), (hands.lane.axis.x(20), 8))
    assert state.position == 20
    cut = next(number for number, cut in enumerate(state.performance.cuts) if cut.kind == "cut")
    x = hands.lane.axis.x(state.performance.cuts[cut].position) + 3
    QTest.mouseClick(hands.lane, LEFT, pos=at(x, hands.lane.height() - 15))
    assert state.cut == cut
    hard = hands.page.composed.options.hard
    QTest.mouseClick(hands.page.composed.options.blend, LEFT)
    assert hard.isEnabled()
    QTest.mouseClick(hard, LEFT)
    assert len(state.document.performance.hard_cuts) == 1
    QTest.mouseClick(hard, LEFT)
    assert state.document.performance.hard_cuts == ()


def test_choices_of_the_performance(hands: PerformingHands) -> None:
    """Loop, align, blend and a wanted length are switched by clicks; each is an entry that undo takes back."""
    hands.compose(WALK, SQUAT)
    options, state = hands.page.composed.options, hands.page.state
    for widget, value in (
        (options.loop, lambda: state.document.performance.loop),
        (options.align, lambda: not state.document.performance.align),
    ):
        QTest.mouseClick(widget, LEFT)
        assert value()
        undo(hands)
        assert not value()
    QTest.mouseClick(options.blend, LEFT)
    assert state.document.performance.blend
    undo(hands)
    hands.found()
    frames = state.frame_count
    QTest.mouseClick(options.wanted, LEFT)
    assert state.document.performance.length == frames
    QTest.mouseClick(options.frames, LEFT)
    QTest.keyClicks(options.frames, str(frames + 1))
    QTest.keyClick(options.frames, Qt.Key.Key_Return)
    assert state.document.performance.length == frames + 1
    wait_for(lambda: state.paths and (len(state.paths[0]) == frames + 1 or state.paths[0].note), 30)
    settle(30)
    assert options.note.text() == state.performance.note
    assert (state.frame_count == frames + 1) == (not state.performance.note)


def test_alternatives_are_a_click_away(hands: PerformingHands) -> None:
    """The list has the best path and the next best with cost and length; choosing one plays it; undo goes back."""
    hands.compose(WALK, SQUAT)
    state, chooser = hands.page.state, hands.page.composed.options.paths
    assert chooser.count() == len(state.paths)
    if chooser.count() < 2:
        hands.shell.project.edit(edits.set_mu, 1.9)
        wait_for(lambda: len(state.paths) > 1, 30)
        settle(30)
    assert f"worst {state.paths[1].cost:.2f}, {len(state.paths[1])} frames" in chooser.itemText(1)
    chooser.setFocus()
    QTest.keyClick(chooser, Qt.Key.Key_Down)
    assert state.document.performance.alternative == 1
    assert len(state.performance) == len(state.paths[1])
    undo(hands)
    assert state.document.performance.alternative == 0


def test_a_motion_on_the_way_becomes_a_key_motion(hands: PerformingHands) -> None:
    """A double click on a block without a number gives it one."""
    hands.compose(WALK, SQUAT)
    block = next(block for block in hands.lane.shown.blocks if not block.keys)
    left, right = box(block, hands.lane.axis)
    QTest.mouseDClick(hands.lane, LEFT, pos=at((left + right) / 2, RULER + 12))
    assert hands.keys == [WALK, MARCH, SQUAT]


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


@pytest.mark.parametrize("size", [(1180, 720), (1440, 900), (1920, 1080)])
def test_nothing_is_clipped(hands: PerformingHands, size: tuple[int, int]) -> None:
    """At three sizes every word has its room, with a path and without one."""
    hands.shell.resize(*size)
    hands.compose(WALK, SQUAT)
    settle(100)
    assert_nothing_clipped(hands.shell)
    hands.click(MARCH)
    hands.press(Qt.Key.Key_X)
    wait_for(lambda: hands.page.composed.note.isVisible(), 30)
    settle(100)
    assert_nothing_clipped(hands.shell)
    note = hands.page.composed.note
    assert note.sentence.heightForWidth(note.sentence.width()) <= note.sentence.height() + 1


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
    QTest.keyClick(shell, Qt.Key.Key_F1)
    assert shell.pages.welcoming
