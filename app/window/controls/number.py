"""A number that is typed or dragged, with a way back to its default."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QFocusEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QLineEdit, QMenu, QWidget

from app.window.controls.own_keys import ENTER

DRAG_SLACK = 3.0


@dataclass(frozen=True)
class NumberRange:
    """What a number may be: bounds, the step of one pixel or key press, decimals shown, the unit, the default."""

    low: float = -1e9
    high: float = 1e9
    step: float = 0.01
    decimals: int = 2
    unit: str = ""
    default: float | None = None

    def clamped(self, value: float) -> float:
        """The nearest value that is allowed."""
        return min(max(value, self.low), self.high)

    def text(self, value: float) -> str:
        """The value as it is shown, with its unit."""
        number = f"{value:,.{self.decimals}f}" if self.decimals == 0 else f"{value:.{self.decimals}f}"
        return f"{number} {self.unit}".strip()

    def parsed(self, text: str) -> float | None:
        """The value that a person typed, or None; a decimal comma is understood."""
        bare = text.strip().removesuffix(self.unit).strip() if self.unit else text.strip()
        if self.decimals == 0:
            bare = bare.replace(",", "")
        try:
            return self.clamped(float(bare.replace(",", ".")))
        except ValueError:
            return None


def dragged(start: float, pixels: float, limits: NumberRange, *, fast: bool, fine: bool) -> float:
    """The value after a sideways drag: one step a pixel, ten with Shift, a tenth with Ctrl."""
    factor = 10.0 if fast else 0.1 if fine else 1.0
    return limits.clamped(start + pixels * limits.step * factor)


class NumberField(QLineEdit):
    """Drag sideways to change, click to type, arrow keys to step, right-click to reset.

    ``changing`` comes while it is dragged, ``changed`` once at the end of a drag, a typed number or a key step.
    """

    changing = Signal(float)
    changed = Signal(float)

    def __init__(self, limits: NumberRange, value: float = 0.0, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.limits = limits
        self._value = limits.clamped(value)
        self._press: tuple[QPointF, float] | None = None
        self._dragging = False
        self._assumed = False
        self.setMinimumWidth(44)
        self.setProperty("number", "true")
        self.setReadOnly(True)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setToolTip("Drag sideways or click and type. Right-click for the default.")
        self.returnPressed.connect(self._accept)
        self._show()

    @property
    def value(self) -> float:
        """The number as it is."""
        return self._value

    def set_value(self, value: float, *, assumed: bool = False) -> None:
        """Show a value that came from the document; says nothing back.

        ``assumed`` : nobody gave it: it is shown dimmed, and typing the very same number gives it.
        """
        if not self.isReadOnly() or self._dragging:
            return
        if assumed != self._assumed:
            self._assumed = assumed
            self.setProperty("assumed", "true" if assumed else "false")
            self.style().unpolish(self)
            self.style().polish(self)
        self._value = self.limits.clamped(value)
        self._show()

    def _show(self) -> None:
        text = self.limits.text(self._value)
        if text != self.text():
            self.setText(text)
        self.setCursorPosition(0)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a drag, or place the caret where a number is being typed."""
        if not self.isReadOnly():
            super().mousePressEvent(event)
        elif event.button() == Qt.MouseButton.LeftButton:
            self._press, self._dragging = (event.position(), self._value), False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Change the number with the mouse."""
        if self._press is None:
            super().mouseMoveEvent(event)
            return
        origin, start = self._press
        distance = event.position().x() - origin.x()
        if not self._dragging and abs(distance) < DRAG_SLACK:
            return
        self._dragging = True
        keys = event.modifiers()
        self._value = dragged(
            start,
            distance,
            self.limits,
            fast=bool(keys & Qt.KeyboardModifier.ShiftModifier),
            fine=bool(keys & Qt.KeyboardModifier.ControlModifier),
        )
        self._show()
        self.changing.emit(self._value)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End a drag, or start typing after a click."""
        if self._press is None:
            super().mouseReleaseEvent(event)
            return
        self._press = None
        if self._dragging:
            self._dragging = False
            self.changed.emit(self._value)
        else:
            self._type()

    def _type(self) -> None:
        self.setReadOnly(False)
        self.setCursor(Qt.CursorShape.IBeamCursor)
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        self.selectAll()

    def _accept(self) -> None:
        if self.isReadOnly():
            self._type()
            return
        value = self.limits.parsed(self.text())
        given = self._assumed and self.isModified()
        self._stop_typing()
        if value is not None and (value != self._value or given):
            self._value = value
            self.changed.emit(value)
        self._show()

    def _stop_typing(self) -> None:
        self.setReadOnly(True)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        self.deselect()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Step by the arrow keys, leave typing by Escape."""
        key = event.key()
        if key == Qt.Key.Key_Escape and (not self.isReadOnly() or self._dragging):
            if self._press is not None:
                self._value = self._press[1]
                self._press, self._dragging = None, False
                self.changing.emit(self._value)
            self._stop_typing()
            self._show()
        elif self.isReadOnly() and key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            sign = 1 if key == Qt.Key.Key_Up else -1
            fast = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self._value = dragged(self._value, sign, self.limits, fast=fast, fine=False)
            self._show()
            self.changed.emit(self._value)
        else:
            super().keyPressEvent(event)
            if key in ENTER:
                # It takes the number, and is not handed on to a button of the dialog.
                event.accept()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Take what was typed when the field is left."""
        super().focusOutEvent(event)
        if not self.isReadOnly() and event.reason() != Qt.FocusReason.PopupFocusReason:
            self._accept()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer the default."""
        if self.limits.default is None:
            return
        menu = QMenu(self)
        menu.addAction(f"Reset to {self.limits.text(self.limits.default)}", self.reset)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(event.globalPos())

    def reset(self) -> None:
        """Go back to the default."""
        if self.limits.default is not None and self._value != self.limits.default:
            self._value = self.limits.default
            self._show()
            self.changed.emit(self._value)

    def event(self, event: QEvent) -> bool:
        """Keep single letters in the field while a number is typed, and the keys that step it."""
        own = isinstance(event, QKeyEvent) and (
            event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down) or (event.key() == Qt.Key.Key_Escape and self._dragging)
        )
        if event.type() == QEvent.Type.ShortcutOverride and (own or not self.isReadOnly()):
            event.accept()
            return True
        return super().event(event)
