"""All edits in order; a click goes to one. What redo would bring back is dim."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QBrush
from PySide6.QtWidgets import QListWidget, QListWidgetItem

from app.model.history import History, Version
from app.window import theme


class HistoryList(QListWidget):
    """The versions of the document, the oldest at the top; ``wanted`` gives the index of the one asked for."""

    wanted = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("History")
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTextElideMode(Qt.TextElideMode.ElideRight)
        self._shown: list[Version] = []
        self.itemClicked.connect(lambda item: self.wanted.emit(self.row(item)))
        self.itemActivated.connect(lambda item: self.wanted.emit(self.row(item)))

    def show_history(self, history: History) -> None:
        """Show the versions; rows that stay are not made anew."""
        versions = list(history.versions)
        pairs = enumerate(zip(self._shown, versions, strict=False))
        same = next((row for row, (old, new) in pairs if old is not new), min(len(self._shown), len(versions)))
        with QSignalBlocker(self):
            while self.count() > same:
                self.takeItem(self.count() - 1)
            for version in versions[same:]:
                self.addItem(QListWidgetItem(version.label))
            self._shown = versions
            look = theme.active()
            plain, dim = (QBrush(look.colour(name)) for name in ("text", "text3"))
            for row, version in enumerate(versions):
                item = self.item(row)
                saved = version is history.saved
                item.setText(f"{version.label}  ·  saved" if saved else version.label)
                item.setForeground(plain if row <= history.present else dim)
                item.setToolTip(self._words(row, version, history))
            self.setCurrentRow(history.present)
        self.scrollToItem(self.item(history.present))

    def _words(self, row: int, version: Version, history: History) -> str:
        where = "" if version.frame is None else f", frame {version.frame}"
        if row == history.present:
            return f"{version.label}{where}: here you are"
        return f"{version.label}{where}: click to go {'back' if row < history.present else 'on'} to it"
