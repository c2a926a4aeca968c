"""Small pictures of captured frames: drawn in one thread that serves the newest wish first, kept in bounded number."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

KEPT = 1500
SIZE = 112
Key = tuple[str, int]
Draw = Callable[[str, int], NDArray[np.uint8]]


class Thumbnails(QObject):
    """Gives pictures of (sequence, frame); ``ready`` says when one that was asked for is there.

    ``draw`` gives an RGBA picture (h, w, 4); it is called in the thread.
    """

    ready = Signal(str, int)

    def __init__(self, draw: Draw, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._draw = draw
        self._wake = threading.Condition()
        self._wishes: OrderedDict[Key, None] = OrderedDict()
        self._kept: OrderedDict[Key, QImage] = OrderedDict()
        self._closing = False
        self._round = 0
        self._thread: threading.Thread | None = None

    def picture(self, sequence_id: str, frame: int, *, first: bool = False) -> QImage | None:
        """Give a picture if it is there; else it is drawn: before all others with ``first``, else after them."""
        key = (sequence_id, frame)
        with self._wake:
            found = self._kept.get(key)
            if found is not None:
                self._kept.move_to_end(key)
                return found
            if not self._closing:
                self._wishes.setdefault(key, None)
                if first:
                    self._wishes.move_to_end(key, last=False)
                if self._thread is None:
                    self._thread = threading.Thread(target=self._serve, name="thumbnails", daemon=True)
                    self._thread.start()
                self._wake.notify()
        return None

    def forget(self, sequence_id: str = "") -> None:
        """Drop the pictures of a sequence, whose files or front have changed, or of all."""
        with self._wake:
            self._round += 1
            for shelf in (self._kept, self._wishes):
                for key in [each for each in shelf if sequence_id in ("", each[0])]:
                    del shelf[key]  # type: ignore[attr-defined]

    def close(self) -> None:
        """End the thread."""
        with self._wake:
            self._closing = True
            self._wishes.clear()
            self._wake.notify()
        if self._thread is not None:
            self._thread.join()
        self._kept.clear()

    def _serve(self) -> None:
        while True:
            with self._wake:
                while not self._wishes and not self._closing:
                    self._wake.wait()
                if self._closing:
                    return
                key, _ = self._wishes.popitem(last=False)
                begun = self._round
            try:
                picture = _image(self._draw(*key))
            except Exception:  # noqa: BLE001 - a file that cannot be read is told where it is measured
                picture = QImage()
            with self._wake:
                if begun != self._round or self._closing:
                    continue
                self._kept[key] = picture
                while len(self._kept) > KEPT:
                    self._kept.popitem(last=False)
            self.ready.emit(*key)


def _image(picture: NDArray[np.uint8]) -> QImage:
    rows = np.ascontiguousarray(picture)
    height, width = rows.shape[:2]
    made = QImage(rows.data, width, height, 4 * width, QImage.Format.Format_RGBA8888)
    return made.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)
