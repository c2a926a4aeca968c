"""The strip of tools at the left of the picture."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QToolButton

from app.window.controls import Panel, tool
from app.window.video.tools import TOOLS


class ToolStrip(Panel):
    """One tool is in hand; ``chosen`` names the one that was clicked."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(64)
        self.column.setContentsMargins(3, 6, 3, 6)
        self.column.setSpacing(4)
        group = QButtonGroup(self)
        self.buttons: dict[str, QToolButton] = {}
        for name, text, key in TOOLS:
            each = tool(name, text, key)
            group.addButton(each)
            self.buttons[name] = each
            each.clicked.connect(lambda _=False, name=name: self.chosen.emit(name))
            self.column.addWidget(each, 0, Qt.AlignmentFlag.AlignHCenter)
        self.column.addStretch(1)
