"""A place for a 3D view that is made when it is first shown, because the 3D libraries load slowly."""

from __future__ import annotations

import importlib
import sys

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.window.background_call import BackgroundCalls
from app.window.controls import label
from app.window.viewport import Viewport
from app.window.viewport.hosts import Choice
from app.window.work import details

LIBRARIES = "app.window.viewport.scene"
"""The module whose loading loads the 3D libraries."""
FAILED = "The 3D view cannot be loaded."


class Libraries(QObject):
    """Loads the 3D libraries outside the window's thread, once somebody asks whether they are there.

    ``loaded`` says that they are; ``failed`` comes with a sentence and a trace where they cannot be loaded.
    """

    loaded = Signal()
    failed = Signal(str, str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._calls = BackgroundCalls(self)
        self._loading = False

    def ready(self) -> bool:
        """Whether a view can be made at once; else it is worked on."""
        if LIBRARIES in sys.modules:
            return True
        if not self._loading:
            self._loading = True
            self._calls.run(lambda: importlib.import_module(LIBRARIES), lambda _: self.loaded.emit(), self._not_loaded)
        return False

    def _not_loaded(self, error: BaseException) -> None:
        self._loading = False
        self.failed.emit(f"{FAILED[:-1]}: {error}", details(error))

    def close(self) -> None:
        """Wait for what is being loaded, and say nothing of it any more."""
        self._calls.close()


class LazyView(QWidget):
    """``made`` comes with the viewport; ``failed`` with a sentence and a trace where the libraries cannot be loaded."""

    made = Signal()
    failed = Signal(str, str)

    def __init__(self, choice: Choice) -> None:
        super().__init__()
        self.choice = choice
        self.viewport: Viewport | None = None
        self._finished = False
        self._libraries = Libraries(self)
        self._libraries.loaded.connect(self._make)
        self._libraries.failed.connect(self._not_loaded)
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
            if self._libraries.ready():
                self._make()
            else:
                self.waiting.setText("Loading the 3D view…")
        return self.viewport

    def _make(self) -> None:
        if self.viewport is not None or self._finished:
            return
        self.viewport = Viewport(self.choice)
        self.waiting.hide()
        self._inner.addWidget(self.viewport)
        self.made.emit()

    def _not_loaded(self, sentence: str, trace: str) -> None:
        self.waiting.setText(FAILED)
        self.failed.emit(sentence, trace)

    def finish(self) -> None:
        """Close the render window."""
        self._finished = True
        self._libraries.close()
        if self.viewport is not None:
            self.viewport.finish()
