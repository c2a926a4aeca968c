"""What the 3D panel shows before there is a character: one sentence, one thing to do."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.window.controls import Pictogram, button, label


class Empty(QWidget):
    """``wanted`` names the command that a button stands for."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setSpacing(12)
        column.addStretch(2)
        column.addWidget(Pictogram("character", size=56))
        self.sentence = label("Choose a character mesh.", "brand")
        self.how = label("It will move as the filmed subject does. A mesh can be dropped here as well.", "label")
        self.tracks = label("No tracks yet: add points in Video (F1).", "label")
        for widget in (self.sentence, self.how, self.tracks):
            widget.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(widget)
        self.how.setWordWrap(True)
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        self.choose = button(
            "Choose a mesh…", lambda: self.wanted.emit("add_character"), primary=True, name="character"
        )
        self.sample = button("Open the sample", lambda: self.wanted.emit("sample"), name="sample")
        row.addWidget(self.choose)
        row.addWidget(self.sample)
        row.addStretch(1)
        column.addLayout(row)
        column.addStretch(3)

    def show_missing(self, characters: bool, tracks: bool) -> None:
        """Say what there is not yet."""
        self.tracks.setVisible(not tracks)
