"""The list of points, the strip of confidence, and the path before a correction."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu

from app.window.shell import Shell
from app.window.video.point_list import ROW
from tests.window.conftest import at, drag, settle, wait_for
from tests.window.test_video_workspace import go, place_of, quiet, states

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton


def test_the_list_chooses_hides_and_recolours(shell: Shell) -> None:
    """A click on the eye hides, on the dot gives the next colour, on the name chooses; keys do the same."""
    shell.project.select_track("")
    settle()
    rows = shell.video.inspector.list
    assert rows.isVisible()
    first, second = shell.project.document.tracks[:2]
    QTest.mouseClick(rows, LEFT, pos=at(rows.width() - 10, ROW / 2))
    assert not shell.project.document.track(first.id).visible
    settle()
    assert first.id not in {mark.name for mark in shell.video._marks}
    QTest.mouseClick(rows, LEFT, pos=at(10, ROW * 1.5))
    assert shell.project.document.track(second.id).colour == (second.colour + 1) % 8
    rows.setFocus()
    QTest.keyClick(rows, Qt.Key.Key_Up)
    QTest.keyClick(rows, Qt.Key.Key_Space)
    assert shell.project.document.track(first.id).visible
    QTest.keyClick(rows, Qt.Key.Key_Down)
    QTest.keyClick(rows, Qt.Key.Key_Return)
    assert shell.project.track_id == second.id
    settle()
    assert not rows.isVisible()


def test_a_click_on_the_strip_goes_to_its_frame(shell: Shell) -> None:
    """The strip covers the whole clip."""
    shell.project.select_track(shell.project.document.tracks[0].id)
    settle()
    strip = shell.video.inspector.strip
    QTest.mouseClick(strip, LEFT, pos=at(strip.width() * 17.5 / 24, 10))
    assert shell.project.frame == 17


def test_the_old_path_stays_beside_the_new_one_until_something_else_is_chosen(shell: Shell) -> None:
    """After a correction is solved, the path before it is still drawn; another point ends the comparison."""
    go(shell, 12)
    track = shell.project.document.tracks[2]
    old = shell.video.reading.track(track).positions.copy()
    x, y = place_of(shell, track.id)
    drag(shell.video.canvas, (x, y), (x + 16, y - 8))
    wait_for(lambda: set(states(shell, track.id).values()) == {"fresh"} and quiet(shell), 60)
    wait_for(lambda: track.id in shell.video.shown.compared, 5)
    assert np.array_equal(shell.video.shown.compared[track.id], old, equal_nan=True)
    assert not shell.video.shown.before
    shell.project.select_track(shell.project.document.tracks[0].id)
    settle()
    assert not shell.video.shown.compared


def test_the_menu_of_a_point_does_what_its_keys_do(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """A right click chooses the point and offers its acts; one of them is done by the menu."""
    go(shell, 5)
    track = next(each for each in shell.project.document.tracks if not each.contacts)
    opened: list[QMenu] = []
    monkeypatch.setattr(QMenu, "popup", lambda menu, place: opened.append(menu))
    QTest.mouseClick(shell.video.canvas, Qt.MouseButton.RightButton, pos=at(*place_of(shell, track.id)))
    (menu,) = opened
    assert shell.project.track_id == track.id
    texts = {action.text().split("\t")[0]: action for action in menu.actions()}
    assert {"Contact in this frame", "Hidden in this frame", "End here", "Rename", "Delete point"} <= set(texts)
    texts["Contact in this frame"].trigger()
    spans = [contact.span for contact in shell.project.document.track(track.id).contacts]
    assert [(span.first, span.last) for span in spans] == [(5, 5)]
