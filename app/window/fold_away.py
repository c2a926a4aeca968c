"""A column beside the picture that folds to a thin strip, so that a small window keeps its picture."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QSplitter, QToolButton, QVBoxLayout, QWidget

from app.window import fonts, icons, settings, theme
from app.window.controls import set_tooltip
from app.window.controls.own_keys import PressKeys

NARROW = 1280
"""Pixels of the window's width below which the column is folded until the user unfolds it."""
GRIP, STRIP, GAP = 12, 32, 8
QWIDGETSIZE_MAX = (1 << 24) - 1
"""What Qt calls no limit."""


class FoldAway(QWidget):
    """``column`` takes what is folded; what a person chose is kept for each workspace, for wide and narrow windows.

    It has the width given, or without one that which a splitter gives it.

    Attributes
    ----------
    folded : whether only the strip is there.
    """

    def __init__(self, name: str, title: str, width: int = 0) -> None:
        super().__init__()
        self._name, self._wide = name, True
        self.folded = False
        self.body = QWidget()
        self._split, self._last = not width, 0
        if width:
            self.body.setFixedWidth(width)
        self.column = QVBoxLayout(self.body)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(8)
        self.grip = _arrow("fold_away", QSize(GRIP if width else GAP, 56), self.toggle)
        self.strip = Strip(title)
        self.strip.pressed.connect(self.toggle)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self._row = row
        row.addWidget(self.grip, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.body, 1)
        row.addWidget(self.strip)
        set_tooltip(self.grip, "Fold this column away", "inspector")
        set_tooltip(self.strip.button, "Unfold this column", "inspector")
        self._show(False)

    def fit(self, window_width: int) -> None:
        """Fold or unfold as was chosen for a window of this width; a narrow one is folded where nothing was chosen."""
        self._wide = window_width >= NARROW
        if self._split and not self.isVisible():
            return  # the splitter has no sizes yet that could be shared out
        chosen = settings.settings().value(self._key())
        self._show(not self._wide if chosen is None else str(chosen).lower() == "true")

    def showEvent(self, event: QShowEvent) -> None:
        """Fit into the window when it is first seen."""
        super().showEvent(event)
        if self._split:
            QTimer.singleShot(0, self, lambda: self.fit(self.window().width()))

    def toggle(self) -> None:
        """Fold it, or unfold it, now and whenever the window is about as wide."""
        settings.settings().setValue(self._key(), not self.folded)
        self._show(not self.folded)

    def unfold(self) -> None:
        """Show it for now, because something in it was asked for."""
        self._show(False)

    def _key(self) -> str:
        return f"folded/{self._name}/{'wide' if self._wide else 'narrow'}"

    def _show(self, folded: bool) -> None:
        held = self.body.isAncestorOf(self.focusWidget()) if self.focusWidget() is not None else False
        changed, self.folded = folded != self.folded, folded
        if changed and self._split:
            self._give_room(folded)
        self._row.setContentsMargins(0 if self._split or not folded else GAP, 0, 0, 0)
        self.body.setVisible(not folded)
        self.grip.setVisible(not folded)
        self.strip.setVisible(folded)
        if folded and held:
            self.window().setFocus()

    def _give_room(self, folded: bool) -> None:
        """In a splitter, leave all but the strip to the part before, or take back what was had."""
        self.setMaximumWidth(STRIP if folded else QWIDGETSIZE_MAX)
        splitter = self.parentWidget()
        if not isinstance(splitter, QSplitter):
            return
        sizes, place = splitter.sizes(), splitter.indexOf(self)
        if folded:
            self._last = sizes[place]
        wanted = STRIP if folded else self._last
        sizes[place - 1] += sizes[place] - wanted
        sizes[place] = wanted
        splitter.setSizes(sizes)


class Strip(QWidget):
    """What is left of a folded column: an arrow, and its title from top to bottom; all of it can be pressed."""

    pressed = Signal()

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title = title
        self.setObjectName("panel")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedWidth(STRIP)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.button = _arrow("unfold", QSize(26, 26), self.pressed.emit)
        column = QVBoxLayout(self)
        column.setContentsMargins(3, 5, 3, 5)
        column.addWidget(self.button, 0, Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignHCenter)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Press it."""
        if event.button() == Qt.MouseButton.LeftButton and self.rect().contains(event.position().toPoint()):
            self.pressed.emit()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Write the title."""
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setFont(fonts.font(fonts.CAPTION))
        painter.setPen(theme.active().colour("text2"))
        painter.translate(self.width(), 40)
        painter.rotate(90)
        painter.drawText(0, 0, self.height() - 48, self.width(), int(Qt.AlignmentFlag.AlignVCenter), self.title)
        painter.end()


def _arrow(icon: str, size: QSize, call: object) -> QToolButton:
    made = QToolButton()
    made.setProperty("grip", "true")
    made.setIcon(icons.icon(icon, "text2", "text"))
    made.setIconSize(QSize(18, 18) if icon == "unfold" else QSize(14, 14))
    made.setFixedSize(size)
    made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    made.setAccessibleName("Fold the column" if icon == "fold_away" else "Unfold the column")
    made.clicked.connect(lambda: call())  # type: ignore[operator]
    PressKeys(made)
    return made
