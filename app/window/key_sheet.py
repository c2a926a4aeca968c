"""The sheet of keys: every command with its key, in groups."""

from __future__ import annotations

from itertools import groupby

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDialog, QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from app.window.controls import Chip, label
from app.window.keys import COMMANDS


class KeySheet(QDialog):
    """Not modal: it may stay open beside the window."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        row = QHBoxLayout(self)
        row.setContentsMargins(20, 16, 20, 20)
        row.setSpacing(32)
        groups = [(name, list(commands)) for name, commands in groupby(COMMANDS, key=lambda each: each.group)]
        for members in (groups[:2], groups[2:3], groups[3:]):
            column = QVBoxLayout()
            column.setSpacing(8)
            for name, commands in members:
                column.addWidget(label(name, "title"))
                grid = QGridLayout()
                grid.setHorizontalSpacing(16)
                grid.setVerticalSpacing(4)
                keyed = [command for command in commands if command.keys]
                for number, command in enumerate(keyed):
                    grid.addWidget(label(command.text, "label"), number, 0)
                    grid.addWidget(Chip(command.keys[0].replace("Return", "Enter")), number, 1)
                column.addLayout(grid)
                column.addSpacing(8)
            column.addStretch(1)
            row.addLayout(column)

    def event(self, event: QEvent) -> bool:
        """Keep Escape for closing the sheet."""
        escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if event.type() == QEvent.Type.ShortcutOverride and escape:
            event.accept()
            return True
        return super().event(event)
