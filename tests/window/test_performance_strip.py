"""The source strip and the matrix, driven by mouse and keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.window import theme
from app.window.performance.strip import BOX, RULER, drag_of
from app.window.shell import Shell
from tests.window.conftest import at, drag, hover, settle, wait_for
from tests.window.performance_parts import CONTROL, LEFT, PLAIN, label_of, pick, quiet
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


@pytest.fixture
def strip(composed: Shell) -> object:
    """The strip of the gymnastics, which has several motions."""
    page = composed.pages.in_sight
    page.state.select_sequence(next(each.id for each in composed.project.document.sequences if each.name == "Gym"))
    settle(30)
    assert len(page.strip.view.strip.motions) >= 3
    return page.strip


def line(strip: object, number: int) -> tuple[float, float]:
    """Where a boundary can be taken hold of."""
    view = strip.view
    return view.axis.x(view.strip.boundaries[number]), RULER + BOX[0] + 10


def box(strip: object, motion: int, texton: int) -> tuple[float, float]:
    """The middle of a texton."""
    first, last = strip.view.strip.motions[motion].textons[texton]
    return strip.view.axis.x((first + last + 1) / 2), RULER + BOX[0] + 12


def test_a_boundary_is_dragged(composed: Shell, strip: object) -> None:
    """One entry of the history, everything downstream is found anew, undo brings all of it back."""
    before = strip.view.strip.boundaries
    x, y = line(strip, 0)
    four = x + 4 * strip.view.axis.pixels
    drag(strip.view, (x, y), (four, y))
    moved = (before[0] + 4, *before[1:])
    assert label_of(composed) == f"Move a boundary of Gym, frame {before[0]} to {before[0] + 4}"
    assert composed.project.document.sequences[1].structure.boundaries == moved
    wait_for(lambda: strip.view.strip.boundaries == moved)
    quiet(composed)
    assert "by hand" in strip.header.caption.text()
    QTest.keyClick(composed, Qt.Key.Key_Z, CONTROL)
    wait_for(lambda: strip.view.strip.boundaries == before)
    assert composed.project.document.sequences[1].structure.boundaries is None


def test_a_drag_is_given_up(composed: Shell, strip: object) -> None:
    """Escape lets the boundary go back, and a boundary never passes its neighbour."""
    entry = label_of(composed)
    x, y = line(strip, 0)
    drag(strip.view, (x, y), (x + 60, y), release=False)
    assert strip.view.drag is not None
    QTest.keyClick(composed, Qt.Key.Key_Escape)
    assert strip.view.drag is None
    QTest.mouseRelease(strip.view, LEFT, PLAIN, at(x + 60, y))
    assert label_of(composed) == entry
    shown = strip.view.strip
    held = drag_of(shown, shown.boundaries[0])
    assert held.to(10**6).new == shown.boundaries[1] - 1
    assert held.to(-5).new == 1


def test_another_texton_is_kept(composed: Shell, strip: object) -> None:
    """A double click moves the star; the right button offers it too, and the way back."""
    motions = strip.view.strip.motions
    number = next(k for k, motion in enumerate(motions) if len(motion.textons) > 1)
    other = next(k for k in range(len(motions[number].textons)) if k != motions[number].kept)
    place = at(*box(strip, number, other))
    QTest.mouseClick(strip.view, LEFT, PLAIN, place)
    QTest.mouseDClick(strip.view, LEFT, PLAIN, place)
    assert label_of(composed).startswith("Choose the texton at frame")
    wait_for(lambda: strip.view.strip.motions[number].kept == other)
    pick(strip.menu_for(strip.view.find(place)), "Choose all textons automatically")
    assert label_of(composed) == "Choose the textons of Gym anew"
    wait_for(lambda: strip.view.strip.motions[number].kept == motions[number].kept)


def test_motions_are_split_and_joined(composed: Shell, strip: object) -> None:
    """By the menu, by Delete on a boundary, and found again."""
    before = strip.view.strip.boundaries
    first, last = strip.view.strip.motions[0].first, strip.view.strip.motions[0].last
    middle = (first + last) // 2
    found = strip.view.find(at(strip.view.axis.x(middle + 0.5), RULER + 8))
    pick(strip.menu_for(found), f"Split at frame {middle}")
    assert label_of(composed) == f"Add a boundary at frame {middle} of Gym"
    wait_for(lambda: strip.view.strip.boundaries == (middle, *before))
    QTest.mouseClick(strip.view, LEFT, PLAIN, at(*line(strip, 0)))
    assert strip.view.boundary == middle
    QTest.keyClick(composed, Qt.Key.Key_Delete)
    assert label_of(composed) == f"Remove the boundary at frame {middle} of Gym"
    wait_for(lambda: strip.view.strip.boundaries == before)
    found = strip.view.find(at(strip.view.axis.x(2), RULER + 8))
    pick(strip.menu_for(found), "Join with the motion after")
    wait_for(lambda: strip.view.strip.boundaries == before[1:])
    pick(strip.menu_for(found), "Find the boundaries again")
    assert label_of(composed) == "Find the boundaries of Gym"
    wait_for(lambda: strip.view.strip.boundaries == before)
    pick(strip.menu_for(found), "Everything repeats")
    assert composed.project.document.sequences[1].structure.force_cyclic
    quiet(composed)


def test_a_boundary_is_moved_by_keys(composed: Shell, strip: object) -> None:
    """Ctrl with the arrows, several presses are one entry."""
    before = strip.view.strip.boundaries
    entries = len(composed.project.session.history.versions)
    QTest.mouseClick(strip.view, LEFT, PLAIN, at(*line(strip, 1)))
    for step in range(1, 4):
        QTest.keyClick(composed, Qt.Key.Key_Right, CONTROL)
        wanted = before[1] + step
        wait_for(lambda wanted=wanted: strip.view.strip.boundaries[1] == wanted)
    assert len(composed.project.session.history.versions) == entries + 1
    QTest.keyClick(composed, Qt.Key.Key_Z, CONTROL)
    assert composed.project.document.sequences[1].structure.boundaries is None
    quiet(composed)


def test_the_strip_seeks_and_zooms(composed: Shell, strip: object) -> None:
    """A click shows that frame of the source; the wheel zooms; a texton is played in a loop."""
    state = composed.pages.in_sight.state
    motion = strip.view.strip.motions[0]
    QTest.mouseClick(strip.view, LEFT, PLAIN, at(*box(strip, 0, 0)))
    middle = sum(motion.textons[0]) // 2
    assert state.shows == "source"
    assert abs(state.source_frame - middle) <= 1
    assert strip.view.span == motion.textons[0]
    assert state.motions[state.node].name == motion.name
    wait_for(lambda: composed.pages.in_sight.preview.shown == state.source_frame)
    words = strip.view.words_at(at(*box(strip, 0, 0)))
    assert motion.name in words
    assert motion.reason in words
    strip.view.zoom(4)
    assert strip.view.axis.pixels > 2 * strip.view.axis.fitted_step
    QTest.mouseDClick(strip.view, LEFT, PLAIN, QPoint(600, 8))
    assert strip.view.axis.pixels == strip.view.axis.fitted_step
    pick(strip.menu_for(strip.view.find(at(*box(strip, 0, 0)))), "Play this texton")
    seen = set()
    state.source_changed.connect(lambda _, frame: seen.add(frame))
    settle(int(2500 * (motion.textons[0][1] - motion.textons[0][0] + 1) / state.fps))
    state.playback.stop()
    assert seen
    assert min(seen) >= motion.textons[0][0]
    assert max(seen) <= motion.textons[0][1]


def test_the_matrix_shows_and_moves_boundaries(composed: Shell, strip: object) -> None:
    """It comes in the preview's place, says how different two moments are, and drags along either side."""
    page = composed.pages.in_sight
    QTest.mouseClick(strip.matrix_button, LEFT)
    view = page.matrix.view
    wait_for(lambda: view.isVisible() and view.strip.count > 0)
    settle(50)
    seen = view.window_
    where = at(seen.place(3.5, 0), seen.place(9.5, 1))
    hover(view, where)
    words = view.words_at(where)
    assert words.startswith(f"Frames 3 and 9: {view.distance(3, 9):.3f}")
    assert strip.view.strip.motions[0].reason in words
    QTest.mouseClick(view, LEFT, PLAIN, where)
    assert page.state.source_frame == 3
    before = strip.view.strip.boundaries
    x, y = seen.place(before[1] - 12, 0), seen.place(before[1], 1)
    drag(view, (x, y), (x, seen.place(before[1] + 3, 1)))
    assert label_of(composed) == f"Move a boundary of Gym, frame {before[1]} to {before[1] + 3}"
    wait_for(lambda: view.strip.boundaries == (before[0], before[1] + 3, *before[2:]))
    quiet(composed)
    page.matrix.closed.emit()
    assert page.side.currentWidget() is page.preview
    assert not strip.matrix_button.isChecked()


def test_colours_follow_the_look(composed: Shell, strip: object) -> None:
    """Light or dark, motions have the colours of that look, in the strip and on the cards."""
    shown = composed.pages.in_sight.library.cards
    for look in (theme.LIGHT, theme.DARK):
        composed.do("light")
        settle(50)
        assert theme.active() is look
        assert {motion.colour for motion in strip.view.strip.motions} <= set(look.tracks)
        assert {piece.colour for card in shown.cards for piece in card.strip} <= set(look.tracks)
