"""The composed timeline under mouse and keys: reorder, repeat, drop, what is out of reach, choices; undo of each."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import performance as edits
from app.window.performance.blocks import box
from app.window.timeline.lanes import RULER
from tests.window.conftest import at, drag, settle, wait_for
from tests.window.performing_hands import CONTROL, JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands, entries, undo
from tests.window.performing_hands import analysed as analysed
from tests.window.performing_hands import hands as hands

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


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
