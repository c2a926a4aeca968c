"""A page of the dialog: what is chosen at the left, a frame of it at the right, below where it goes."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.window.controls import Panel, ScrollColumn
from app.window.project import Project
from app.window.render.preview import Preview
from app.window.render.target import TargetLine

WIDTH = 316
WIDE = 108
"""Width of the captions beside controls."""
VIDEO = "Film (*.mp4)"


class Page(QWidget):
    """``asked`` names a command of the window that gets what is missing."""

    asked = Signal(str)
    icon = "render"
    plain = "As it will be written."

    def __init__(self, project: Project, options: ScrollColumn, name: str, verb: str) -> None:
        super().__init__()
        self.project = project
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 12, 12, 12)
        column.setSpacing(12)
        inner = QHBoxLayout()
        inner.setSpacing(12)
        panel = Panel()
        panel.setFixedWidth(WIDTH)
        options.rows.setContentsMargins(12, 12, 12, 12)
        options.rows.setSpacing(7)
        panel.column.addWidget(options)
        self.preview = Preview(project, self.plain)
        inner.addWidget(panel)
        inner.addWidget(self.preview, 1)
        column.addLayout(inner, 1)
        self.target = TargetLine(project, name, verb, self.icon)
        column.addWidget(self.target)
        self.preview.asked.connect(self.asked)

    def refresh(self) -> None:
        """Show the project and the choice as they are."""

    def close_calls(self, *, wait: bool) -> None:
        """End the thread of the preview; ``wait`` until it has ended."""
        self.preview.close_calls(wait=wait)
