"""Drawn masks are edited with real mouse and keys: corners, edges, the whole, onion skin, the loupe."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import scene
from app.model.values import KeyMask, Lasso
from app.window.shell import Shell
from app.window.video import mask_editing
from tests.window.conftest import _move, at, drag, settle, wait_for

LEFT = Qt.MouseButton.LeftButton
SQUARE = ((60.0, 40.0), (140.0, 40.0), (140.0, 100.0), (60.0, 100.0))


def test_parts_of_a_mask_are_found_corners_first() -> None:
    """The last lasso lies on top; insides count only where they are asked for."""
    key = KeyMask((Lasso(SQUARE), Lasso(((90.0, 60.0), (110.0, 60.0), (100.0, 80.0)), True)))
    assert mask_editing.part_at(key, (61, 41), 2.0, whole=True) == "corner/0/0"
    assert mask_editing.part_at(key, (100, 40.5), 2.0, whole=True) == "edge/0/0"
    assert mask_editing.part_at(key, (100, 66), 2.0, whole=True) == "lasso/1"
    assert mask_editing.part_at(key, (75, 90), 2.0, whole=True) == "lasso/0"
    assert mask_editing.part_at(key, (75, 90), 2.0, whole=False) == ""
    assert mask_editing.part_at(None, (75, 90), 2.0, whole=True) == ""


def test_a_drawn_line_keeps_the_corners_it_needs() -> None:
    """A circle of 400 points is left with few, none farther away than the tolerance; corners of a square stay."""
    angles = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    circle = tuple(zip((50 * np.cos(angles)).tolist(), (50 * np.sin(angles)).tolist(), strict=True))
    few = np.array(mask_editing.simplified(circle, 0.5))
    assert 12 <= len(few) <= 60
    middles = (few + np.roll(few, -1, axis=0)) / 2
    assert np.hypot(*middles.T).min() > 49.2
    assert mask_editing.simplified(SQUARE, 1.0) == SQUARE


def masked(shell: Shell, frame: int = 0) -> None:
    """Draw a square mask; what would follow from it is not computed here."""
    assert shell.project is not None
    shell.opened.keeper.automatic = False
    shell.project.edit(scene.add_lasso, frame, SQUARE)
    shell.project.close_gesture()
    for track in shell.project.document.tracks:
        from app.model.edits import tracks

        shell.project.edit(tracks.set_track_look, track.id, visible=False, gesture="hide all")
    shell.project.close_gesture()
    settle()


def lasso(shell: Shell, number: int = 0) -> tuple[tuple[float, float], ...]:
    """The corners of a lasso of frame 0."""
    return shell.project.document.masks[0].lassos[number].points


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_corner_edge_and_inside_are_dragged_each_one_entry(shell: Shell) -> None:
    """A corner moves, an edge gets a corner, the inside moves all; undo by Ctrl+Z gives each step back exactly."""
    masked(shell)
    canvas, view = shell.video.canvas, shell.video.canvas.view
    versions = shell.project.session.history.versions
    entries, before = len(versions), shell.project.document
    start, end = view.point(60, 40), view.point(50, 30)
    drag(canvas, start, end, release=False)
    assert len(versions) == entries, "nothing is decided while the button is down"
    assert np.allclose(shell.video.shown.mask_moving.lassos[0].points[0], (50, 30), atol=0.5)
    QTest.mouseRelease(canvas, LEFT, pos=at(*end))
    assert np.allclose(lasso(shell)[0], (50, 30), atol=0.5)
    drag(canvas, view.point(140, 70), view.point(155, 72))
    assert len(lasso(shell)) == 5
    assert np.allclose(lasso(shell)[2], (155, 72), atol=0.5)
    was = np.array(lasso(shell))
    drag(canvas, view.point(100, 60), view.point(110, 65))
    assert np.allclose(np.array(lasso(shell)) - was, (10, 5), atol=0.5)
    labels = [version.label for version in shell.project.session.history.versions[-3:]]
    assert labels == ["Move mask point, frame 0", "Add mask point, frame 0", "Move the lasso, frame 0"]
    for _ in range(3):
        QTest.keyClick(shell, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert shell.project.document == before


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_delete_takes_the_chosen_corner_or_the_chosen_lasso(shell: Shell) -> None:
    """A click chooses; Delete removes; with no part chosen it is the mask of the frame."""
    masked(shell)
    canvas, view = shell.video.canvas, shell.video.canvas.view
    QTest.mouseClick(canvas, LEFT, pos=at(*view.point(140, 100)))
    assert shell.video.shown.mask_part == "corner/0/2"
    QTest.keyClick(shell, Qt.Key.Key_Delete)
    assert len(lasso(shell)) == 3
    QTest.mouseClick(canvas, LEFT, pos=at(*view.point(80, 55)))
    QTest.keyClick(shell, Qt.Key.Key_Delete)
    assert 0 not in shell.project.document.masks


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_m_draws_and_its_corners_can_be_pulled_at_once(shell: Shell) -> None:
    """M is the lasso; its own corners can be pulled without another tool; Escape puts a corner back."""
    masked(shell)
    QTest.keyClick(shell, Qt.Key.Key_M)
    assert shell.video.tool == "lasso"
    canvas, view = shell.video.canvas, shell.video.canvas.view
    drag(canvas, view.point(60, 40), view.point(40, 30))
    assert np.allclose(lasso(shell)[0], (40, 30), atol=0.5)
    before = shell.project.document
    drag(canvas, view.point(140, 40), view.point(160, 20), release=False)
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    QTest.mouseRelease(canvas, LEFT, pos=at(*view.point(160, 20)))
    assert shell.project.document is before
    assert shell.video.shown.mask_moving is None


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_onion_skin_shows_the_neighbouring_masks(shell: Shell) -> None:
    """In a frame between, the switch draws the masks before and after, and takes them away again."""
    masked(shell, 0)
    shell.project.edit(scene.add_lasso, 10, [(x + 20, y) for x, y in SQUARE])
    shell.project.show_frame(5)
    wait_for(lambda: shell.video.frame == 5)
    settle()
    bare = shell.video.canvas.grab().toImage()
    QTest.mouseClick(shell.video.onion_button, LEFT)
    settle()
    layer = next(each for each in shell.video.canvas._layers if hasattr(each, "outlines"))
    assert [outline.kind for outline in layer.outlines] == ["before", "after"]
    assert shell.video.canvas.grab().toImage() != bare
    QTest.mouseClick(shell.video.onion_button, LEFT)
    settle()
    assert shell.video.canvas.grab().toImage() == bare


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_the_loupe_stays_on_during_a_drag_and_follows_it(shell: Shell) -> None:
    """Z, press and move: the loupe is drawn where the mouse is."""
    masked(shell)
    canvas, view = shell.video.canvas, shell.video.canvas.view
    QTest.keyClick(shell, Qt.Key.Key_Z)
    drag(canvas, view.point(60, 40), view.point(90, 60), release=False)
    with_loupe = canvas.grab().toImage()
    _move(canvas, at(*view.point(92, 62)), LEFT, Qt.KeyboardModifier.NoModifier)
    assert canvas.grab().toImage() != with_loupe
    assert canvas.busy
    canvas.magnify = False
    assert canvas.grab().toImage() != with_loupe
    QTest.mouseRelease(canvas, LEFT, pos=at(*view.point(92, 62)))
