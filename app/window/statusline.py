"""The line at the bottom: what the mouse will do now, and at the right what there is."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.window.controls import Elided, label


class StatusLine(QWidget):
    """One sentence at the left, counts and the kind of 3D drawing at the right."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("statusLine")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedHeight(28)
        row = QHBoxLayout(self)
        row.setContentsMargins(14, 0, 14, 0)
        row.setSpacing(16)
        self.hint = Elided("", "label")
        self.counts = label("", "label")
        self.device = label("", "caption")
        row.addWidget(self.hint, 1)
        row.addWidget(self.counts)
        row.addWidget(self.device)

    def show_hint(self, sentence: str) -> None:
        """Say what the mouse will do."""
        if sentence != self.hint.text():
            self.hint.setText(sentence)
            self.hint.update()

    def show_counts(self, text: str) -> None:
        """Say what there is."""
        self.counts.setText(text)
