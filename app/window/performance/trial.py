"""What another mu would give, while the slider moves: tried at once, or in the background where that takes long."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.window.background_call import BackgroundCalls
from app.window.performance.state import PerformanceState

if TYPE_CHECKING:
    from app.actions.performing_graph import Tried


AT_ONCE = 0.025
"""Seconds of the processor: what took no longer the last time is tried at once, without waking a thread."""


class Trial(QObject):
    """Gives what was tried by ``changed``; ``result`` is None while nothing is tried. The newest wish counts.

    After the slider is let go the result stays until the document's own path is there, so that nothing blinks.
    """

    changed = Signal()

    def __init__(self, state: PerformanceState, calls: BackgroundCalls, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state, self._calls = state, calls
        self.result: Tried | None = None
        self._wish: float | None = None
        self._took = 0.0
        self._busy = False
        self._round = 0
        self.holding = False
        state.results_changed.connect(self._arrived)

    def want(self, mu: float) -> None:
        """Try a mu; a wish that has not begun is replaced."""
        self.holding = True
        self._wish = mu
        self._next()

    def look_at(self, number: int) -> None:
        """Show one of the paths there are before it is chosen; -1 shows the document again."""
        state = self.state
        if not 0 <= number < len(state.paths):
            self.drop()
            return
        from app.actions.performing_graph import found

        self.holding = True
        self._set(found(state.graph, state.paths[number]))

    def release(self) -> None:
        """The slider is let go: keep what is shown until the path itself arrives."""
        self.holding = False
        self._wish = None
        self._arrived()

    def drop(self) -> None:
        """Show the document as it is."""
        self._took = 0.0
        self.holding, self._wish = False, None
        self._round += 1
        self._set(None)

    def _next(self) -> None:
        mu, graph = self._wish, self.state.graph
        if self._busy or mu is None or graph is None:
            return
        from app.actions.performing_graph import tried

        document, begun = self.state.document, self._round
        self._wish = None
        if self._took < AT_ONCE:
            begin = time.thread_time()
            found = tried(document, graph, mu)
            self._took = time.thread_time() - begin
            self._done(found, begun)
            return
        self._busy = True
        self._calls.run(lambda: tried(document, graph, mu), lambda made: self._done(made, begun), self._failed)

    def _done(self, made: Tried, begun: int) -> None:
        self._busy = False
        if begun == self._round and (self.holding or self.result is not None):
            self._set(made)
        self._next()
        if not self.holding:
            self._arrived()

    def _failed(self, error: BaseException) -> None:
        self._busy = False
        self._next()

    def _arrived(self) -> None:
        """Let go of what was tried once the document's own graph and path are there."""
        state = self.state
        if self.holding or self.result is None or not state.fresh:
            return
        if state.paths or state.problem or not state.document.performance.keys:
            self._set(None)

    def _set(self, result: Tried | None) -> None:
        if result is not self.result:
            self.result = result
            self.changed.emit()
