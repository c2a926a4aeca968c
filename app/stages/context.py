"""What a running stage may use beside its inputs: media, progress, partial results."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from app.stages.media import Media
from imitation.errors import Cancelled
from imitation.progress import silent


class Token:
    """A cancel request that a computation looks at whenever it reports progress."""

    def __init__(self) -> None:
        self._event = threading.Event()
        self._waiting: list[Callable[[], object]] = []

    def cancel(self) -> None:
        """Ask the computation to stop."""
        self._event.set()
        for wake in tuple(self._waiting):
            wake()

    def wakes(self, wake: Callable[[], object]) -> None:
        """Have ``wake`` called by a cancel, from whatever thread; more than once is no harm."""
        self._waiting.append(wake)
        if self.cancelled:
            wake()

    @property
    def cancelled(self) -> bool:
        """Whether it was asked to stop."""
        return self._event.is_set()

    def check(self) -> None:
        """Raise ``Cancelled`` when it was asked to stop."""
        if self._event.is_set():
            raise Cancelled


class Context:
    """Given to a stage's function as its first argument."""

    def __init__(
        self,
        media: Media,
        progress: Callable[[float], None] = silent,
        emit: Callable[[Any], None] = silent,
        token: Token | None = None,
    ) -> None:
        self.media = media
        self._progress, self._emit = progress, emit
        self.token = token or Token()

    def progress(self, fraction: float) -> None:
        """Report how much is done, in [0, 1]; raises ``Cancelled`` when the work shall stop."""
        self.token.check()
        self._progress(fraction)

    def emit(self, partial: Any) -> None:
        """Hand out a part of the result while the rest is being computed."""
        self.token.check()
        self._emit(partial)
