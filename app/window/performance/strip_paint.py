"""How the structure of a sequence is drawn."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from app.window import fonts, icons, theme
from app.window.performance.strip import BAR, BOX, CURVE, TEXTONS, Strip, StripMotion
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER

TITLES = (("textons", "Textons", RULER, TEXTONS), ("reprojection", "Atom distance", RULER + TEXTONS, CURVE))


def paint_strip(painter: QPainter, axis: Axis, strip: Strip) -> None:
    """Draw both lanes with their labels."""
    look = theme.active()
    painter.save()
    painter.setClipRect(QRectF(LABELS, RULER, axis.width - LABELS, TEXTONS + CURVE))
    for motion in strip.motions:
        if axis.x(motion.last + 1) >= LABELS and axis.x(motion.first) <= axis.width:
            _motion(painter, axis, motion)
    if strip.curve is not None:
        _curve(painter, axis, strip)
    for frame in strip.boundaries:
        painter.setPen(QPen(look.colour("text3"), 1, Qt.PenStyle.DashLine))
        x = axis.x(frame)
        painter.drawLine(QPointF(x, RULER + 2), QPointF(x, RULER + TEXTONS + CURVE))
    painter.restore()
    for icon, title, top, height in TITLES:
        middle = top + height / 2
        painter.drawPixmap(QPointF(12, middle - 8), icons.pixmap(icon, "text3", 16))
        painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.Medium))
        painter.setPen(look.colour("text2"))
        painter.drawText(QRectF(36, middle - 10, LABELS - 44, 20), Qt.AlignmentFlag.AlignVCenter, title)
        painter.setPen(look.colour("line"))
        painter.drawLine(QPointF(0, top + height - 0.5), QPointF(axis.width, top + height - 0.5))
    painter.drawLine(QPointF(LABELS - 0.5, 0), QPointF(LABELS - 0.5, 4000))


def _motion(painter: QPainter, axis: Axis, motion: StripMotion) -> None:
    look = theme.active()
    left, right = axis.x(motion.first) + 0.75, axis.x(motion.last + 1) - 0.75
    bar = QRectF(left, RULER + BAR[0], max(right - left, 1.0), BAR[1])
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour(motion.colour, 230))
    painter.drawRoundedRect(bar, 2.5, 2.5)
    if motion.forbidden:
        painter.setBrush(QBrush(look.colour("panel", 200), Qt.BrushStyle.BDiagPattern))
        painter.drawRoundedRect(bar, 2.5, 2.5)
    _words(painter, bar, motion)
    apart = 1.5 if axis.pixels * max(motion.last - motion.first, 1) / max(len(motion.textons), 1) > 6 else 0.5
    for number, (first, last) in enumerate(motion.textons):
        box = QRectF(axis.x(first) + apart / 2, RULER + BOX[0], 0, BOX[1])
        box.setRight(axis.x(last + 1) - apart / 2)
        kept = number == motion.kept
        painter.setPen(QPen(look.colour(motion.colour), 1.3) if box.width() > 3 else Qt.PenStyle.NoPen)
        narrow = box.width() < 11
        painter.setBrush(look.colour(motion.colour, (255 if narrow else 150) if kept else 45))
        painter.drawRoundedRect(box, 3, 3)
        if kept and not narrow:
            star(painter, box.center().x(), box.center().y(), min(6.5, box.width() / 2 - 1.5))


def _words(painter: QPainter, bar: QRectF, motion: StripMotion) -> None:
    """The name, with how often it repeats where there is room."""
    face = fonts.font(fonts.LANE, QFont.Weight.DemiBold)
    metrics = QFontMetricsF(face)
    times = f", {len(motion.textons)} times" if len(motion.textons) > 1 else ", once"
    number = motion.name.rsplit("/", 1)[-1]
    shown = bar.intersected(QRectF(LABELS + 2, 0, 1e5, 1e4))
    for text in (motion.name + times, motion.name, number):
        if metrics.horizontalAdvance(text) + 8 <= shown.width():
            painter.setFont(face)
            painter.setPen(theme.active().colour("on_accent"))
            painter.drawText(shown, Qt.AlignmentFlag.AlignCenter, text)
            return


def star(painter: QPainter, x: float, y: float, radius: float) -> None:
    """Draw the mark of what is kept, with a dark rim."""
    shape = QPolygonF()
    for corner in range(10):
        turn = math.pi * corner / 5 - math.pi / 2
        reach = radius if corner % 2 == 0 else 0.45 * radius
        shape.append(QPointF(x + reach * math.cos(turn), y + reach * math.sin(turn)))
    look = theme.active()
    painter.setPen(QPen(look.colour("canvas" if look.name == "dark" else "raised"), 1.2))
    painter.setBrush(look.colour("text"))
    painter.drawPolygon(shape)


def _curve(painter: QPainter, axis: Axis, strip: Strip) -> None:
    look, curve = theme.active(), strip.curve
    assert curve is not None
    low, high = max(int(axis.first) - 1, 0), min(int(axis.last) + 3, len(curve))
    top, bottom = RULER + TEXTONS + 7.0, RULER + TEXTONS + CURVE - 7.0
    largest = max(float(np.nanmax(curve, initial=0.0)), 1e-9)

    def y(value: float) -> float:
        return bottom - (bottom - top) * value / largest

    line = QPolygonF(
        [
            QPointF(axis.x(low + k + 0.5), y(value))
            for k, value in enumerate(curve[low:high].tolist())
            if math.isfinite(value)
        ]
    )
    painter.setPen(QPen(look.colour("accent"), 1.4))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(line)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("text"))
    for motion in strip.motions:
        for first, last in motion.textons:
            if low <= first < high:
                radius = min(2.6, max(0.16 * (last + 1 - first) * axis.pixels, 1.0))
                painter.drawEllipse(QPointF(axis.x(first + 0.5), y(float(curve[first]))), radius, radius)


def paint_boundary(painter: QPainter, axis: Axis, frame: int, token: str) -> None:
    """Draw a boundary that is held or chosen, with its frame on a plate."""
    look = theme.active()
    x = axis.x(frame)
    if not LABELS <= x <= axis.width:
        return
    painter.setPen(QPen(look.colour(token), 2.0))
    painter.drawLine(QPointF(x, RULER + 1), QPointF(x, RULER + TEXTONS + CURVE))
    text = str(frame)
    width = 12.0 + 7.0 * len(text)
    box = QRectF(min(max(x - width / 2, LABELS + 1), axis.width - width - 1), RULER + TEXTONS - 9, width, 17)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour(token))
    painter.drawRoundedRect(box, 4, 4)
    painter.setPen(look.colour("on_accent"))
    painter.setFont(fonts.font(fonts.LANE, QFont.Weight.DemiBold))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def paint_span(painter: QPainter, axis: Axis, span: tuple[int, int]) -> None:
    """Draw round the texton that is chosen."""
    painter.setPen(QPen(theme.active().colour("accent"), 2.0))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    left, right = axis.x(span[0]), axis.x(span[1] + 1)
    painter.save()
    painter.setClipRect(QRectF(LABELS, RULER, axis.width - LABELS, TEXTONS))
    painter.drawRoundedRect(QRectF(left, RULER + BOX[0] - 1, right - left, BOX[1] + 2), 3, 3)
    painter.restore()
