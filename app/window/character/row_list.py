"""Rows to choose from, each with small buttons at its end: pairs, and moves by frame."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFont, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import fonts, icons, theme

ROW, BUTTON = 26, 26
RIGHT = int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight)


@dataclass(frozen=True)
class Act:
    """A small button: what it is called, its icon, and what it does in words."""

    name: str
    icon: str
    text: str


@dataclass(frozen=True)
class Entry:
    """One row.

    id : what it stands for. text, caption : at the left, and paler at the right. colour : of its dot, none for none.
    head : it is a heading of those below it. faint : it does not count. lit : it is the present one.
    """

    id: str
    text: str
    caption: str = ""
    colour: str = ""
    acts: tuple[Act, ...] = ()
    head: bool = False
    faint: bool = False
    lit: bool = False


class RowList(QWidget):
    """``chosen`` gives the id of a row, ``acted`` the id and the name of a button, ``pointed`` the row under the mouse.

    Up, Down and Return choose, Delete presses the last button of a row.
    """

    chosen = Signal(str)
    acted = Signal(str, str)
    pointed = Signal(str)

    def __init__(self, name: str) -> None:
        super().__init__()
        self.entries: tuple[Entry, ...] = ()
        self.at, self._under = 0, -1
        self.setAccessibleName(name)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def show_entries(self, entries: tuple[Entry, ...]) -> None:
        """Show other rows; those that are alike are not drawn again."""
        if entries != self.entries:
            self.entries = entries
            self.at = min(self.at, max(len(entries) - 1, 0))
            self.setFixedHeight(len(entries) * ROW)
            self.setVisible(bool(entries))
            self.update()

    def sizeHint(self) -> QSize:
        """As high as the rows."""
        return QSize(200, len(self.entries) * ROW)

    def place_of(self, row_id: str, act: str = "") -> QPointF:
        """The middle of a row, or of one of its buttons."""
        number = next(number for number, entry in enumerate(self.entries) if entry.id == row_id)
        names = [each.name for each in self.entries[number].acts]
        x = self.width() - BUTTON * (len(names) - names.index(act) - 0.5) if act else 40.0
        return QPointF(x, (number + 0.5) * ROW)

    def _row(self, y: float) -> int:
        number = int(y // ROW)
        return number if 0 <= number < len(self.entries) else -1

    def _act(self, number: int, x: float) -> Act | None:
        acts = self.entries[number].acts
        place = int((x - (self.width() - BUTTON * len(acts))) // BUTTON)
        return acts[place] if acts and 0 <= place < len(acts) else None

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a row, or press one of its buttons."""
        number = self._row(event.position().y())
        if number < 0 or event.button() != Qt.MouseButton.LeftButton:
            return
        self.at = number
        act = self._act(number, event.position().x())
        if act is None:
            self.chosen.emit(self.entries[number].id)
        else:
            self.acted.emit(self.entries[number].id, act.name)
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Say what a click would do, and which row is pointed at."""
        number = self._row(event.position().y())
        act = self._act(number, event.position().x()) if number >= 0 else None
        self.setToolTip(act.text if act is not None else "")
        self._point(number)

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is pointed at any more."""
        self._point(-1)

    def _point(self, number: int) -> None:
        if number != self._under:
            self._under = number
            self.pointed.emit(self.entries[number].id if number >= 0 else "")
            self.update()

    def event(self, event: QEvent) -> bool:
        """Keep the keys of the list while it has the focus."""
        keys = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Delete)
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() in keys:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move, choose, remove."""
        if event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down) and self.entries:
            step = 1 if event.key() == Qt.Key.Key_Down else -1
            self.at = min(max(self.at + step, 0), len(self.entries) - 1)
            self.update()
        elif event.key() == Qt.Key.Key_Return and self.entries:
            self.chosen.emit(self.entries[self.at].id)
        elif event.key() == Qt.Key.Key_Delete and self.entries and self.entries[self.at].acts:
            self.acted.emit(self.entries[self.at].id, self.entries[self.at].acts[-1].name)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the rows."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for number, entry in enumerate(self.entries):
            self._paint(painter, number, entry)
        painter.end()

    def _paint(self, painter: QPainter, number: int, entry: Entry) -> None:
        look, top = theme.active(), float(number * ROW)
        painter.setPen(Qt.PenStyle.NoPen)
        if entry.lit or number == self._under:
            painter.setBrush(look.colour("hover"))
            painter.drawRoundedRect(QRectF(0, top + 1, self.width(), ROW - 2), 4, 4)
        if number == self.at and self.hasFocus():
            painter.setPen(QPen(look.colour("accent"), 2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(1, top + 1, self.width() - 2, ROW - 2), 4, 4)
            painter.setPen(Qt.PenStyle.NoPen)
        left = 34.0 if not entry.head and not entry.colour else 22.0
        if entry.colour:
            painter.setBrush(look.colour(entry.colour))
            painter.drawEllipse(QPointF(left - 10, top + ROW / 2), 4.5, 4.5)
        right = self.width() - BUTTON * len(entry.acts) - 4
        painter.setFont(fonts.font(fonts.CAPTION))
        wide = QFontMetricsF(painter.font()).horizontalAdvance(entry.caption) + 8 if entry.caption else 0.0
        painter.setPen(look.colour("text3"))
        painter.drawText(QRectF(right - wide, top, wide, ROW), RIGHT, entry.caption)
        weight = QFont.Weight.DemiBold if entry.head else QFont.Weight.Normal
        painter.setFont(fonts.font(fonts.CAPTION, weight))
        painter.setPen(look.colour("text3" if entry.faint else "text"))
        room = right - wide - left
        text = QFontMetricsF(painter.font()).elidedText(entry.text, Qt.TextElideMode.ElideRight, room)
        painter.drawText(QRectF(left, top, room, ROW), Qt.AlignmentFlag.AlignVCenter, text)
        for place, act in enumerate(entry.acts):
            x = self.width() - BUTTON * (len(entry.acts) - place) + (BUTTON - 16) / 2
            token = "text2" if number == self._under or entry.lit else "text3"
            painter.drawPixmap(QPointF(x, top + ROW / 2 - 8), icons.pixmap(act.icon, token, 16))
