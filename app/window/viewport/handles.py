"""Marks over the 3D picture: handles of vertices by shape and colour, the axes of the selected one, links to before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.window import theme
from app.window.canvas import marks
from app.window.viewport.lens import Lens

AXIS_COLOURS = ("#FF7A7A", "#4CC38A", "#5AA9FF")
KINDS = {"ray": "2D constraint", "anchor": "3D anchor", "edited": "edited here", "plain": "control vertex"}


@dataclass(frozen=True)
class Handle:
    """A vertex with a meaning: its world place, what it is (ray, anchor, edited, plain), and where it was before."""

    vertex: int
    title: str
    place: tuple[float, float, float]
    kind: str = "plain"
    colour: str = "accent"
    selected: bool = False
    warning: bool = False
    before: tuple[float, float, float] | None = None


def paint_handles(painter: QPainter, lens: Lens, handles: Sequence[Handle], hovered: int = -1) -> None:
    """Draw the handles, the selected one last with its axes and its name."""
    for handle in sorted(handles, key=lambda each: (each.selected, each.kind == "edited")):
        place = lens.to_widget(np.array(handle.place))
        if not np.isfinite(place).all():
            continue
        x, y = float(place[0]), float(place[1])
        _link(painter, lens, handle, x, y)
        _shape(painter, handle, x, y)
        if handle.selected:
            _axes(painter, lens, handle, x, y)
        if handle.selected or handle.vertex == hovered:
            marks.plate(painter, x + 14, y - 20, handle.title, theme.active().colour(_colour(handle)))


def _colour(handle: Handle) -> str:
    return {"edited": "edit", "anchor": "contact"}.get(handle.kind, handle.colour)


def _shape(painter: QPainter, handle: Handle, x: float, y: float) -> None:
    colour = theme.active().colour(_colour(handle))
    if handle.kind == "edited":
        marks.ring(painter, x, y, colour, 7.5, filled=True)
    elif handle.kind == "anchor":
        marks.ring(painter, x, y, colour, 5.5, filled=True)
    else:
        marks.ring(painter, x, y, colour, 5.5)
    if handle.warning:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.active().colour("err"), 2.0))
        painter.drawEllipse(QPointF(x, y), 10.5, 10.5)


def _link(painter: QPainter, lens: Lens, handle: Handle, x: float, y: float) -> None:
    if handle.before is None:
        return
    start = lens.to_widget(np.array(handle.before))
    if np.isfinite(start).all() and np.hypot(start[0] - x, start[1] - y) > 4:
        pen = QPen(QColor(255, 255, 255, 150), 1.4, Qt.PenStyle.DashLine)
        painter.setPen(pen)
        painter.drawLine(QPointF(float(start[0]), float(start[1])), QPointF(x, y))
        marks.ring(painter, float(start[0]), float(start[1]), QColor(255, 255, 255, 150), 4.5, dot=False)


def _axes(painter: QPainter, lens: Lens, handle: Handle, x: float, y: float) -> None:
    depth = float(lens.camera.depth(np.array(handle.place)))
    length = 44.0 * depth / lens.camera.K[1, 1]
    for axis, colour in zip(np.eye(3), AXIS_COLOURS, strict=True):
        end = lens.to_widget(np.array(handle.place) + axis * length)
        if not np.isfinite(end).all():
            continue
        tip = QPointF(float(end[0]), float(end[1]))
        for pen in (QPen(marks.UNDERLAY, 4.0), QPen(QColor(colour), 2.0)):
            painter.setPen(pen)
            painter.drawLine(QPointF(x, y), tip)
        painter.setPen(QPen(marks.UNDERLAY, 1.2))
        painter.setBrush(QColor(colour))
        painter.drawEllipse(tip, 4.0, 4.0)
    _shape(painter, handle, x, y)
