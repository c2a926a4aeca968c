"""History and messages beside the workspaces: going to an entry by a click, what was said is kept."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QListWidget

from app.model.edits.tracks import add_track, rename_track
from app.window import settings
from app.window.shell import Shell
from tests.window.conftest import settle

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
CONTROL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def edited(shell: Shell) -> Shell:
    """The window on the small project, panel closed, with three points added."""
    shell.side.open_page("")
    project = shell.project
    assert project is not None
    for name in ("ear", "elbow", "heel"):
        project.edit(add_track, 0, (20.0, 20.0), name=name)
    settle()
    return shell


def click_row(panel: QListWidget, row: int) -> None:
    """Click a row as a person does."""
    panel.scrollToItem(panel.item(row))
    QTest.mouseClick(panel.viewport(), LEFT, pos=panel.visualItemRect(panel.item(row)).center())
    settle()


def test_a_click_in_the_history_goes_there_and_back(edited: Shell) -> None:
    """Ctrl+H opens it; a click on an earlier entry takes back what came after, a click on the last brings it again."""
    shell, project = edited, edited.project
    assert project is not None
    after = project.document
    assert not shell.side.isVisible()
    QTest.keyClick(shell, Qt.Key.Key_H, CONTROL)
    assert shell.side.isVisible()
    panel = shell.side.history
    history = project.session.history
    assert panel.count() == len(history.versions)
    assert panel.currentRow() == history.present
    last = history.present
    click_row(panel, last - 2)
    assert [track.name for track in project.document.tracks][-1] == "ear"
    assert panel.currentRow() == last - 2
    assert panel.item(last).foreground() != panel.item(last - 2).foreground(), "what redo brings back is dim"
    click_row(panel, last)
    assert project.document == after
    QTest.keyClick(shell, Qt.Key.Key_H, CONTROL)
    assert not shell.side.isVisible()


def test_an_edit_after_going_back_drops_the_rest(edited: Shell) -> None:
    """The list follows edits, undo by key, and a cut-off branch."""
    shell, project = edited, edited.project
    assert project is not None
    shell.side.open_page("history")
    panel = shell.side.history
    rows = panel.count()
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert (panel.count(), panel.currentRow()) == (rows, rows - 2)
    project.edit(rename_track, project.document.tracks[-1].id, "knee")
    settle()
    assert (panel.count(), panel.currentRow()) == (rows, rows - 1)
    assert "knee" in panel.item(rows - 1).text()


def test_messages_are_kept_with_their_details(edited: Shell) -> None:
    """What the bar said and was closed can be read again and copied; the panel is remembered as open."""
    shell = edited
    shell.tell("The clip cannot be read.", "Traceback of the reader")
    shell.tell_note("The film is written.")
    QTest.keyClick(shell, Qt.Key.Key_L, CONTROL)
    log = shell.side.log
    assert [log.list.item(row).toolTip() for row in (0, 1)] == ["The film is written.", "The clip cannot be read."]
    click_row(log.list, 1)
    assert log.details.isVisible()
    assert "Traceback" in log.details.toPlainText()
    QTest.mouseClick(log.copy_button, LEFT)
    assert "Traceback of the reader" in QGuiApplication.clipboard().text()
    assert settings.settings().value("side") == "log"
    QTest.mouseClick(log.clear_button, LEFT)
    assert log.list.count() == 0
    assert not log.details.isVisible()
