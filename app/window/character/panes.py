"""One or several 3D views beside each other: the main one, the same from another side, and what it is compared with."""

from __future__ import annotations

import math

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from app.window.controls import label
from app.window.picture_notes import PictureNotes
from app.window.viewport import Viewport
from app.window.viewport.hosts import Choice

SPLIT = "split"
GAP = 2


class Pane:
    """A view with its notes; ``kind`` is "main", "split" or the name of a comparison."""

    def __init__(self, kind: str, choice: Choice) -> None:
        self.kind = kind
        self.view = Viewport(choice)
        self.notes = PictureNotes(self.view)
        self.notes.raise_()
        self.faces: object = None

    @property
    def own(self) -> bool:
        """Whether it shows the character itself, to be worked on."""
        return self.kind in ("main", SPLIT)

    def close(self) -> None:
        """Close its render window."""
        self.view.finish()


class Panes(QWidget):
    """A grid of panes; all that compare look from where the main one looks."""

    happened = Signal(object)
    hovered = Signal(int)
    changed = Signal()

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self.choice = choice
        self.panes: dict[str, Pane] = {}
        self.grid = QGridLayout(self)
        self.grid.setContentsMargins(0, 0, 0, 0)
        self.grid.setSpacing(GAP)
        self.waiting = label("Loading the 3D view…", "caption")
        self.waiting.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.grid.addWidget(self.waiting, 0, 0)

    @property
    def main(self) -> Pane | None:
        """The main pane, once there is one."""
        return self.panes.get("main")

    @property
    def own(self) -> list[Pane]:
        """The panes that show the character itself."""
        return [pane for pane in self.panes.values() if pane.own]

    @property
    def compared(self) -> list[Pane]:
        """The panes that show something else in its place."""
        return [pane for pane in self.panes.values() if not pane.own]

    def make(self, kind: str) -> Pane:
        """Give the pane of a kind, made now where there is none yet."""
        pane = self.panes.get(kind)
        if pane is None:
            pane = self.panes[kind] = Pane(kind, self.choice)
            pane.view.grabbing = pane.own
            if pane.own:
                pane.view.happened.connect(self.happened)
                pane.view.hovered.connect(self.hovered)
            else:
                pane.view.view_moved.connect(lambda: self._lead(pane))
            if kind == "main":
                pane.view.view_moved.connect(self.follow)
            self._arrange()
        return pane

    def want(self, kinds: list[str]) -> None:
        """Show these kinds beside the main pane, and close all others."""
        for kind in [kind for kind in self.panes if kind != "main" and kind not in kinds]:
            pane = self.panes.pop(kind)
            self.grid.removeWidget(pane.view)
            pane.close()
            pane.view.hide()
            pane.view.deleteLater()
        for kind in kinds:
            self.make(kind)
        order = ["main", *kinds]
        self.panes = {kind: self.panes[kind] for kind in order if kind in self.panes}
        self._arrange()
        self.follow()

    def _arrange(self) -> None:
        self.waiting.setVisible(not self.panes)
        count = len(self.panes)
        columns = 1 if count < 2 else 2 if count <= 4 else 3
        for pane in self.panes.values():
            self.grid.removeWidget(pane.view)
        for number, pane in enumerate(self.panes.values()):
            self.grid.addWidget(pane.view, number // columns, number % columns)
        for column in range(3):
            self.grid.setColumnStretch(column, 1 if column < columns else 0)
        for row in range(3):
            self.grid.setRowStretch(row, 1 if row < math.ceil(count / columns) else 0)

    def follow(self) -> None:
        """Let all that compare look from where the main pane looks."""
        main = self.main
        if main is not None:
            for pane in self.compared:
                pane.view.look_like(main.view)

    def _lead(self, pane: Pane) -> None:
        main = self.main
        if main is not None:
            main.view.look_like(pane.view)
            self.follow()

    def finish(self) -> None:
        """Close all render windows."""
        for pane in self.panes.values():
            pane.close()
