"""A second picture over the first: whole or from a line on, more or less opaque, with what its colours stand for."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPainterPath, QPen

from app.window import fonts, theme
from app.window.canvas import marks
from app.window.canvas.overlays import path_through
from app.window.canvas.view import View

KNOB = 13.0
KNOB_AT = 0.8
"""Share of the height at which the line is taken hold of: below what is usually looked at."""
BAR = (180.0, 10.0)


@dataclass(frozen=True)
class Scale:
    """What the colours of a picture stand for: a strip of colours and texts below it at shares of its width."""

    title: str
    strip: QImage
    ticks: tuple[tuple[float, str], ...]


@dataclass(frozen=True, eq=False)
class Backdrop:
    """A picture of the clip's size over the frame.

    picture : what is laid over, null where there is none yet. opacity : 0 to 1.
    wipe : column of the picture from which on it lies over the frame, None for all of it.
    outlines : (k, 2) polygons in picture pixels round what was painted in. scale : what its colours stand for.
    title : what it shows, beside the line of the wipe.
    """

    picture: QImage
    opacity: float = 1.0
    wipe: float | None = None
    outlines: tuple[NDArray[np.float64], ...] = ()
    scale: Scale | None = None
    title: str = ""
    lit: bool = field(default=False)

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the picture, the line, and the legend."""
        if self.picture.isNull():
            return
        width, height = self.picture.width() * view.scale, self.picture.height() * view.scale
        whole = QRectF(view.x, view.y, width, height)
        painter.save()
        if self.wipe is not None:
            painter.setClipRect(QRectF(self._x(view), view.y, view.x + width - self._x(view), height))
        painter.setOpacity(self.opacity)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, view.scale < 3)
        painter.drawImage(whole, self.picture)
        painter.setOpacity(1.0)
        for line in self.outlines:
            closed = path_through(view.to_widget(np.vstack([line, line[:1]])))
            marks.stroke(painter, closed, theme.DARK.colour("warn"), 1.4, dash=True)
        painter.restore()
        if self.wipe is not None:
            self._line(painter, view, whole, size)
        if self.scale is not None:
            self._legend(painter, self.scale, size)

    def _x(self, view: View) -> float:
        return view.point(float(self.wipe or 0.0), 0.0)[0]

    def _line(self, painter: QPainter, view: View, whole: QRectF, size: tuple[int, int]) -> None:
        x, look = self._x(view), theme.DARK
        top, bottom = max(whole.top(), 0.0), min(whole.bottom(), float(size[1]))
        line = QPainterPath(QPointF(x, top))
        line.lineTo(x, bottom)
        marks.stroke(painter, line, look.colour("accent" if self.lit else "text"), 2.0)
        middle = QPointF(x, top + KNOB_AT * (bottom - top))
        painter.setPen(QPen(marks.UNDERLAY, 3.6))
        painter.setBrush(look.colour("accent" if self.lit else "text"))
        painter.drawEllipse(middle, KNOB, KNOB)
        painter.setPen(QPen(look.colour("on_accent"), 2.0))
        for side in (-1, 1):
            tip = QPointF(middle.x() + side * 8, middle.y())
            for rise in (-4, 4):
                painter.drawLine(tip, QPointF(middle.x() + side * 4, middle.y() + rise))
        y = top + 21
        for side, text in (("right", "film"), ("left", self.title.lower())):
            shift = -12 if side == "right" else 12
            room = x + shift - 8 if side == "right" else size[0] - x - shift - 8
            if text and marks.plate_size(text)[0] < room:
                marks.plate(painter, x + shift, y, text, look.colour("text"), align=side)

    def _legend(self, painter: QPainter, scale: Scale, size: tuple[int, int]) -> None:
        face = fonts.font(fonts.LANE)
        metrics = QFontMetricsF(face)
        line = metrics.height()
        box = QRectF(10, size[1] - 10 - (2 * line + BAR[1] + 20), BAR[0] + 24, 2 * line + BAR[1] + 20)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(marks.PLATE)
        painter.drawRoundedRect(box, 5, 5)
        painter.setFont(face)
        painter.setPen(theme.DARK.colour("text"))
        left, top = box.left() + 12, box.top() + 6
        painter.drawText(QRectF(left, top, BAR[0], line), Qt.AlignmentFlag.AlignLeft, scale.title)
        strip = QRectF(left, top + line + 4, *BAR)
        painter.drawImage(strip, scale.strip)
        painter.setPen(QColor(255, 255, 255, 160))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(strip)
        painter.setPen(theme.DARK.colour("text2"))
        for share, text in scale.ticks:
            wide = metrics.horizontalAdvance(text) + 1
            x = min(max(strip.left() + share * strip.width() - wide / 2, left), strip.right() - wide)
            painter.drawText(QRectF(x, strip.bottom() + 4, wide, line), Qt.AlignmentFlag.AlignLeft, text)
