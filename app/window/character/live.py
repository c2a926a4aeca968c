"""The mesh that follows the mouse: solved in a worker that serves only the newest place."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from app.actions.posing import PoseDrag, placed_moves
from app.actions.session import Session

Array = NDArray[np.float64]
Place = tuple[float, float, float]


class LivePose(QObject):
    """Poses one frame after the other in one thread.

    ``posed`` gives (frame, vertices) while a vertex is dragged, ``committed`` (character, frame, moves, places, those
    on their rays) after its release, ``failed`` a sentence.
    """

    posed = Signal(int, object)
    committed = Signal(str, int, object, object, object)
    failed = Signal(str, object)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._wake = threading.Condition()
        self._target: tuple[str, int, Array] | None = None
        self._places: dict[int, Place] = {}
        self._moved: set[int] = set()
        self._on_rays: set[int] = set()
        self._release = False
        self._closing = False
        self.solves = 0
        self._thread = threading.Thread(target=self._serve, name="live pose", daemon=True)
        self._thread.start()

    def begin(self, character_id: str, frame: int, before: Array) -> None:
        """Make ready to pose a frame of a character that looks like ``before`` now."""
        with self._wake:
            self._target, self._places, self._moved, self._release = (character_id, frame, before), {}, set(), False
            self._on_rays = set()
            self._wake.notify()

    def move(self, vertex: int, place: Place, on_ray: bool = False) -> None:
        """Put a vertex somewhere, or on its ray through there; a place that was not served yet is replaced."""
        with self._wake:
            self._places[vertex] = place
            (self._on_rays.add if on_ray else self._on_rays.discard)(vertex)
            self._moved.add(vertex)
            self._wake.notify()

    def release(self) -> None:
        """Relax the pose to the end and hand it over."""
        with self._wake:
            self._release = True
            self._wake.notify()

    def cancel(self) -> None:
        """Forget the pose."""
        with self._wake:
            self._target, self._places, self._moved, self._release = None, {}, set(), False

    def close(self) -> None:
        """End the thread."""
        with self._wake:
            self._closing = True
            self._wake.notify()
        self._thread.join()

    def _serve(self) -> None:
        drag: PoseDrag | None = None
        served: tuple[str, int, Array] | None = None
        while True:
            with self._wake:
                while not self._closing and not self._has_work(served):
                    self._wake.wait()
                if self._closing:
                    return
                target, places, release = self._target, self._places, self._release
                moved, on_rays = set(self._moved), frozenset(self._on_rays)
                self._places, self._release = {}, False
            try:
                if target is not None and target is not served:
                    character_id, frame, before = target
                    drag = PoseDrag(self._session, character_id, frame, before=before)
                served = target
                if drag is not None and target is not None:
                    self._step(drag, places, on_rays, moved if release else set(), served)
            except Exception as error:  # noqa: BLE001 - told to the user, the thread goes on
                drag = None
                self.cancel()
                self._say(self.failed, str(error), error)

    def _has_work(self, served: object) -> bool:
        if self._target is None:
            return False
        return self._target is not served or bool(self._places) or self._release

    def _step(
        self, drag: PoseDrag, places: dict[int, Place], on_rays: frozenset[int], released: set[int], served: object
    ) -> None:
        if places:
            vertices = drag.move(places, on_rays)
            self.solves += 1
            self._say(self.posed, drag.frame, vertices)
        if released:
            committed = drag.committed()
            moves = placed_moves(drag, released, committed)
            with self._wake:
                if self._target is served:
                    self._target = None
            self._say(self.committed, drag.character_id, drag.frame, moves, committed, drag.on_rays)

    def _say(self, signal: Any, *values: object) -> None:
        if not self._closing:
            signal.emit(*values)
