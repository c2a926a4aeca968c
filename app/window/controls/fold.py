"""A section under a title that folds it away."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.window import icons
from app.window.controls.labels import label, separator
from app.window.controls.own_keys import PressKeys


class Fold(QWidget):
    """``column`` takes the rows; ``caption`` says at the right what is inside, folded or not."""

    def __init__(self, title: str, *, opened: bool = True) -> None:
        super().__init__()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(6)
        outer.addWidget(separator())
        row = QHBoxLayout()
        row.setSpacing(8)
        self.head = QToolButton()
        self.head.setText(title)
        self.head.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.head.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.caption = label("", "caption")
        self.head.setMinimumHeight(24)
        PressKeys(self.head)
        row.addWidget(self.head)
        row.addStretch(1)
        row.addWidget(self.caption)
        outer.addLayout(row)
        self.body = QWidget()
        self.column = QVBoxLayout(self.body)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(8)
        outer.addWidget(self.body)
        face = self.head.font()
        face.setWeight(QFont.Weight.DemiBold)
        self.head.setFont(face)
        self.head.clicked.connect(lambda: self._show(not self.opened))
        self._show(opened)

    def open(self) -> None:
        """Unfold it."""
        self._show(True)

    def _show(self, opened: bool) -> None:
        self.opened = opened
        self.head.setAccessibleDescription("unfolded" if opened else "folded")
        self.head.setIcon(icons.icon("unfolded" if opened else "folded", "text2", "text2"))
        self.body.setVisible(opened)
