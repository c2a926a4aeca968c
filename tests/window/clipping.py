"""Whether words and buttons have the room they need."""

from __future__ import annotations

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QApplication, QLabel, QPushButton, QWidget

from app.window.controls import ScrollColumn
from app.window.shell import Shell


def assert_nothing_clipped(shell: Shell) -> None:
    """No inspector is wider than its column and no button or label in sight cuts its text."""
    assert_whole(shell)
    assert shell.pages.height() > 250


def assert_whole(shell: QWidget) -> None:
    """The same of any window."""
    for _ in range(3):  # a text that was set this moment gets its room in the next turn of the loop, unseen until then
        QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
    for column in shell.findChildren(ScrollColumn):
        if column.isVisible():
            assert column.widget().width() <= column.viewport().width() + 1
    for widget in shell.findChildren(QPushButton):
        if widget.isVisible():
            assert widget.width() >= widget.minimumSizeHint().width() - 1, widget.text()
    for label in shell.findChildren(QLabel):
        if label.isVisible() and type(label).__name__ == "QLabel" and not label.wordWrap():
            assert label.width() >= label.sizeHint().width() - 1, label.text()
