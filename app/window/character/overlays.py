"""What is painted over the 3D picture beside the handles: trails of the points, the camera, legends."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QLinearGradient, QPainter, QPen, QPolygonF

from app.actions.heat import Heat
from app.window import fonts, theme
from app.window.canvas import marks
from app.window.viewport.handles import LEGEND, Handle, paint_shape
from app.window.viewport.lens import Lens
from imitation.geometry import Camera

Array = NDArray[np.float64]
Way = list[list[float]]
"""Widget places [x, y], NaN where unknown."""
NARROW = 420
"""Pixels of width below which a view has no room for legends."""
HEAT_WIDTH = 112
"""Pixels at the right that the legend of the colours takes, with the words beside its bar."""


@dataclass(frozen=True, eq=False)
class Trail:
    """The way of a point.

    colour : of its track. places : (k, 3) world, or (k, 2) picture pixels, NaN where unknown. now : index of the
    frame shown.
    """

    colour: str
    places: Array
    now: int


def paint_trails(painter: QPainter, lens: Lens, trails: Sequence[Trail]) -> None:
    """Draw the ways of points in space: thin, the coming part dashed."""
    for trail, seen in zip(trails, _placed(trails, lens.to_widget), strict=True):
        _way(painter, seen[: trail.now + 1], trail.colour, dash=False)
        _way(painter, seen[trail.now :], trail.colour, dash=True)


def paint_points(painter: QPainter, trails: Sequence[Trail], scale: float, x: float, y: float) -> None:
    """Draw tracked points over the film: their ways in picture pixels, placed by the view, and a cross for now."""
    for trail, seen in zip(trails, _placed(trails, lambda places: (places + 0.5) * scale + (x, y)), strict=True):
        _way(painter, seen[: trail.now + 1], trail.colour, dash=False)
        px, py = seen[trail.now]
        if math.isfinite(px + py):
            marks.cross(painter, px, py, QColor(trail.colour), 4.5)


def _placed(trails: Sequence[Trail], to_widget: Callable[[Array], Array]) -> list[Way]:
    """Where the places of all trails are seen: one product for all of them costs as much as for one."""
    if not trails:
        return []
    seen = to_widget(np.concatenate([trail.places for trail in trails])).tolist()
    ends = np.cumsum([len(trail.places) for trail in trails]).tolist()
    return [seen[begin:end] for begin, end in zip((0, *ends), ends, strict=False)]


def _way(painter: QPainter, seen: Way, colour: str, *, dash: bool) -> None:
    line = QPolygonF([QPointF(x, y) for x, y in seen if x == x and y == y])
    if line.size() > 1:
        painter.setPen(_pen(colour, dash))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(line)


@lru_cache(maxsize=64)
def _pen(colour: str, dash: bool) -> QPen:
    faint = QColor(colour)
    faint.setAlpha(170)
    pen = QPen(faint, 1.4)
    if dash:
        pen.setDashPattern([2.0, 3.0])
    return pen


def paint_camera(painter: QPainter, lens: Lens, camera: Camera, size: tuple[int, int], length: float) -> None:
    """Draw the recovered camera as a pyramid that is ``length`` long, world units."""
    width, height = size
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height]], float) - 0.5
    base = camera.lift(corners, np.full(4, length))
    seen, tip = lens.to_widget(base), lens.to_widget(camera.centre)
    if not (np.isfinite(seen).all() and np.isfinite(tip).all()):
        return
    look = theme.active()  # it is drawn in space only, on the ground of the look itself
    painter.setPen(QPen(look.colour("contact", 210), 1.4))
    painter.setBrush(look.colour("contact", 26))
    points = [QPointF(float(x), float(y)) for x, y in seen]
    painter.drawPolygon(points)
    for point in points:
        painter.drawLine(QPointF(float(tip[0]), float(tip[1])), point)


def paint_legend(painter: QPainter, lens: Lens, *, ghosts: bool) -> None:
    """Say at the bottom what the shapes of the handles mean."""
    width, height = lens.size
    if width < NARROW:
        return
    face = fonts.font(fonts.CAPTION, QFont.Weight.Medium)
    metrics = QFontMetricsF(face)
    entries = [*LEGEND, ("before", "before the edit")]
    if ghosts:
        entries.append(("ghost", "other frames"))
    total = sum(metrics.horizontalAdvance(text) + 34 for _, text in entries)
    x, y = 12.0, height - 20.0
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(marks.PLATE)
    painter.drawRoundedRect(QRectF(x - 4, y - 13, min(total, width - 16.0), 26), 5, 5)
    for kind, text in entries:
        if x + metrics.horizontalAdvance(text) + 26 > width - 8:
            break
        _sample(painter, kind, x + 10, y)
        painter.setFont(face)
        painter.setPen(theme.DARK.colour("text"))
        room = QRectF(x + 22, y - 13, metrics.horizontalAdvance(text) + 2, 26)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, text)
        x += metrics.horizontalAdvance(text) + 34


def _sample(painter: QPainter, kind: str, x: float, y: float) -> None:
    if kind == "before":
        marks.ring(painter, x, y, QColor(255, 255, 255, 170), 4.5, dot=False)
    elif kind == "ghost":
        painter.setPen(QPen(theme.DARK.colour("ok"), 2.0))
        painter.drawPoints([QPointF(x + dx, y + dy) for dx, dy in ((-4, -2), (0, 3), (4, -3), (-1, -4), (3, 2))])
    else:
        paint_shape(painter, Handle(0, "", (0.0, 0.0, 0.0), kind), x, y)


def paint_heat_legend(painter: QPainter, lens: Lens, heat: Heat) -> None:
    """Draw the bar of colours at the right, with what they stand for."""
    width, height = lens.size
    bar = QRectF(width - 30.0, max(height / 2 - 90.0, 44.0), 12.0, min(180.0, height - 110.0))
    if bar.height() < 40:
        return
    fade = QLinearGradient(bar.bottomLeft(), bar.topLeft())
    for number, colour in enumerate(heat.ramp):
        fade.setColorAt(number / (len(heat.ramp) - 1), QColor(*colour))
    painter.setPen(QPen(marks.UNDERLAY, 3.0))
    painter.setBrush(fade)
    painter.drawRoundedRect(bar, 3, 3)
    text = theme.DARK.colour("text")
    for share, words in heat.marks:
        marks.plate(painter, bar.left() - 6, bar.bottom() - share * bar.height(), words, text, align="right")
    marks.plate(painter, width - 12.0, bar.top() - 20, heat.title, text, align="right")
    if heat.note and width > NARROW:
        marks.plate(painter, width - 12.0, bar.bottom() + 22, heat.note, theme.DARK.colour("text2"), align="right")
