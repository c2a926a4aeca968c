"""A row of colours to choose from, and small bars that show a share or an error with its limit."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import theme

STEP, RADIUS = 20, 6


class Swatches(QWidget):
    """Colours in a row; the chosen one has a ring. Left and right keys choose as well."""

    chosen = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.index = 0
        self.setFixedHeight(24)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName("Colour")

    def sizeHint(self) -> QSize:
        """Room for all colours."""
        return QSize(STEP * len(theme.active().tracks), 24)

    def set_index(self, index: int) -> None:
        """Show which colour is in use."""
        self.index = index
        self.update()

    def _choose(self, index: int) -> None:
        if 0 <= index < len(theme.active().tracks) and index != self.index:
            self.set_index(index)
            self.chosen.emit(index)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the colour under the mouse."""
        self._choose(int(event.position().x() // STEP))

    def event(self, event: QEvent) -> bool:
        """Keep the arrow keys while the row has the focus."""
        arrows = (Qt.Key.Key_Left, Qt.Key.Key_Right)
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() in arrows:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Choose the neighbour."""
        if event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._choose(self.index + (1 if event.key() == Qt.Key.Key_Right else -1))
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the colours."""
        look = theme.active()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for number, colour in enumerate(look.tracks):
            centre = QPointF(STEP * number + STEP / 2, self.height() / 2)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour(colour))
            painter.drawEllipse(centre, RADIUS, RADIUS)
            if number == self.index:
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.setPen(QPen(look.colour("accent" if self.hasFocus() else "text"), 1.6))
                painter.drawEllipse(centre, RADIUS + 3, RADIUS + 3)
        painter.end()


class Meter(QWidget):
    """A thin bar from nothing to full, with a tick at a limit."""

    def __init__(self) -> None:
        super().__init__()
        self.value, self.limit, self.token = 0.0, None, "ok"
        self.setFixedHeight(20)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def show_value(self, value: float, token: str = "ok", limit: float | None = None) -> None:
        """Show a share in [0, 1]."""
        self.value, self.token, self.limit = min(max(value, 0.0), 1.0), token, limit
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the bar."""
        look = theme.active()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        middle = self.height() / 2
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("hover"))
        painter.drawRoundedRect(QRectF(0, middle - 3, self.width(), 6), 3, 3)
        painter.setBrush(look.colour(self.token))
        painter.drawRoundedRect(QRectF(0, middle - 3, self.width() * self.value, 6), 3, 3)
        if self.limit is not None:
            painter.setPen(QPen(look.colour("text"), 1.5))
            x = self.width() * self.limit
            painter.drawLine(QPointF(x, middle - 6), QPointF(x, middle + 6))
        painter.end()
