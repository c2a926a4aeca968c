"""One call in a thread of its own, its answer delivered in the window's thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Signal


class BackgroundCalls(QObject):
    """Runs calls outside the window's thread. ``close`` waits for those under way and drops their answers."""

    _answered = Signal(object, object, object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._threads: set[threading.Thread] = set()
        self._closed = False
        self._answered.connect(self._deliver)

    def run(
        self,
        call: Callable[[], Any],
        done: Callable[[Any], object],
        failed: Callable[[BaseException], object] | None = None,
    ) -> None:
        """Run ``call``; then ``done`` gets what it gave, or ``failed`` what it raised."""

        def work() -> None:
            value: Any = None
            error: BaseException | None = None
            try:
                value = call()
            except Exception as problem:  # noqa: BLE001 - handed to whoever asked
                error = problem
            if not self._closed:
                self._answered.emit(value, error, (done, failed))
            self._threads.discard(threading.current_thread())

        thread = threading.Thread(target=work, name="call", daemon=True)
        self._threads.add(thread)
        thread.start()

    def _deliver(self, value: Any, error: BaseException | None, answers: tuple[Any, Any]) -> None:
        if self._closed:
            return
        done, failed = answers
        if error is None:
            done(value)
        elif failed is not None:
            failed(error)

    def close(self) -> None:
        """Wait for the calls under way."""
        self._closed = True
        for thread in tuple(self._threads):
            thread.join()
