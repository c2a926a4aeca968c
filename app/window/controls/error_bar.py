"""A bar at the top of the panel concerned: one sentence, what to do, details that can be copied."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPlainTextEdit, QSizePolicy, QToolButton, QVBoxLayout

from app.window import icons
from app.window.controls.buttons import button, icon_button


class ErrorBar(QFrame):
    """Hidden until something is to be said; never a modal box."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("errorBar")
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 5, 6, 5)
        column.setSpacing(4)
        row = QHBoxLayout()
        row.setSpacing(8)
        self._icon = QLabel()
        self.sentence = QLabel()
        self.sentence.setWordWrap(True)
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._action = button("", self._act)
        self._call: Callable[[], object] | None = None
        self._more = QToolButton()
        self._more.setText("Details")
        self._more.setProperty("toggle", "true")
        self._more.setCheckable(True)
        self._more.toggled.connect(self._unfold)
        row.addWidget(self._icon, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.sentence, 1)
        row.addWidget(self._action)
        row.addWidget(self._more)
        row.addWidget(icon_button("close", "Close this message", self.hide))
        column.addLayout(row)
        self.details = QPlainTextEdit()
        self.details.setReadOnly(True)
        self.details.setFixedHeight(110)
        column.addWidget(self.details)
        self._copy = button("Copy details", lambda: QGuiApplication.clipboard().setText(self.details.toPlainText()))
        column.addWidget(self._copy, 0, Qt.AlignmentFlag.AlignLeft)
        self.hide()

    def tell(
        self,
        sentence: str,
        details: str = "",
        *,
        level: str = "error",
        action: tuple[str, Callable[[], object]] | None = None,
    ) -> None:
        """Say one sentence; ``level`` is error, warn or note."""
        self.setProperty("level", level)
        self.style().unpolish(self)
        self.style().polish(self)
        token, name = {"error": ("err", "error"), "warn": ("warn", "warning"), "note": ("accent", "note")}[level]
        self._icon.setPixmap(icons.icon(name, token).pixmap(QSize(18, 18)))
        self.sentence.setText(sentence)
        self._call = action[1] if action else None
        self._action.setText(action[0] if action else "")
        self._action.setVisible(action is not None)
        self.details.setPlainText(details)
        self._more.setVisible(bool(details))
        self._more.setChecked(False)
        self._unfold(False)
        self.show()

    def _unfold(self, opened: bool) -> None:
        self.details.setVisible(opened)
        self._copy.setVisible(opened)

    def _act(self) -> None:
        self.hide()
        if self._call is not None:
            self._call()
