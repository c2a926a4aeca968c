"""Lanes over an axis of frames: a playhead, zoom and scroll, and keys that step."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy

from app.window.performance.keyed_view import PLAIN, SHIFT, KeptView
from app.window.timeline.axis import Axis

LEFT, RIGHT = Qt.Key.Key_Left, Qt.Key.Key_Right


class TimeView(KeptView):
    """``frame`` is where the playhead stands, -1 for nowhere; ``sought`` asks for another."""

    sought = Signal(int)

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.axis = Axis(count=2)
        self.frame = -1
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        for held, frames in ((PLAIN, 1), (SHIFT, 10)):
            self.keys[held, LEFT] = lambda frames=frames: self._step(-frames)  # type: ignore[misc]
            self.keys[held, RIGHT] = lambda frames=frames: self._step(frames)  # type: ignore[misc]
        self.keys[PLAIN, Qt.Key.Key_Home] = lambda: self.sought.emit(0)
        self.keys[PLAIN, Qt.Key.Key_End] = lambda: self.sought.emit(max(self.frames - 1, 0))

    @property
    def frames(self) -> int:
        """How many frames there are."""
        return max(self.axis.count - 1, 0)

    def _step(self, frames: int) -> None:
        self.sought.emit(min(max(self.frame + frames, 0), max(self.frames - 1, 0)))

    def show_frame(self, frame: int) -> None:
        """Move the playhead, -1 for none; the lanes are not drawn again unless they have to scroll."""
        if frame == self.frame:
            return
        self.frame = frame
        if frame >= 0:
            self.set_axis(self.axis.showing(frame))
        self.update()

    def set_axis(self, axis: Axis) -> None:
        """Show another stretch of time."""
        if axis != self.axis:
            self.axis = axis
            self.refresh()

    def show_all(self) -> None:
        """Show all of it."""
        self.set_axis(self.axis.whole())

    def zoom(self, factor: float) -> None:
        """Zoom in time round the playhead."""
        frame = max(self.frame, 0)
        self.set_axis(self.axis.showing(frame).zoomed(factor, self.axis.x(frame)))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the axis to the width."""
        self.axis = self.axis.sized(self.width(), self.axis.count)
        self.refresh()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom in time at the mouse; scroll with Shift or sideways."""
        steps, sideways = event.angleDelta().y(), event.angleDelta().x()
        if sideways or event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self.set_axis(self.axis.scrolled(-(sideways or steps) / 2))
        else:
            self.set_axis(self.axis.zoomed(1.0015**steps, event.position().x()))
        event.accept()
