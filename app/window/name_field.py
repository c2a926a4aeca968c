"""The project's name at the top: double-click it, or press Enter on it, and type another one."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QFontMetrics, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QLineEdit

WIDEST = 260


class NameField(QLineEdit):
    """Looks like a label until it is typed into. ``renamed`` gives the new name; Escape leaves the old one."""

    renamed = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("name", "true")
        self.setAccessibleName("Name of the project")
        self.setToolTip("Double-click for another name")
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._name = ""
        self._rest()

    def show_name(self, name: str) -> None:
        """Show the name as it is now."""
        self._name = name
        if self.isReadOnly():
            self._rest()

    def sizeHint(self) -> QSize:
        """As wide as the name, within reason."""
        width = QFontMetrics(self.font()).horizontalAdvance(self.text()) + 16
        return QSize(min(width, WIDEST) if self.isReadOnly() else WIDEST, super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        """Narrow enough for small windows."""
        return QSize(60, super().minimumSizeHint().height())

    def begin(self) -> None:
        """Let the name be typed."""
        self.setReadOnly(False)
        self.setFocus()
        self.selectAll()
        self.updateGeometry()

    def _rest(self) -> None:
        self.setReadOnly(True)
        self.setText(self._name)
        self.deselect()
        self.setCursorPosition(0)
        self.updateGeometry()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Begin, or choose a word of what is being typed."""
        if self.isReadOnly():
            self.begin()
        else:
            super().mouseDoubleClickEvent(event)

    def event(self, event: QEvent) -> bool:
        """Keep the keys of the program while a name is typed, and Enter that begins it."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            if not self.isReadOnly() or event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter takes the name or begins, Escape leaves it as it was."""
        enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if enter and self.isReadOnly():
            self.begin()
        elif enter:
            self._take()
        elif event.key() == Qt.Key.Key_Escape and not self.isReadOnly():
            self._rest()
            self.clearFocus()
        else:
            super().keyPressEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """What was typed counts."""
        if not self.isReadOnly() and event.reason() != Qt.FocusReason.PopupFocusReason:
            self._take()
        super().focusOutEvent(event)

    def _take(self) -> None:
        typed = self.text().strip()
        changed = bool(typed) and typed != self._name
        self._rest()
        self.clearFocus()
        if changed:
            self.renamed.emit(typed)
