"""How marks over a picture are drawn, so that they can be read on any picture: each has a dark underlay."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPixmap, QPolygonF

from app.window import fonts

UNDERLAY = QColor(0, 0, 0, 190)
PLATE = QColor(0, 0, 0, 205)
PHASES = 4
"""Places within a pixel at which rings are stamped."""
_THICK, _WHITE = QPen(UNDERLAY, 3.6), QPen(QColor(255, 255, 255, 235), 1.8)


def stroke(
    painter: QPainter, path: QPainterPath | QPolygonF, colour: QColor, width: float = 1.8, dash: bool = False
) -> None:
    """Draw a line with its underlay."""
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in _pens(colour.rgba(), width, dash):
        painter.setPen(pen)
        if isinstance(path, QPolygonF):
            painter.drawPolyline(path)
        else:
            painter.drawPath(path)


@lru_cache(maxsize=128)
def _pens(colour: int, width: float, dash: bool) -> tuple[QPen, QPen]:
    """The pens of the underlay and of a line in a colour (ARGB)."""
    pen = QPen(UNDERLAY, width + 1.8)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    top = QPen(pen)
    top.setColor(QColor.fromRgba(colour))
    top.setWidthF(width)
    if dash:
        top.setDashPattern([3.0, 2.5])
    return pen, top


def ring(
    painter: QPainter,
    x: float,
    y: float,
    colour: QColor,
    radius: float = 5.5,
    *,
    filled: bool = False,
    dot: bool = True,
) -> None:
    """A round handle: a ring, or a filled disc.

    It is stamped to a quarter of a pixel: three smooth circles take ten times as long as one small picture of them.
    """
    ratio = painter.device().devicePixelRatio()
    if ratio % 1:
        _draw_ring(painter, x, y, colour, radius, filled, dot)
        return
    (left, right), (top, low) = (divmod(round(PHASES * ratio * value), PHASES) for value in (x, y))
    stamp, half = _ring_stamp(colour.rgba(), radius, filled, dot, right, low, round(ratio))
    painter.drawPixmap(QPointF((left - half) / ratio, (top - half) / ratio), stamp)


@lru_cache(maxsize=1024)
def _ring_stamp(
    colour: int, radius: float, filled: bool, dot: bool, right: int, low: int, ratio: int
) -> tuple[QPixmap, int]:
    """A picture of a ring, so many quarters of a pixel off its middle, and half its size in pixels; colours as ARGB."""
    half = math.ceil((radius + 2.0) * ratio) + 1
    stamp = QPixmap(2 * half + 1, 2 * half + 1)
    stamp.setDevicePixelRatio(ratio)
    stamp.fill(Qt.GlobalColor.transparent)
    painter = QPainter(stamp)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    x, y = ((half + part / PHASES) / ratio for part in (right, low))
    _draw_ring(painter, x, y, QColor.fromRgba(colour), radius, filled, dot)
    painter.end()
    return stamp, half


def _draw_ring(painter: QPainter, x: float, y: float, colour: QColor, radius: float, filled: bool, dot: bool) -> None:
    centre = QPointF(x, y)
    painter.setPen(_THICK)
    painter.setBrush(colour if filled else Qt.BrushStyle.NoBrush)
    painter.drawEllipse(centre, radius, radius)
    painter.setPen(_WHITE if filled else QPen(colour, 1.8))
    painter.drawEllipse(centre, radius, radius)
    if dot and not filled:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(centre, 1.5, 1.5)


def cross(painter: QPainter, x: float, y: float, colour: QColor, radius: float = 5.0) -> None:
    """A cross, for what is hidden or refused."""
    for pen in (_THICK, QPen(colour, 1.6)):
        painter.setPen(pen)
        painter.drawLine(QPointF(x - radius, y - radius), QPointF(x + radius, y + radius))
        painter.drawLine(QPointF(x - radius, y + radius), QPointF(x + radius, y - radius))


@lru_cache(maxsize=512)
def plate_size(text: str, size: int = fonts.CAPTION) -> tuple[float, float]:
    """Width and height of a plate with a text."""
    metrics = QFontMetricsF(fonts.font(size, QFont.Weight.Medium))
    return metrics.horizontalAdvance(text) + 12, metrics.height() + 4


def plate(
    painter: QPainter, x: float, y: float, text: str, colour: QColor, *, size: int = fonts.CAPTION, align: str = "left"
) -> QRectF:
    """A short text on a dark plate; (x, y) is the middle of its left or right end, or of its centre."""
    face = fonts.font(size, QFont.Weight.Medium)
    width, height = plate_size(text, size)
    left = x if align == "left" else x - width if align == "right" else x - width / 2
    box = QRectF(round(left), round(y - height / 2), width, height)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(PLATE)
    painter.drawRoundedRect(box, 4, 4)
    painter.setFont(face)
    painter.setPen(colour)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)
    return box


def polygon(points: ArrayLike) -> QPolygonF:
    """A Qt polygon of widget places (n, 2)."""
    rows: Iterable[tuple[float, float]] = np.asarray(points, np.float64).tolist()
    return QPolygonF([QPointF(x, y) for x, y in rows])
