"""The Motion graph by the keyboard alone: Tab and F6 lead to every part, and in each the keys do what lies near."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.window.performance.export_dialog import ExportDialog
from app.window.shell import Shell
from tests.window.conftest import at, settle, wait_for
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project
from tests.window.performance_parts import label_of, quiet
from tests.window.performing_hands import CONTROL, JACK, LEFT, MARCH, SQUAT, WALK, PerformingHands, undo
from tests.window.performing_hands import analysed as analysed
from tests.window.performing_hands import hands as hands

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]
SHIFT = Qt.KeyboardModifier.ShiftModifier
TAB, ENTER, UP, DOWN = Qt.Key.Key_Tab, Qt.Key.Key_Return, Qt.Key.Key_Up, Qt.Key.Key_Down


def press(key: Qt.Key, held: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    """Press a key where the focus is."""
    QTest.keyClick(QApplication.focusWidget(), key, held)
    settle(5)


def tab_to(widget: QWidget, most: int = 70) -> None:
    """Press Tab until something has the focus."""
    for _ in range(most):
        if QApplication.focusWidget() is widget:
            return
        press(TAB)
    raise AssertionError(f"Tab does not lead to {widget.accessibleName() or widget}")


def differs(widget: QWidget, change: Callable[[], object]) -> bool:
    """Whether something that is done changes how a widget looks."""
    before = widget.grab().toImage()
    change()
    settle(20)
    return bool(before != widget.grab().toImage())


def test_tab_leads_through_every_part_and_out_of_it(composed: Shell) -> None:
    """Library, graph, preview, choices, lane, source: in this order, each with a ring, back by Shift+Tab; F6 too."""
    page = composed.pages.in_sight
    parts = [page.library.cards, page.graph.canvas, page.preview.view.viewport]
    parts += [page.composed.options.loop, page.composed.view, page.strip.view]
    composed.setFocus()
    seen: list[QWidget] = []
    for _ in range(70):
        QTest.keyClick(QApplication.focusWidget(), TAB)
        seen.append(QApplication.focusWidget())
    places = [seen.index(part) for part in parts]
    assert places == sorted(places)
    assert seen.count(page.graph.canvas) == seen.count(page.library.cards) >= 1, "it is left again"
    tab_to(page.composed.view)
    press(Qt.Key.Key_Backtab, SHIFT)
    assert QApplication.focusWidget() is not page.composed.view
    for part in (page.library.cards, page.graph.canvas, page.composed.view, page.strip.view):
        composed.setFocus()
        assert differs(part, lambda part=part: tab_to(part)), "the focus is seen"
        assert part.ringed
        assert "Delete" in composed.status.hint.text(), "what its keys do is said"
    composed.setFocus()
    wanted = [page.library.cards, page.database.slider, page.graph.canvas, page.preview.view.viewport]
    wanted += [page.composed.options.paths] * page.composed.options.paths.isEnabled()
    for part in [*wanted, page.composed.view, page.strip.view, page.library.cards]:
        press(Qt.Key.Key_F6)
        assert QApplication.focusWidget() is part
    press(Qt.Key.Key_F6, SHIFT)
    assert QApplication.focusWidget() is page.strip.view


def test_the_list_by_keys(composed: Shell) -> None:
    """Down, End and Home choose, Enter plays as captured, Delete removes; undo brings it back."""
    page, document = composed.pages.in_sight, composed.project.document
    first, second = (each.id for each in document.sequences)
    tab_to(page.library.sections[0].head)
    press(ENTER)
    tab_to(page.library.facts.level)
    press(Qt.Key.Key_Space)
    assert composed.project.document.sequence(page.state.sequence_id).level
    press(Qt.Key.Key_Z, CONTROL)
    tab_to(page.library.cards)
    press(Qt.Key.Key_Home)
    press(DOWN)
    assert page.state.sequence_id == second
    press(UP)
    assert page.state.sequence_id == first
    press(ENTER)
    assert page.state.playback.playing
    assert page.state.shows == "source"
    press(Qt.Key.Key_Space)
    assert not page.state.playback.playing
    press(Qt.Key.Key_End)
    press(Qt.Key.Key_Delete)
    assert [each.id for each in composed.project.document.sequences] == [first]
    assert page.library.cards.hasFocus()
    press(Qt.Key.Key_Z, CONTROL)
    assert len(composed.project.document.sequences) == 2
    quiet(composed)


def test_the_source_by_keys(composed: Shell) -> None:
    """Down and Up go from texton to texton, Enter keeps one, Page Down chooses a boundary that Ctrl+Right moves."""
    page = composed.pages.in_sight
    page.state.select_sequence(next(each.id for each in composed.project.document.sequences if each.name == "Gym"))
    settle(30)
    view = page.strip.view
    tab_to(view)
    press(Qt.Key.Key_Home)
    starts = [first for motion in view.strip.motions for first, _ in motion.textons]
    for start in [each for each in starts if each > 0][:3]:
        press(DOWN)
        assert page.state.source_frame == start
        assert view.span is not None
        assert view.span[0] == start
    press(Qt.Key.Key_Right)
    press(Qt.Key.Key_Right, SHIFT)
    assert page.state.source_frame == start + 11
    number = next(k for k, motion in enumerate(view.strip.motions) if len(motion.textons) > 1)
    motion = view.strip.motions[number]
    other = next(k for k in range(len(motion.textons)) if k != motion.kept)
    press(Qt.Key.Key_Home)
    while page.state.source_frame != motion.textons[other][0]:
        press(DOWN)
    press(ENTER)
    assert label_of(composed).startswith("Choose the texton at frame")
    wait_for(lambda: view.strip.motions[number].kept == other)
    before = view.strip.boundaries
    press(Qt.Key.Key_Home)
    press(Qt.Key.Key_PageDown)
    assert view.boundary == before[0]
    press(Qt.Key.Key_Right, CONTROL)
    wait_for(lambda: view.strip.boundaries[0] == before[0] + 1)
    press(Qt.Key.Key_Delete)
    wait_for(lambda: view.strip.boundaries == before[1:])
    quiet(composed)


def test_a_boundary_left_alone_keeps_no_keys(composed: Shell) -> None:
    """One that was chosen in the source is not what Delete means in the lane."""
    page = composed.pages.in_sight
    page.state.select_sequence(next(each.id for each in composed.project.document.sequences if each.name == "Gym"))
    settle(30)
    tab_to(page.strip.view)
    press(Qt.Key.Key_Home)
    press(Qt.Key.Key_PageDown)
    assert page.strip.view.boundary > 0
    tab_to(page.composed.view)
    press(Qt.Key.Key_Home)
    press(DOWN)
    press(Qt.Key.Key_Delete)
    assert "boundary" not in (label_of(composed) or "").lower()
    quiet(composed)


def test_the_matrix_by_keys(composed: Shell) -> None:
    """Arrows point at two moments, Enter shows the first, Page Down chooses a boundary that Delete takes away."""
    page = composed.pages.in_sight
    page.state.select_sequence(next(each.id for each in composed.project.document.sequences if each.name == "Gym"))
    settle(30)
    tab_to(page.strip.matrix_button)
    press(Qt.Key.Key_Space)
    view = page.matrix.view
    wait_for(lambda: view.isVisible() and view.strip.count > 0)
    assert not page.state.playback.playing, "Space presses the button"
    page.state.show_source(page.state.sequence_id, 0)
    tab_to(view)
    press(Qt.Key.Key_Right, SHIFT)
    press(Qt.Key.Key_Right)
    for _ in range(3):
        press(DOWN)
    assert view._mouse == (11, 3)
    press(ENTER)
    assert page.state.source_frame == 11
    before = page.strip.view.strip.boundaries
    press(Qt.Key.Key_PageDown)
    assert view.boundary == next(frame for frame in before if frame > 11)
    press(Qt.Key.Key_Delete)
    wait_for(lambda: len(page.strip.view.strip.boundaries) == len(before) - 1)
    quiet(composed)


def test_the_view_is_turned_by_keys(composed: Shell) -> None:
    """Ctrl with the arrows turns the preview while it has the keys, and moves no key motion."""
    preview = composed.pages.in_sight.preview
    keys = composed.project.document.performance.keys
    tab_to(preview.view.viewport)
    before = preview.view.viewport.orbit
    press(Qt.Key.Key_Left, CONTROL)
    turned = preview.view.viewport.orbit
    assert turned.azimuth != before.azimuth
    press(Qt.Key.Key_Equal, CONTROL)
    assert preview.view.viewport.orbit.distance < turned.distance
    assert composed.project.document.performance.keys == keys
    tab_to(preview.mode_buttons["blended"])
    press(Qt.Key.Key_Right)
    assert preview.mode == "placed"


def test_from_motions_to_the_export_by_keys(hands: PerformingHands, tmp_path: Path) -> None:
    """Chosen, added, moved, repeated, removed, forbidden, looped, played and written without the mouse."""
    page, state = hands.page, hands.page.state
    tab_to(hands.canvas)
    for node in (WALK, JACK, SQUAT):
        while state.node != node:
            press(Qt.Key.Key_PageDown)
        press(ENTER)
    assert hands.keys == [WALK, JACK, SQUAT]
    hands.found()
    while state.node != JACK:
        press(Qt.Key.Key_PageUp)
    press(Qt.Key.Key_Delete)
    assert hands.keys == [WALK, SQUAT]
    undo(hands)
    hands.found()
    tab_to(hands.lane)
    press(Qt.Key.Key_Home)
    press(DOWN)
    assert state.performance.cuts[state.cut].position == state.position > 0
    while page.editing.key < 1:
        press(DOWN)
    assert state.node == JACK
    press(Qt.Key.Key_Right, CONTROL)
    assert hands.keys == [WALK, SQUAT, JACK]
    hands.found()
    press(UP, CONTROL)
    assert state.document.performance.keys[2].repeats == 2
    hands.found()
    press(Qt.Key.Key_Delete)
    assert hands.keys == [WALK, SQUAT]
    assert page.editing.key == 1, "the next one is chosen"
    hands.found()
    press(Qt.Key.Key_Home)
    press(DOWN)
    block = next(block for block in hands.lane.shown.blocks if block.first == state.position)
    assert block.node == MARCH
    press(ENTER)
    assert hands.keys == [WALK, MARCH, SQUAT]
    undo(hands)
    hands.found()
    tab_to(page.composed.options.loop)
    press(Qt.Key.Key_Space)
    assert state.document.performance.loop
    assert not state.playback.playing
    press(ENTER)
    assert not state.document.performance.loop
    hands.found()
    wait_for(lambda: state.placed is not None, 60)
    tab_to(hands.lane)
    press(Qt.Key.Key_Space)
    assert state.playback.playing
    press(Qt.Key.Key_Space)
    press(Qt.Key.Key_E, CONTROL)
    dialog = page.findChild(ExportDialog)
    wait_for(lambda: not dialog._still.startswith("Looking"), 30)
    dialog.activateWindow()
    dialog.place.setFocus()
    dialog.place.selectAll()
    QTest.keyClicks(dialog.place, str(tmp_path / "written"))
    said: list[str] = []
    dialog.done.connect(said.append)
    QTest.keyClick(dialog.place, ENTER)
    wait_for(lambda: said, 60)
    assert len(list((tmp_path / "written").glob("*.ply"))) == state.frame_count


def test_a_click_on_a_block_chooses_its_motion(hands: PerformingHands) -> None:
    """Wherever the playhead stood before."""
    hands.compose(WALK, SQUAT)
    hands.page.state.show_position(0)
    QTest.mouseClick(hands.lane, LEFT, pos=at(*hands.on_block(1)))
    assert hands.page.state.node == SQUAT
    assert hands.page.editing.key == 1
