"""Decoding for the eye, the clock of playing, and what the binding does to the interpreter's constants."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QImage, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.window.frames import AHEAD, BEHIND, FrameLoader
from app.window.playback import Course, Playback
from tests.window.conftest import settle, wait_for


class Clip:
    """A clip whose pictures carry their own number; decoding can be held up."""

    def __init__(self, count: int = 60) -> None:
        self.count, self.asked, self.closed = count, [], False
        self.gate = threading.Event()
        self.gate.set()

    def __getitem__(self, frame: int) -> np.ndarray:
        self.gate.wait(5)
        self.asked.append(frame)
        return np.full((18, 32, 3), frame, np.uint8)

    def close(self) -> None:
        """Remember that it was closed."""
        self.closed = True


def number(picture: QImage) -> int:
    """The frame number in a picture."""
    return picture.pixelColor(3, 3).red()


@pytest.fixture
def clip() -> Clip:
    """A clip of 60 frames."""
    return Clip()


@pytest.fixture
def loader(qapp: QApplication, clip: Clip) -> Iterator[FrameLoader]:
    """A loader on it."""
    loader = FrameLoader(lambda: clip, clip.count)
    yield loader
    clip.gate.set()
    loader.close()
    assert clip.closed


def test_the_right_picture_comes(loader: FrameLoader) -> None:
    """Whatever is asked for, the picture that comes carries that number."""
    got: list[tuple[int, int]] = []
    loader.loaded.connect(lambda frame, picture: got.append((frame, number(picture))))
    for frame in (5, 59, 0, 31):
        now = loader.request(frame)
        if now is not None:
            got.append((frame, number(now)))
        else:
            wait_for(lambda frame=frame: got and got[-1][0] == frame)
    assert all(frame == shown for frame, shown in got)


def test_a_late_picture_never_replaces_a_newer_one(loader: FrameLoader, clip: Clip) -> None:
    """A picture that was decoded for an older wish and is still on its way when a kept one is shown is dropped."""
    wait_for(lambda: loader.request(3) is not None)
    got: list[int] = []
    loader.loaded.connect(lambda frame, picture: got.append(frame))
    assert loader.request(40) is None
    end = time.monotonic() + 5
    while loader.peek(40) is None and time.monotonic() < end:
        time.sleep(0.002)  # the answer waits in the queue: no event is handled meanwhile
    time.sleep(0.02)
    assert loader.request(3) is not None
    settle()
    assert got == [], "frame 3 is shown, so frame 40 comes too late"
    assert loader.request(40) is not None


def test_only_the_newest_wish_is_served(loader: FrameLoader, clip: Clip) -> None:
    """While one frame is decoded, of ten wishes only the last is served."""
    got: list[int] = []
    loader.loaded.connect(lambda frame, picture: got.append(frame))
    clip.gate.clear()
    settle(20)
    for frame in range(40, 50):
        loader.request(frame)
    clip.gate.set()
    wait_for(lambda: 49 in got)
    assert got == [49]


def test_neighbours_are_fetched_ahead(loader: FrameLoader) -> None:
    """At rest the frames around are there, and asking for one gives it at once."""
    loader.request(30)
    wait_for(lambda: all(loader.peek(frame) is not None for frame in range(30 - BEHIND, 30 + AHEAD + 1)))
    assert number(loader.request(31)) == 31
    assert any(first <= 30 <= last for first, last in loader.spans)


def test_thumbnails_come_when_nothing_else_is_wanted(loader: FrameLoader) -> None:
    """A thumbnail is small, and of the right frame."""
    ready: list[int] = []
    loader.thumbnail_ready.connect(ready.append)
    assert loader.thumbnail(55) is None
    wait_for(lambda: 55 in ready)
    small = loader.thumbnail(55)
    assert small is not None
    assert number(small) == 55
    assert small.width() <= 96


def test_a_file_that_cannot_be_opened_is_told(qapp: QApplication) -> None:
    """The sentence comes as a signal, the loader closes cleanly."""

    def broken() -> object:
        raise ValueError("The video is gone.")

    told: list[str] = []
    loader = FrameLoader(broken, 10)
    loader.failed.connect(told.append)
    wait_for(lambda: told or not loader._thread.is_alive())
    settle()
    loader.close()
    assert told in ([], ["The video is gone."])


@given(st.integers(0, 50), st.integers(1, 60), st.floats(0, 100), st.sampled_from([1.0, 2.0, -1.0, -4.0]))
def test_course_stays_in_range(start: int, length: int, seconds: float, speed: float) -> None:
    """Whatever time has passed, the frame due lies in the range."""
    course = Course(start, start, start + length, 25.0, speed)
    assert start <= course.frame(seconds) <= start + length


def test_course_has_the_right_speed() -> None:
    """After two seconds at 25 frames a second frame 50 is due, at twice the speed frame 100, backwards it wraps."""
    assert Course(0, 0, 200, 25.0).frame(2.0) == 50
    assert Course(0, 0, 200, 25.0, 2.0).frame(2.0) == 100
    assert Course(10, 0, 200, 25.0, -1.0).frame(1.0) == 186


def test_playing_follows_the_clock(qapp: QApplication) -> None:
    """In 0.4 s at 50 frames a second about 20 frames pass, however few are drawn."""
    shown = [0]
    owner = QObject()
    playback = Playback(owner, lambda: shown[-1])
    playback.due.connect(shown.append)
    playback.play(0, 500, 50.0)
    began = time.monotonic()
    settle(400)
    passed = time.monotonic() - began
    playback.stop()
    assert abs(shown[-1] - 50 * passed) <= 4
    assert shown == sorted(shown)
    assert not playback.playing


class Painted(QWidget):
    """Overrides what Qt calls."""

    sent = Signal(bool)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint nothing."""
        QPainter(self).end()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Take it."""


def test_the_binding_counts_references(qapp: QApplication) -> None:
    """1000 paints, mouse events and signals leave the counts of None and True as they were (6.12.0 aborts on 3.11)."""
    if sys.version_info >= (3, 12):
        pytest.skip("constants are immortal from 3.12 on")
    widget = Painted()
    widget.resize(20, 20)
    widget.show()
    heard: list[bool] = []
    widget.sent.connect(heard.append)
    place = QPointF(5, 5)

    def paint_and_tell() -> None:
        widget.repaint()
        widget.sent.emit(True)
        heard.clear()

    def move_the_mouse() -> None:
        button = Qt.MouseButton.NoButton
        keys = Qt.KeyboardModifier.NoModifier
        QApplication.sendEvent(widget, QMouseEvent(QEvent.Type.MouseMove, place, place, button, button, keys))

    for call, most in ((paint_and_tell, 50), (move_the_mouse, 5000)):
        nothing, truth = sys.getrefcount(None), sys.getrefcount(True)
        for _ in range(1000):
            call()
        # Too many references of a constant do no harm, too few end the interpreter.
        assert -50 < sys.getrefcount(None) - nothing < most
        assert -50 < sys.getrefcount(True) - truth < 50
    widget.close()
    widget.deleteLater()


def test_no_opencv_with_its_own_qt() -> None:
    """An OpenCV with Qt inside would take Qt's plugins over."""
    from importlib.util import find_spec
    from pathlib import Path

    spec = find_spec("cv2")
    assert spec is not None
    assert spec.origin is not None
    assert not (Path(spec.origin).parent / "qt").exists()
