"""Reads frames ahead of the playhead in a thread of its own, and keeps those that were shown lately."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.window.playback import Course

if TYPE_CHECKING:
    from app.actions.performing_playback import ShownFrame

MEMORY = 384 << 20
"""Bytes of frames that are kept."""
Source = Sequence[Any]


class FrameReader(QObject):
    """Frames of one source at a time: what is wanted is read in order, the newest wish first.

    ``opened`` gives the number of frames, ``arrived`` a frame that is at hand now, ``failed`` a sentence and the error.
    """

    opened = Signal(int)
    arrived = Signal(int)
    failed = Signal(str, object)
    _told = Signal(int, str, object)

    def __init__(self, parent: QObject | None = None, memory: int = MEMORY) -> None:
        super().__init__(parent)
        self._memory, self._held = memory, 0
        self._kept: OrderedDict[int, ShownFrame] = OrderedDict()
        self._wanted: tuple[int, ...] = ()
        self._make: Callable[[], Source] | None = None
        self._turn = 0
        self._closed = False
        self._wake = threading.Condition()
        self._thread: threading.Thread | None = None
        self._told.connect(self._hear)

    def open(self, make: Callable[[], Source] | None) -> None:
        """Take another source, made in the thread; None lets go of it."""
        with self._wake:
            self._turn += 1
            self._make, self._wanted = make, ()
            self._kept.clear()
            self._held = 0
            self._wake.notify()
        if make is not None and self._thread is None and not self._closed:
            self._thread = threading.Thread(target=self._work, name="frames ahead", daemon=True)
            self._thread.start()

    def frame(self, position: int) -> ShownFrame | None:
        """A frame if it is at hand."""
        with self._wake:
            found = self._kept.get(position)
            if found is not None:
                self._kept.move_to_end(position)
            return found

    def want(self, positions: Sequence[int]) -> None:
        """Read these frames next, in this order; earlier wishes are dropped."""
        with self._wake:
            self._wanted = tuple(dict.fromkeys(positions))
            self._wake.notify()

    def close(self) -> None:
        """Let the thread end."""
        with self._wake:
            self._closed = True
            self._wake.notify()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    # in the thread -----------------------------------------------------------------------------------------------

    def _work(self) -> None:
        source: Source | None = None
        opened = 0
        while (task := self._next(opened)) is not None:
            turn, make, position = task
            try:
                if turn != opened:
                    source, opened = None, turn
                    source = make()
                    self._told.emit(turn, "opened", len(source))
                elif source is not None and 0 <= position < len(source):
                    self._keep(turn, position, source[position])
                else:
                    self._forget(turn, position)
            except Exception as error:  # noqa: BLE001 - told where it is seen
                self._stop(turn)
                self._told.emit(turn, "failed", error)

    def _next(self, opened: int) -> tuple[int, Callable[[], Source], int] | None:
        """What to do next: open the source, or read a frame; None at the end."""
        with self._wake:
            while not self._closed:
                if self._make is not None:
                    if self._turn != opened:
                        return self._turn, self._make, -1
                    position = next((each for each in self._wanted if each not in self._kept), None)
                    if position is not None:
                        return self._turn, self._make, position
                self._wake.wait()
        return None

    def _keep(self, turn: int, position: int, frame: ShownFrame) -> None:
        with self._wake:
            if turn != self._turn:
                return
            self._kept[position] = frame
            self._held += frame.size
            while self._held > self._memory and len(self._kept) > 1:
                oldest = next((each for each in self._kept if each not in self._wanted), None)
                if oldest is None:
                    break
                self._held -= self._kept.pop(oldest).size
            if self._held > self._memory:
                self._wanted = tuple(each for each in self._wanted if each in self._kept)
        self._told.emit(turn, "arrived", position)

    def _forget(self, turn: int, position: int) -> None:
        with self._wake:
            if turn == self._turn:
                self._wanted = tuple(each for each in self._wanted if each != position)

    def _stop(self, turn: int) -> None:
        with self._wake:
            if turn == self._turn:
                self._make, self._wanted = None, ()

    # in the window's thread --------------------------------------------------------------------------------------

    def _hear(self, turn: int, what: str, value: Any) -> None:
        if turn != self._turn or self._closed:
            return
        if what == "opened":
            self.opened.emit(value)
        elif what == "arrived":
            self.arrived.emit(value)
        else:
            self.failed.emit(str(value), value)


class Dropped:
    """Counts frames that were due while playing and were never shown."""

    def __init__(self) -> None:
        self.shown = self.dropped = 0
        self._last: int | None = None

    def begin(self) -> None:
        """Start counting anew."""
        self.shown = self.dropped = 0
        self._last = None

    def saw(self, place: int, course: Course) -> None:
        """A frame is on the screen while playing."""
        if place == self._last:
            return
        if self._last is not None:
            stride = max(round(abs(course.speed)), 1)
            self.dropped += max(way(course, self._last, place) // stride - 1, 0)
        self.shown += 1
        self._last = place


def way(course: Course, start: int, end: int) -> int:
    """How many frames a run takes from one to another, round the end where it has to."""
    moved = end - start if course.speed > 0 else start - end
    return moved % (course.last - course.first + 1)


def ahead(place: int, count: int, course: Course | None, seconds: float = 1.0) -> list[int]:
    """The frames that come next, the present one first: while playing round and round, else both neighbours."""
    if count <= 0:
        return []
    if course is None:
        near = [place, place + 1, place - 1, place + 2, place - 2]
        return [each for each in near if 0 <= each < count]
    length = course.last - course.first + 1
    sign = 1 if course.speed > 0 else -1
    many = min(length, max(round(seconds * course.fps * abs(course.speed)), 4))
    return [course.first + (place - course.first + sign * step) % length for step in range(many)]
