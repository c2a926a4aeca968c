"""How sure a point is through the whole clip; a click goes to the frame."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import theme
from app.window.lanes_of import DOUBT
from app.window.reading import KnownTrack


class ConfidenceStrip(QWidget):
    """One column a frame: as high as it is sure, amber below the limit; a hidden frame is grey."""

    go = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.known: KnownTrack | None = None
        self.clicks: tuple[int, ...] = ()
        self.frame = 0
        self.setFixedHeight(34)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setToolTip("How sure the point is in every frame; the dashed line is the limit. A click goes there.")
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def show_track(self, known: KnownTrack, clicks: tuple[int, ...], frame: int) -> None:
        """Show a track and where we are."""
        self.known, self.clicks, self.frame = known, clicks, frame
        self.update()

    def sizeHint(self) -> QSize:
        """As wide as there is room."""
        return QSize(200, 34)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Go to the frame under the mouse."""
        if self.known is not None and len(self.known.confidence):
            count = len(self.known.confidence)
            self.go.emit(min(max(int(event.position().x() / self.width() * count), 0), count - 1))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw at most one column a pixel, of its least sure frame."""
        painter = QPainter(self)
        look = theme.active()
        width, bottom = self.width(), self.height() - 5.0
        painter.fillRect(QRectF(0, 0, width, bottom), look.colour("canvas"))
        known = self.known
        if known is not None and len(known.confidence):
            count = len(known.confidence)
            edges = np.unique(np.linspace(0, count, min(count, width) + 1).astype(int))
            lowest = np.minimum.reduceat(known.confidence, edges[:-1])
            hidden = np.logical_or.reduceat(known.state != "visible", edges[:-1])
            for first, last, value, gone in zip(edges[:-1], edges[1:], lowest.tolist(), hidden.tolist(), strict=True):
                token = "line2" if gone else "ok" if value >= DOUBT else "warn"
                height = max(value * (bottom - 2), 1.5)
                left, right = first / count * width, last / count * width
                painter.fillRect(QRectF(left, bottom - height, max(right - left - 0.4, 1), height), look.colour(token))
            y = bottom - DOUBT * (bottom - 2)
            painter.setPen(QPen(look.colour("text3"), 1, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(0, y), QPointF(width, y))
            for click in self.clicks:
                painter.fillRect(QRectF((click + 0.5) / count * width - 1, bottom + 1, 2.5, 4), look.colour("edit"))
            x = (self.frame + 0.5) / count * width
            painter.setPen(QPen(look.colour("text"), 1.4))
            painter.drawLine(QPointF(x, 0), QPointF(x, bottom))
        painter.end()
