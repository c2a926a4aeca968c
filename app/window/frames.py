"""Frames for the eye: decoded in one thread that serves only the newest wish, kept in bounded memory."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np
from PySide6.QtCore import QObject, QSize, Qt, Signal
from PySide6.QtGui import QImage

BUDGET = 256 << 20
AHEAD, BEHIND = 10, 6
THUMBNAIL = QSize(96, 54)
Open = Callable[[], Any]


class FrameLoader(QObject):
    """Gives pictures of frames by ``loaded``; a frame that was asked for and is no longer wanted is skipped.

    ``open_source`` opens the clip in the decoder's own thread, so that scrubbing never waits for a computation that
    reads the same file.
    """

    loaded = Signal(int, object)
    _arrived = Signal(int, object, int)
    also_ready = Signal(int)
    thumbnail_ready = Signal(int)
    failed = Signal(str)

    def __init__(self, open_source: Open, count: int, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._open, self._count = open_source, count
        self._wake = threading.Condition()
        self._wanted: int | None = None
        self._wish = self._shown = 0
        self._centre, self._direction = 0, 1
        self._closing = False
        self._kept: OrderedDict[int, QImage] = OrderedDict()
        self._bytes = 0
        self._thumbnails: dict[int, QImage] = {}
        self._thumbnail_wishes: list[int] = []
        self._also: list[int] = []
        self.decoded = 0
        self._arrived.connect(self._deliver)
        self._thread = threading.Thread(target=self._serve, name="frames", daemon=True)
        self._thread.start()

    def request(self, frame: int) -> QImage | None:
        """Give the frame's picture if it is there; else it comes by ``loaded``, unless a newer wish replaces it."""
        with self._wake:
            self._direction = 1 if frame >= self._centre else -1
            self._centre = frame
            self._wish += 1
            picture = self._kept.get(frame)
            if picture is not None:
                self._kept.move_to_end(frame)
                self._shown = self._wish
            self._wanted = frame if picture is None else None
            self._wake.notify()
        return picture

    def _deliver(self, frame: int, picture: QImage, wish: int) -> None:
        """Hand a picture out, unless one of a later wish is shown already."""
        if wish >= self._shown and not self._closing:
            self._shown = wish
            self.loaded.emit(frame, picture)

    def peek(self, frame: int) -> QImage | None:
        """Give the frame's picture if it is there, and ask for nothing."""
        with self._wake:
            return self._kept.get(frame)

    def also(self, frames: list[int]) -> None:
        """Wish for pictures of other frames; ``also_ready`` says when each is there, after the frame shown."""
        with self._wake:
            self._also = [frame for frame in frames if frame not in self._kept]
            self._wake.notify()

    def thumbnail(self, frame: int) -> QImage | None:
        """Give a small picture if it is there; else ``thumbnail_ready`` says when, decoded when nothing else is."""
        with self._wake:
            found = self._thumbnails.get(frame)
            if found is None and frame not in self._thumbnail_wishes:
                self._thumbnail_wishes.append(frame)
                self._wake.notify()
        return found

    @property
    def spans(self) -> list[tuple[int, int]]:
        """The runs of frames that are kept in memory."""
        with self._wake:
            frames = sorted(self._kept)
        runs: list[tuple[int, int]] = []
        for frame in frames:
            if runs and frame == runs[-1][1] + 1:
                runs[-1] = (runs[-1][0], frame)
            else:
                runs.append((frame, frame))
        return runs

    def close(self) -> None:
        """End the thread and close the file."""
        with self._wake:
            self._closing = True
            self._wake.notify()
        self._thread.join()
        self._kept.clear()
        self._thumbnails.clear()

    def _serve(self) -> None:
        try:
            source = self._open()
        except Exception as error:  # noqa: BLE001 - whatever is wrong with the file is told, the window lives on
            self._say(self.failed, str(error))
            return
        try:
            while True:
                job = self._next_job()
                if job is None:
                    return
                self._load(source, *job)
        finally:
            source.close()

    def _next_job(self) -> tuple[str, int, int] | None:
        with self._wake:
            while not self._closing:
                if self._wanted is not None:
                    frame, self._wanted = self._wanted, None
                    return "wanted", frame, self._wish
                if self._also:
                    return "also", self._also.pop(0), 0
                near = self._to_prefetch()
                if near is not None:
                    return "near", near, 0
                if self._thumbnail_wishes:
                    return "thumbnail", self._thumbnail_wishes.pop(0), 0
                self._wake.wait()
        return None

    def _to_prefetch(self) -> int | None:
        ahead = [self._centre + self._direction * step for step in range(AHEAD + 1)]
        behind = [self._centre - self._direction * step for step in range(1, BEHIND + 1)]
        for frame in (*ahead, *behind):
            if 0 <= frame < self._count and frame not in self._kept:
                return frame
        return None

    def _load(self, source: Any, kind: str, frame: int, wish: int) -> None:
        picture = self.peek(frame)
        if picture is None:
            try:
                picture = _image(source[frame])
                self.decoded += 1
            except Exception as error:  # noqa: BLE001 - one damaged frame must not end the thread
                picture = QImage()
                self._say(self.failed, str(error))
        if kind == "thumbnail" or frame not in self._thumbnails:
            small = picture.scaled(
                THUMBNAIL, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            )
            with self._wake:
                self._thumbnails[frame] = small
            if kind == "thumbnail":
                self._say(self.thumbnail_ready, frame)
                return
        self._keep(frame, picture)
        if kind == "wanted":
            self._say(self._arrived, frame, picture, wish)
        elif kind == "also":
            self._say(self.also_ready, frame)

    def _say(self, signal: Any, *values: object) -> None:
        if not self._closing:
            signal.emit(*values)

    def _keep(self, frame: int, picture: QImage) -> None:
        with self._wake:
            self._kept[frame] = picture
            self._bytes += picture.sizeInBytes()
            while self._bytes > BUDGET and len(self._kept) > AHEAD + BEHIND + 2:
                _, dropped = self._kept.popitem(last=False)
                self._bytes -= dropped.sizeInBytes()


def _image(frame: np.ndarray) -> QImage:
    """A picture in the format that is painted fastest, owning its pixels."""
    rows = np.ascontiguousarray(frame)
    height, width = rows.shape[:2]
    return QImage(rows.data, width, height, 3 * width, QImage.Format.Format_RGB888).convertToFormat(
        QImage.Format.Format_RGB32
    )
