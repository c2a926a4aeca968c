"""Which character is worked on, and what it is called."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.window.controls import Chooser, icon_button


class NameChooser(QWidget):
    """A list to choose from, and a button by which the chosen one gets another name.

    ``renamed`` gives what was typed; Escape leaves the name as it was.
    """

    renamed = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.chooser = Chooser(name="Character")
        self.chooser.setInsertPolicy(Chooser.InsertPolicy.NoInsert)
        self.rename = icon_button("rename", "Rename the character", self.begin)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        row.addWidget(self.chooser, 1)
        row.addWidget(self.rename)

    def begin(self) -> None:
        """Let the name be typed."""
        self.chooser.setEditable(True)
        field = self.chooser.lineEdit()
        field.installEventFilter(self)
        field.editingFinished.connect(self._typed)
        field.setFocus()
        field.selectAll()

    def _typed(self) -> None:
        if self.chooser.isEditable():
            name, before = self.chooser.currentText().strip(), self.chooser.itemText(self.chooser.currentIndex())
            self._rest()
            if name and name != before:
                self.renamed.emit(name)

    def _rest(self) -> None:
        self.chooser.setEditable(False)
        self.chooser.clearFocus()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Escape leaves the name as it was, and is no other command meanwhile."""
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            if event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress:
                self._rest()
                return True
        return super().eventFilter(watched, event)
