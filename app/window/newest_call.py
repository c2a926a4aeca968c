"""Calls of which only the newest counts: pictures that are made anew while the user still turns a knob."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Hashable
from typing import Any

from PySide6.QtCore import QObject, Signal


class NewestCall(QObject):
    """One thread that serves the newest wish; an older one that was not begun is dropped.

    ``answered`` gives a wish and what its call gave, ``refused`` a wish and what it raised, in the window's thread.
    """

    answered = Signal(object, object)
    refused = Signal(object, object)
    _arrived = Signal(object, object, object)

    def __init__(self, name: str, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._name = name
        self._wake = threading.Condition()
        self._next: tuple[Hashable, Callable[[], Any]] | None = None
        self._now: Hashable = None
        self._thread: threading.Thread | None = None
        self._closed = False
        self._arrived.connect(self._deliver)

    @property
    def busy(self) -> bool:
        """Whether something is being made, or waits to be."""
        with self._wake:
            return self._next is not None or self._now is not None

    def want(self, wish: Hashable, call: Callable[[], Any]) -> None:
        """Ask for something instead of what was asked for before; what is being made already is not begun again."""
        with self._wake:
            if self._closed:
                return
            self._next = None if wish == self._now else (wish, call)
            if self._thread is None:
                self._thread = threading.Thread(target=self._serve, name=self._name, daemon=True)
                self._thread.start()
            self._wake.notify()

    def forget(self) -> None:
        """Want nothing any more."""
        with self._wake:
            self._next = None

    def _serve(self) -> None:
        while True:
            with self._wake:
                self._now = None
                while self._next is None and not self._closed:
                    self._wake.wait()
                if self._closed or self._next is None:
                    return
                (self._now, call), self._next = self._next, None
                wish = self._now
            value: Any = None
            error: BaseException | None = None
            try:
                value = call()
            except Exception as problem:  # noqa: BLE001 - handed to whoever asked
                error = problem
            if not self._closed:
                with contextlib.suppress(RuntimeError):  # closed and deleted in this very moment
                    self._arrived.emit(wish, value, error)
            del call, value, error

    def _deliver(self, wish: Hashable, value: Any, error: BaseException | None) -> None:
        if self._closed:
            return
        if error is None:
            self.answered.emit(wish, value)
        else:
            self.refused.emit(wish, error)

    def close(self, *, wait: bool = True) -> None:
        """Drop what waits, and wait for what is being made, or let it end by itself, unheard."""
        with self._wake:
            self._closed, self._next = True, None
            self._wake.notify()
        if self._thread is not None and wait:
            self._thread.join()
