"""The line below the inspector: what is worst in the whole motion, and a button that goes there."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.actions.checking import Check, Problem
from app.window import icons, theme
from app.window.controls import button, icon_button, label, separator


class WarningLine(QWidget):
    """``wanted`` names the problem to go to: "worst", "next" or "previous"."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 0, 12, 10)
        column.setSpacing(8)
        column.addWidget(separator())
        row = QHBoxLayout()
        row.setSpacing(8)
        self.icon = QLabel()
        self._picture: tuple[str, str, str] = ("", "", "")
        self.text = label("", "label")
        self.text.setWordWrap(True)
        row.addWidget(self.icon, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.text, 1)
        column.addLayout(row)
        below = QHBoxLayout()
        below.setSpacing(2)
        self.count = label("", "caption")
        before, after = (
            icon_button(icon, text, lambda name=name: self.wanted.emit(name), key)
            for icon, text, name, key in (
                ("previous", "The problem before", "previous", "previous_problem"),
                ("next", "The next problem", "next", "next_problem"),
            )
        )
        self.steps = (before, after)
        self.show_button = button("Show", lambda: self.wanted.emit("worst"), name="go")
        below.addWidget(self.count, 1)
        for step in self.steps:
            below.addWidget(step)
        below.addSpacing(6)
        below.addWidget(self.show_button)
        column.addLayout(below)

    def show_check(self, check: Check | None, *, measuring: bool, at: Problem | None) -> None:
        """Show the worst of a check; the one that was gone to last where there is one."""
        problems = check.problems if check is not None else ()
        shown = at if at in problems else problems[0] if problems else None
        token, name = ("warn", "warning") if shown is not None else ("ok", "right")
        if shown is not None:
            text = shown.text
        elif check is not None:
            text = "No problem was found"
        else:
            text, token, name = ("Looking for problems…" if measuring else "Not checked yet"), "text3", "note"
        picture = (name, token, theme.active().name)
        if picture != self._picture:
            self._picture = picture
            self.icon.setPixmap(icons.pixmap(name, token, 18))
        self.text.setText(text)
        self.show_button.setEnabled(shown is not None)
        place = problems.index(shown) + 1 if shown is not None else 0
        count = f"{place} of {len(problems)}, worst first" if len(problems) > 1 else ""
        self.count.setText(count)
        for step in self.steps:
            step.setVisible(len(problems) > 1)
