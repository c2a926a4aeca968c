"""What stands where nothing is yet: an icon, one sentence, how it goes on, and what to do."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from app.window.controls.buttons import button
from app.window.controls.labels import Pictogram, label


class Invitation(QWidget):
    """``wanted`` names the command that a button stands for.

    sentence : label of what is missing. more : labels below it. below : column of what else is offered there.
    """

    wanted = Signal(str)

    def __init__(self, icon: str, sentence: str, *more: str) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setSpacing(12)
        column.addStretch(2)
        column.addWidget(Pictogram(icon))
        self.sentence = label(sentence, "brand")
        self.more = [label(text, "label") for text in more]
        for each in (self.sentence, *self.more):
            each.setAlignment(Qt.AlignmentFlag.AlignCenter)
            each.setWordWrap(True)
            column.addWidget(each)
        self._row = QHBoxLayout()
        self._row.setSpacing(8)
        self._row.addStretch(1)
        self._row.addStretch(1)
        column.addSpacing(8)
        column.addLayout(self._row)
        column.addStretch(1)
        self.below = QVBoxLayout()
        column.addLayout(self.below)
        column.addStretch(2)

    def offer(self, text: str, command: str, *, primary: bool = False, icon: str = "") -> QPushButton:
        """Add a button for a command."""
        made = button(text, lambda: self.wanted.emit(command), primary=primary, name=icon)
        self._row.insertWidget(self._row.count() - 1, made)
        return made
