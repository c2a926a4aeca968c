"""A place for a 3D view that is made when it is first shown, because the 3D libraries load slowly."""

from __future__ import annotations

import importlib
import sys

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.window.background_call import BackgroundCalls
from app.window.controls import label
from app.window.viewport import Viewport
from app.window.viewport.hosts import Choice
from app.window.work import details

LIBRARIES = "app.window.viewport.scene"
"""The module whose loading loads the 3D libraries."""


class LazyView(QWidget):
    """``made`` comes with the viewport; ``failed`` with a sentence and a trace where the libraries cannot be loaded."""

    made = Signal()
    failed = Signal(str, str)

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self.choice = choice
        self.viewport: Viewport | None = None
        self._calls = BackgroundCalls(self)
        self._loading = self._finished = False
        self._inner = QVBoxLayout(self)
        self._inner.setContentsMargins(0, 0, 0, 0)
        self.waiting = label("", "caption")
        self.waiting.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.waiting.setWordWrap(True)
        self.waiting.setContentsMargins(16, 0, 16, 0)
        self._inner.addWidget(self.waiting)

    def say(self, sentence: str) -> None:
        """Show a sentence where the view would be; an empty one shows the view."""
        self.waiting.setText(sentence)
        self.waiting.setVisible(bool(sentence) or self.viewport is None)
        if self.viewport is not None:
            self.viewport.setVisible(not sentence)

    def want(self) -> Viewport | None:
        """The viewport where it can be had at once; else the 3D libraries are loaded, and ``made`` says when."""
        if self.viewport is None and not self._finished:
            if LIBRARIES in sys.modules:
                self._make()
            elif not self._loading:
                self._loading = True
                self.waiting.setText("Loading the 3D view…")
                self._calls.run(lambda: importlib.import_module(LIBRARIES), lambda _: self._make(), self._not_loaded)
        return self.viewport

    def _make(self) -> None:
        if self.viewport is not None or self._finished:
            return
        self.viewport = Viewport(self.choice)
        self.waiting.hide()
        self._inner.addWidget(self.viewport)
        self.made.emit()

    def _not_loaded(self, error: BaseException) -> None:
        self._loading = False
        self.waiting.setText("The 3D view cannot be loaded.")
        self.failed.emit(f"The 3D view cannot be loaded: {error}", details(error))

    def finish(self) -> None:
        """Close the render window."""
        self._finished = True
        self._calls.close()
        if self.viewport is not None:
            self.viewport.finish()
