"""Views that are painted by hand: the keys they keep, the ring that shows it, what is kept of their picture."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QPoint, QRectF, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHelpEvent, QKeyEvent, QPainter, QPaintEvent, QPen, QPixmap
from PySide6.QtWidgets import QToolTip, QWidget

from app.window import theme

PLAIN, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
BY_KEYS = (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason, Qt.FocusReason.ShortcutFocusReason)
Keys = dict[tuple[Qt.KeyboardModifier, Qt.Key], Callable[[], object]]


class KeyedView(QWidget):
    """Takes the focus by Tab or a click. ``keys`` are its own, whatever they mean in the window while it has them.

    ``ringed`` : whether a ring shows that it has the keys: once it was reached, or is worked, by them.
    ``reached`` comes when they led here.
    """

    reached = Signal()

    def __init__(self, name: str) -> None:
        super().__init__()
        self.keys: Keys = {}
        self.ringed = False
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(name)

    def words_at(self, place: QPoint) -> str:
        """What is to be said of a place as a tooltip; empty for nothing."""
        return ""

    def paint_ring(self, painter: QPainter) -> None:
        """Draw the ring where it is to be seen."""
        if self.ringed and self.hasFocus():
            paint_ring(painter, QRectF(self.rect()))

    def event(self, event: QEvent) -> bool:
        """Keep the keys of its own; say what lies under the mouse."""
        if event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress) and isinstance(event, QKeyEvent):
            held = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
            call = self.keys.get((held, Qt.Key(event.key())))
            if call is not None:
                event.accept()
                if event.type() == QEvent.Type.KeyPress:
                    self._show_ring(True)
                    call()
                return True
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self.words_at(event.pos()), self)
            return True
        return super().event(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show that the keys go here, where they led here."""
        super().focusInEvent(event)
        self._show_ring(self.ringed or event.reason() in BY_KEYS)
        if event.reason() in BY_KEYS:
            self.reached.emit()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Show that the keys go elsewhere; a menu gives them back."""
        super().focusOutEvent(event)
        self._show_ring(self.ringed and event.reason() == Qt.FocusReason.PopupFocusReason)

    def _show_ring(self, on: bool) -> None:
        self.ringed = on
        self.refresh()

    def refresh(self) -> None:
        """Draw anew at the next paint."""
        self.update()


class KeptView(KeyedView):
    """Paints what rests once, by ``paint_still``, and what moves each time over it, by ``paint_over``."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._still: QPixmap | None = None

    def refresh(self) -> None:
        """Draw all of it anew at the next paint."""
        self._still = None
        self.update()

    def changeEvent(self, event: QEvent) -> None:
        """Take another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.StyleChange:
            self.refresh()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the kept picture, made anew where it has to be, and over it what moves."""
        ratio = self.devicePixelRatioF()
        if self._still is None or self._still.size() != self.size() * ratio:
            self._still = QPixmap(self.size() * ratio)
            self._still.setDevicePixelRatio(ratio)
            self._still.fill(theme.active().colour("panel"))
            painter = QPainter(self._still)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self.paint_still(painter)
            painter.end()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.paint_over(painter)
        self.paint_ring(painter)
        painter.end()

    def paint_still(self, painter: QPainter) -> None:
        """Draw what rests."""

    def paint_over(self, painter: QPainter) -> None:
        """Draw what moves."""


def paint_ring(painter: QPainter, room: QRectF) -> None:
    """The ring of what has the keys."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(theme.active().colour("accent"), 2))
    painter.drawRoundedRect(room.adjusted(1.5, 1.5, -1.5, -1.5), 5, 5)
