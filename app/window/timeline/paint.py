"""How lanes are drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QFont, QImage, QPainter, QPen, QPolygonF

from app.window import fonts, icons, theme
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.drags import LaneEdit
from app.window.timeline.lanes import HANDLE, RULER, Bar, Curve, Diamond, Placed

Thumbnail = Callable[[int], QImage | None]


def paint_ruler(painter: QPainter, axis: Axis) -> None:
    """Draw frame numbers and ticks."""
    look = theme.active()
    large, small = axis.ticks()
    painter.setFont(fonts.font(fonts.CAPTION))
    first = int(axis.first) // small * small
    for frame in range(first, int(axis.last) + 1, small):
        x = axis.x(frame)
        if x < LABELS + 2:
            continue
        numbered = frame % large == 0
        painter.setPen(QPen(look.colour("line2" if numbered else "line"), 1))
        painter.drawLine(QPointF(x, RULER - (6 if numbered else 4)), QPointF(x, RULER - 1))
        if numbered:
            painter.setPen(look.colour("text3"))
            painter.drawText(QRectF(x - 30, 2, 60, RULER - 9), Qt.AlignmentFlag.AlignCenter, str(frame))
    painter.setPen(look.colour("line"))
    painter.drawLine(QPointF(0, RULER - 0.5), QPointF(axis.width, RULER - 0.5))


def paint_lanes(painter: QPainter, axis: Axis, placed: Sequence[Placed], thumbnail: Thumbnail | None) -> None:
    """Draw all lanes with their labels."""
    look = theme.active()
    for each in placed:
        painter.save()
        painter.setClipRect(QRectF(LABELS, each.top, axis.width - LABELS, each.height))
        if each.lane.thumbnails:
            _thumbnails(painter, axis, each, thumbnail)
        if each.lane.curve is not None:
            _curve(painter, axis, each, each.lane.curve)
        for row, top, height in each.rows:
            if row.selected and each.lane.row_height < 14:
                painter.fillRect(QRectF(LABELS, top - 1, axis.width, height + 2), look.colour("hover"))
            for bar in row.bars:
                paint_bar(painter, axis, bar, top, height)
            for mark in row.diamonds:
                large = row.selected or each.lane.row_height >= 14
                paint_diamond(painter, axis.x(mark.frame), top + height / 2, mark, 5.5 if large else 4.0)
        painter.restore()
        _label(painter, each)
        painter.setPen(look.colour("line"))
        bottom = each.top + each.height - 0.5
        painter.drawLine(QPointF(0, bottom), QPointF(axis.width, bottom))
    painter.drawLine(QPointF(LABELS - 0.5, 0), QPointF(LABELS - 0.5, 4000))


def _label(painter: QPainter, placed: Placed) -> None:
    look = theme.active()
    middle = placed.top + placed.height / 2
    painter.drawPixmap(QPointF(12, middle - 8), icons.pixmap(placed.lane.icon, "text3", 16))
    painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.Medium))
    painter.setPen(look.colour("text2"))
    painter.drawText(QRectF(36, middle - 10, LABELS - 44, 20), Qt.AlignmentFlag.AlignVCenter, placed.lane.words)


def paint_bar(painter: QPainter, axis: Axis, bar: Bar, top: float, height: float) -> None:
    """Draw frames first to last; low confidence is hatched, so that colour is never the only sign."""
    look = theme.active()
    thick = min(height - 2, 14.0) if height >= 14 else max(height - 4, 3.0)
    half = min(axis.pixels / 2, 3.0) if bar.first == bar.last else 0.0
    left, right = axis.x(bar.first) - half, axis.x(bar.last) + half
    box = QRectF(left, top + (height - thick) / 2, max(right - left, 2.0), thick)
    colour = look.colour(bar.colour)
    painter.setPen(Qt.PenStyle.NoPen)
    if bar.style == "line":
        painter.setBrush(look.colour(bar.colour, 130))
        box = QRectF(left, top + height / 2 - 0.75, right - left, 1.5)
    elif bar.style == "hatch":
        dim = look.colour(bar.colour, 70)
        painter.setBrush(dim)
        painter.drawRect(box)
        painter.setBrush(QBrush(look.colour(bar.colour, 220), Qt.BrushStyle.BDiagPattern))
    else:
        if bar.style == "dim":
            colour.setAlpha(110)
        painter.setBrush(colour)
    radius = 2.0 if thick > 4 else 1.0
    painter.drawRoundedRect(box, radius, radius)
    if bar.text and box.width() >= 60 and thick >= 12:
        painter.setFont(fonts.font(fonts.LANE, QFont.Weight.Medium))
        painter.setPen(look.colour("on_accent"))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, bar.text)


def paint_diamond(painter: QPainter, x: float, y: float, mark: Diamond, radius: float) -> None:
    """Draw a diamond with a dark rim."""
    look = theme.active()
    shape = QPolygonF([QPointF(x, y - radius), QPointF(x + radius, y), QPointF(x, y + radius), QPointF(x - radius, y)])
    colour = look.colour(mark.colour)
    painter.setPen(QPen(look.colour("panel"), 3.0))
    painter.setBrush(colour if mark.filled else look.colour("panel"))
    painter.drawPolygon(shape)
    painter.setPen(QPen(colour, 1.3))
    painter.drawPolygon(shape)


def _thumbnails(painter: QPainter, axis: Axis, placed: Placed, thumbnail: Thumbnail | None) -> None:
    look = theme.active()
    rows_bottom = max((top + height for _, top, height in placed.rows), default=placed.top + placed.lane.padding)
    top, height = rows_bottom + 2.0, 34.0
    left, right = axis.x(0), axis.x(axis.count - 1)
    painter.fillRect(QRectF(left, top, right - left, height), look.colour("raised"))
    if thumbnail is None:
        return
    sample = thumbnail(0)
    ratio = sample.width() / max(sample.height(), 1) if sample is not None and not sample.isNull() else 16 / 9
    width = height * ratio
    begin = max(int((axis.left - left) // width), 0) if axis.first else 0
    number = begin
    while left + number * width < min(right, axis.width):
        x = left + number * width
        picture = thumbnail(axis.frame(x + width / 2))
        if picture is not None and not picture.isNull():
            visible = min(width, right - x)
            source = QRectF(0, 0, picture.width() * visible / width, picture.height())
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(QRectF(x, top, visible - 1, height), picture, source)
        number += 1


def _curve(painter: QPainter, axis: Axis, placed: Placed, curve: Curve) -> None:
    look = theme.active()
    finite = curve.values[np.isfinite(curve.values)]
    if not len(finite):
        return
    top, bottom = placed.top + 6.0, placed.top + placed.height - 6.0
    high = max(float(finite.max()), curve.limit) * 1.1

    def y(value: float) -> float:
        return bottom - (bottom - top) * value / high

    line = QPolygonF()
    for frame, value in enumerate(curve.values.tolist()):
        if value == value:
            line.append(QPointF(axis.x(frame), y(value)))
    area = QPolygonF(line)
    area.append(QPointF(line.last().x(), bottom))
    area.append(QPointF(line.first().x(), bottom))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("accent", 50))
    painter.drawPolygon(area)
    painter.setPen(QPen(look.colour("accent"), 1.4))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolyline(line)
    painter.setPen(QPen(look.colour("err"), 1, Qt.PenStyle.DashLine))
    painter.drawLine(QPointF(axis.left, y(curve.limit)), QPointF(axis.width, y(curve.limit)))
    painter.setFont(fonts.font(fonts.LANE))
    painter.setPen(look.colour("err"))
    above = y(curve.limit) - 3
    baseline = above if above > placed.top + 12 else above + 14
    painter.drawText(QPointF(axis.left + 4, baseline), f"{curve.limit:g} {curve.unit} limit")


def paint_playhead(painter: QPainter, axis: Axis, frame: int, height: int) -> None:
    """Draw the line of the present frame with its number on a plate in the ruler."""
    x = axis.x(frame)
    if x < LABELS or x > axis.width:
        return
    look = theme.active()
    painter.setPen(QPen(look.colour("panel", 180), 3))
    painter.drawLine(QPointF(x, RULER - 4), QPointF(x, height))
    painter.setPen(QPen(look.colour("text"), 1.4))
    painter.drawLine(QPointF(x, RULER - 4), QPointF(x, height))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("text"))
    text = str(frame)
    width = 14.0 + 8.0 * len(text)
    box = QRectF(min(max(x - width / 2, LABELS + 1), axis.width - width - 1), 3, width, 19)
    painter.drawRoundedRect(box, 4, 4)
    painter.setPen(look.colour("window"))
    painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.DemiBold))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def paint_handles(painter: QPainter, axis: Axis, range_: tuple[int, int], chosen: bool) -> None:
    """Draw the handles of the in and out frames under the numbers of the ruler."""
    look = theme.active()
    for frame, side in ((range_[0], -1), (range_[1], 1)):
        x = axis.x(frame)
        if not LABELS <= x <= axis.width:
            continue
        shape = QPolygonF(
            [QPointF(x, RULER - HANDLE), QPointF(x + side * (HANDLE - 2), RULER - 1), QPointF(x, RULER - 1)]
        )
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("accent" if chosen else "line2"))
        painter.drawPolygon(shape)


def paint_preview(painter: QPainter, axis: Axis, placed: Sequence[Placed], edit: LaneEdit) -> None:
    """Draw what a drag would change: the run, the diamond at its new place, or the new range."""
    look = theme.active()
    if edit.kind == "range":
        left, right = axis.x(edit.first), axis.x(edit.last)
        painter.fillRect(QRectF(left, RULER - 4, right - left, 3), look.colour("accent"))
        return
    for each in placed:
        for row, top, height in each.rows:
            if each.lane.id != edit.lane or row.id != edit.row:
                continue
            painter.fillRect(QRectF(LABELS, top - 1, axis.width, height + 2), look.colour("hover", 200))
            if edit.kind == "retime":
                paint_diamond(painter, axis.x(edit.last), top + height / 2, Diamond(edit.last, "edit"), 5.5)
            else:
                paint_bar(painter, axis, Bar(edit.first, edit.last, "edit"), top, height)
