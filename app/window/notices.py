"""Questions about the open document, in bars under the top of the window: never a box that stops the work."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from app.window import icons
from app.window.controls import button, icon_button

Answer = tuple[str, Callable[[], object]]
LEVELS = {"error": ("err", "error"), "warn": ("warn", "warning"), "note": ("accent", "note")}
MANY = 3
"""Questions that are shown at once; the others come up when these are answered."""


class Notice(QFrame):
    """One sentence and its answers; each answer closes it."""

    def __init__(self, name: str, sentence: str, answers: Sequence[Answer], level: str, closed: Callable[[], object]):
        super().__init__()
        self.name = name
        self.setObjectName("errorBar")
        self.setProperty("level", level)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        token, icon = LEVELS[level]
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 5, 6, 5)
        row.setSpacing(8)
        picture = QLabel()
        picture.setPixmap(icons.icon(icon, token).pixmap(QSize(18, 18)))
        self.sentence = QLabel(sentence)
        self.sentence.setTextFormat(Qt.TextFormat.PlainText)
        self.sentence.setWordWrap(True)
        row.addWidget(picture)
        row.addWidget(self.sentence, 1)
        self.buttons = {}
        for number, (text, call) in enumerate(answers):
            made = button(text, lambda call=call: (closed(), call()), primary=number == 0)
            self.buttons[text] = made
            row.addWidget(made)
        if not answers:
            row.addWidget(icon_button("close", "Close this message", closed))


class Notices(QWidget):
    """The questions that are open, the newest at the bottom; nothing is seen where there are none."""

    def __init__(self) -> None:
        super().__init__()
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(8, 8, 8, 0)
        self._column.setSpacing(4)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.open: dict[str, Notice] = {}
        self.hide()

    def ask(self, name: str, sentence: str, *answers: Answer, level: str = "warn") -> Notice:
        """Ask something, in place of what was asked under the same name."""
        self.drop(name)
        notice = Notice(name, sentence, answers, level, lambda: self.drop(name))
        self.open[name] = notice
        self._column.addWidget(notice)
        self._show()
        return notice

    def drop(self, name: str) -> None:
        """Ask no more."""
        notice = self.open.pop(name, None)
        if notice is not None:
            notice.hide()
            self._column.removeWidget(notice)
            notice.deleteLater()
            self._show()

    def drop_all(self) -> None:
        """Ask nothing any more: another project is open."""
        for name in tuple(self.open):
            self.drop(name)

    def _show(self) -> None:
        for number, notice in enumerate(self.open.values()):
            notice.setVisible(number < MANY)
        self.setVisible(bool(self.open))
