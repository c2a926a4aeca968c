"""What an empty project shows: one sentence, one thing to do, and the sample."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.window import icons
from app.window.controls import ErrorBar, Panel, button, label


class Welcome(Panel):
    """Lies where the picture will be."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.errors = ErrorBar()
        self.column.addWidget(self.errors)
        body = QWidget()
        column = QVBoxLayout(body)
        column.setSpacing(12)
        column.addStretch(2)
        picture = QLabel()
        picture.setPixmap(icons.pixmap("video", "text3", 56))
        sentence = label("Open a video, or drop one here.", "brand")
        how = label(
            "Motionwright follows points that you click on a filmed animal or person, and moves a character like it.",
            "label",
        )
        for widget in (picture, sentence, how):
            widget.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(widget)
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        self.open = button("Open a video", lambda: self.wanted.emit("add_clip"), primary=True, name="open")
        self.sample = button("Open the sample", lambda: self.wanted.emit("sample"), name="sample")
        self.project = button("Open a project", lambda: self.wanted.emit("open"), name="open")
        for each in (self.open, self.sample, self.project):
            row.addWidget(each)
        row.addStretch(1)
        column.addSpacing(8)
        column.addLayout(row)
        column.addStretch(3)
        self.column.addWidget(body, 1)
