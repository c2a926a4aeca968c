"""The 3D view by the keyboard: Ctrl with the arrows turns it, zooming goes nearer; a ring shows who has the keys."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QFocusEvent, QPainter

from app.window.performance.keyed_view import BY_KEYS, paint_ring
from app.window.viewport import Viewport

TURN = 24.0
"""Pixels of the mouse that a key press turns the view by."""
NEARER = 1.15


class ViewKeys(QObject):
    """Commands of the view while it has the focus."""

    def __init__(self, viewport: Viewport) -> None:
        super().__init__(viewport)
        self._viewport = viewport
        self.ringed = False
        viewport.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        viewport.setAccessibleName("Preview in 3D")
        viewport.installEventFilter(self)

    def command(self, name: str) -> bool:
        """Do a command where the view has the keys; says whether it did."""
        if not self._viewport.hasFocus():
            return False
        turns = {"nudge_left": (TURN, 0), "nudge_right": (-TURN, 0), "nudge_up": (0, TURN), "nudge_down": (0, -TURN)}
        if name in turns:
            self._viewport.move_view(*turns[name], panning=False)
        elif name in ("zoom_time_in", "zoom_time_out"):
            orbit = self._viewport.orbit
            self._viewport.orbit = replace(
                orbit, distance=orbit.distance * (1 / NEARER if name == "zoom_time_in" else NEARER)
            )
            self._viewport.redraw()
        else:
            return False
        return True

    def paint(self, painter: QPainter) -> None:
        """Draw the ring."""
        if self.ringed:
            paint_ring(painter, QRectF(self._viewport.rect()))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Follow the focus."""
        if event.type() in (QEvent.Type.FocusIn, QEvent.Type.FocusOut) and isinstance(event, QFocusEvent):
            self.ringed = event.type() == QEvent.Type.FocusIn and event.reason() in BY_KEYS
            self._viewport.surface.update()
        return False
