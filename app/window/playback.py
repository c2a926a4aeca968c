"""The clock of playing: which frame is due, from the time that has passed, so that slow drawing skips frames."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

LEAST = 4
"""Milliseconds between two looks at the clock at least."""


@dataclass(frozen=True)
class Course:
    """A run over frames first to last from a start frame at a speed (-1 plays backwards), again and again."""

    start: int
    first: int
    last: int
    fps: float
    speed: float = 1.0

    def frame(self, seconds: float) -> int:
        """The frame that is due after some seconds."""
        length = self.last - self.first + 1
        moved = int(seconds * self.fps * abs(self.speed) + 1e-6)
        return self.first + (self.start - self.first + (moved if self.speed >= 0 else -moved)) % length


class Playback(QObject):
    """Asks for frames by ``due`` while it plays."""

    due = Signal(int)
    playing_changed = Signal(bool)

    def __init__(self, parent: QObject, present: Callable[[], int]) -> None:
        super().__init__(parent)
        self._present = present
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._tick)
        self._clock = QElapsedTimer()
        self._course: Course | None = None

    @property
    def playing(self) -> bool:
        """Whether it plays."""
        return self._course is not None

    @property
    def course(self) -> Course | None:
        """What is run over, None while it stands."""
        return self._course

    @property
    def speed(self) -> float:
        """How fast it plays, 0 while it stands."""
        return self._course.speed if self._course else 0.0

    def play(self, first: int, last: int, fps: float, speed: float = 1.0) -> None:
        """Play frames first to last from the present one."""
        if last <= first or fps <= 0:
            return
        was = self.playing
        start = min(max(self._present(), first), last)
        if start == last and speed > 0 and not was:
            start = first
        self._course = Course(start, first, last, fps, speed)
        self._clock.start()
        self._wait()
        if not was:
            self.playing_changed.emit(True)

    def stop(self) -> None:
        """Stand still."""
        if self._course is not None:
            self._timer.stop()
            self._course = None
            self.playing_changed.emit(False)

    def _wait(self) -> None:
        """Wake when the next frame is due, counted from the start: being late once makes nothing later."""
        assert self._course is not None
        step = 1e9 / (self._course.fps * abs(self._course.speed))
        left = step - self._clock.nsecsElapsed() % step
        self._timer.start(max(math.ceil(left / 1e6), LEAST))

    def _tick(self) -> None:
        if self._course is not None:
            frame = self._course.frame(self._clock.nsecsElapsed() / 1e9)
            if frame != self._present():
                self.due.emit(frame)
        if self._course is not None:
            self._wait()
