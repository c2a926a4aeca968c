"""A part of a panel that can be folded away."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton, QVBoxLayout, QWidget

from app.window import icons
from app.window.controls import separator


class Section(QWidget):
    """A title that folds what is below it away."""

    def __init__(self, title: str, inner: QWidget) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(6)
        column.addWidget(separator())
        self.head = QToolButton()
        self.head.setText(title)
        self.head.setProperty("toggle", "true")
        self.head.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.head.setCheckable(True)
        self.head.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.head.toggled.connect(self._fold)
        column.addWidget(self.head, 0, Qt.AlignmentFlag.AlignLeft)
        self.place = QWidget()
        room = QVBoxLayout(self.place)
        room.setContentsMargins(0, 0, 0, 0)
        room.addWidget(inner)
        column.addWidget(self.place)
        self._fold(False)

    def _fold(self, opened: bool) -> None:
        self.head.setIcon(icons.icon("unfolded" if opened else "folded", "text2", "text2"))
        self.place.setVisible(opened)
