"""Workspaces above, timeline below: the lanes get the room that they need until the user has chosen otherwise."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtWidgets import QSplitter, QWidget

from app.window import settings

GAP = 8


class Split(QSplitter):
    """The two halves of the window; a height chosen by hand is kept for each workspace, from one run to the next.

    A double click on the line between them takes the automatic height again.
    """

    chosen = Signal()

    def __init__(self, above: QWidget, below: QWidget) -> None:
        super().__init__(Qt.Orientation.Vertical)
        self.setHandleWidth(GAP)
        self.setChildrenCollapsible(False)
        self.addWidget(above)
        self.addWidget(below)
        self.setStretchFactor(0, 1)
        self.setStretchFactor(1, 0)
        self.workspace = ""
        self.splitterMoved.connect(self._moved)
        handle = self.handle(1)
        handle.setToolTip("Drag to give the lanes more or less room; a double click fits them")
        handle.installEventFilter(self)

    @property
    def by_hand(self) -> int | None:
        """Pixels that the user has given the lower half in this workspace, None where nothing was chosen."""
        value = settings.settings().value(f"split/{self.workspace}")
        try:
            return int(str(value))
        except ValueError:
            return None

    def _moved(self) -> None:
        settings.settings().setValue(f"split/{self.workspace}", self.sizes()[1])
        self.chosen.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Forget what was chosen by hand when the line is clicked twice."""
        if event.type() == QEvent.Type.MouseButtonDblClick:
            settings.settings().remove(f"split/{self.workspace}")
            self.chosen.emit()
            return True
        return super().eventFilter(watched, event)

    @property
    def room(self) -> int:
        """Pixels that the lower half may have: those chosen by hand, or up to two fifths."""
        height, chosen = self.height(), self.by_hand
        return 2 * height // 5 if chosen is None else min(chosen, height - GAP)

    def fit(self, wanted: int) -> None:
        """Give the lower half the pixels chosen by hand, or those it wants where there is room for them."""
        height = self.height()
        wanted = min(wanted, self.room) if self.by_hand is None else self.room
        if height > 0 and abs(self.sizes()[1] - wanted) > 1:
            self.setSizes([height - wanted - GAP, wanted])
