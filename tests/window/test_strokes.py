"""Strokes of keys move a point of the film by parts of a pixel."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.window.shell import Shell
from tests.window.conftest import settle

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def test_a_quarter_of_a_pixel_and_ten_times_as_far_with_shift(shell: Shell) -> None:
    """Two strokes of a row are one entry; each way is the way of its arrow."""
    project = shell.project
    track = project.document.tracks[0]
    project.select_track(track.id)
    settle()
    x, y = track.clicks[0]
    entries = len(project.session.history.versions)
    QTest.keyClick(shell, Qt.Key.Key_Right, CONTROL)
    QTest.keyClick(shell, Qt.Key.Key_Down, CONTROL | SHIFT)
    assert project.document.track(track.id).clicks[0] == pytest.approx((x + 0.25, y + 2.5))
    QTest.keyClick(shell, Qt.Key.Key_Left, CONTROL)
    QTest.keyClick(shell, Qt.Key.Key_Up, CONTROL | SHIFT)
    assert project.document.track(track.id).clicks[0] == pytest.approx((x, y))
    assert len(project.session.history.versions) <= entries + 1
    project.cancel_work()
