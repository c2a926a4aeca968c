"""A key on the sheet: click it, or press Enter on it, and press another one."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent

from app.window.controls import Chip
from app.window.key_map import pressed_key


class KeyChip(Chip):
    """Shows one key of a command, or that it has none.

    ``pressed`` gives the key that was chosen in place of ``key``; empty where it was taken away.
    """

    pressed = Signal(str)
    recording = False

    def __init__(self, key: str, name: str) -> None:
        super().__init__(" ")
        self.key = key
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName(f"Key of {name}: {key or 'none'}")
        self.setToolTip("Click, then press another key.")
        self._show()

    def record(self) -> None:
        """Wait for a key."""
        self.recording = True
        self.setFocus()
        self._show()

    def _show(self) -> None:
        if self.recording:
            self.show_state("Press a key…", "accent")
        else:
            self.show_state(self.key.replace("Return", "Enter") or "none", "neutral" if self.key else "none")
        self.setToolTip(
            "Backspace takes the key away, Esc leaves it." if self.recording else "Click, then press another key."
        )

    def _stop(self) -> None:
        self.recording = False
        self._show()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to wait for a key."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.record()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Wait no longer."""
        self._stop()
        super().focusOutEvent(event)

    def event(self, event: QEvent) -> bool:
        """Take every key while one is waited for, Tab and Escape too."""
        if self.recording and isinstance(event, QKeyEvent):
            if event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress:
                self._recorded(event)
                return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Space begin."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self.record()
        else:
            super().keyPressEvent(event)

    def _recorded(self, event: QKeyEvent) -> None:
        plain = event.modifiers() == Qt.KeyboardModifier.NoModifier
        if plain and event.key() == Qt.Key.Key_Escape:
            self._stop()
        elif plain and event.key() == Qt.Key.Key_Backspace:
            self._stop()
            self.pressed.emit("")
        elif key := pressed_key(event):
            self._stop()
            self.pressed.emit(key)
