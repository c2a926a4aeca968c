"""Workspaces above, timeline below: the lanes get the room that they need until the user has chosen otherwise."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSplitter, QWidget

GAP = 8


class Split(QSplitter):
    """The two halves of the window."""

    def __init__(self, above: QWidget, below: QWidget) -> None:
        super().__init__(Qt.Orientation.Vertical)
        self.setHandleWidth(GAP)
        self.setChildrenCollapsible(False)
        self.addWidget(above)
        self.addWidget(below)
        self.setStretchFactor(0, 1)
        self.setStretchFactor(1, 0)
        self._by_hand = False
        self.splitterMoved.connect(self._moved)

    def _moved(self) -> None:
        self._by_hand = True

    def fit(self, wanted: int) -> None:
        """Give the lower half the pixels it wants, up to two fifths."""
        height = self.height()
        wanted = min(wanted, 2 * height // 5)
        if not self._by_hand and height > 0 and abs(self.sizes()[1] - wanted) > 1:
            self.setSizes([height - wanted - GAP, wanted])
