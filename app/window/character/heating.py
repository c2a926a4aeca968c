"""Heat maps of the pose in sight, found in another thread that serves only the newest pose."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from app.actions.heat import Heat, heat_of
from app.window.background_call import BackgroundCalls
from app.window.project import Project

Array = NDArray[np.float64]


class Heating(QObject):
    """``found`` gives the colours, None for the character's own; ``told`` a sentence where there are none to give."""

    found = Signal(object)
    told = Signal(str)

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self.kind = ""
        self._calls = BackgroundCalls(self)
        self._next: tuple[Any, ...] | None = None
        self._running = False
        self._shown: tuple[str, int, int] | None = None

    def choose(self, kind: str) -> None:
        """Let the colours stand for something else; empty for the character's own."""
        self.kind, self._shown = kind, None
        if not kind:
            self._next = None
            self.found.emit(None)

    def want(self, frame: int, vertices: Array) -> None:
        """Colour the pose in sight."""
        signature = (self.kind, frame, id(vertices))
        if not self.kind or signature == self._shown:
            return
        self._shown = signature
        self._next = (self.project.character_id, self.kind, frame, vertices)
        if not self._running:
            self._serve()

    def _serve(self) -> None:
        wanted, self._next = self._next, None
        if wanted is None:
            return
        self._running = True
        session = self.project.session
        self._calls.run(lambda: heat_of(session, *wanted), lambda heat: self._take(wanted, heat), self._fail)

    def _take(self, wanted: tuple[Any, ...], heat: Heat) -> None:
        self._running = False
        if wanted[1] == self.kind:
            self.found.emit(heat)
        self._serve()

    def _fail(self, error: BaseException) -> None:
        self._running = False
        self.kind, self._next = "", None
        self.found.emit(None)
        self.told.emit(str(error))

    def close(self) -> None:
        """Wait for what is being found."""
        self._next = None
        self._calls.close()
