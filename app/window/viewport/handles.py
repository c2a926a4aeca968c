"""Marks over the 3D picture: handles of vertices by shape and colour, the axes of the selected one, links to before."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from app.window import theme
from app.window.canvas import marks
from app.window.viewport.lens import Lens

AXIS_COLOURS = ("#FF7A7A", "#4CC38A", "#5AA9FF")
ARM = 44.0
"""Pixels from a selected handle to the ends of its axes."""
LEGEND = (("edited", "edited here"), ("anchor", "3D anchor"), ("ray", "2D constraint"))


@dataclass(frozen=True)
class Handle:
    """A vertex with a meaning.

    vertex, title : which, and its name. place : world. before : where it was before it was moved, world.
    kind : "ray" held by its image point, "anchor" held in 3D, "edited" moved in this frame, "edited ray" moved there by
        its image point, "plain" a control vertex that was moved in another frame, or only chosen.
    colour : a token of the dark look, or a literal that is light: each mark has a dark ground, whatever the look.
    warning : it is farther from its point than the limit.
    """

    vertex: int
    title: str
    place: tuple[float, float, float]
    kind: str = "plain"
    colour: str = "accent"
    selected: bool = False
    warning: bool = False
    before: tuple[float, float, float] | None = None


def paint_handles(
    painter: QPainter, lens: Lens, handles: Sequence[Handle], pointed: Sequence[int] = (), *, taken: int = 0
) -> None:
    """Draw the handles, the selected one last with its axes and its name; those pointed at are named and lit.

    No name is written into the pixels at the right that are ``taken`` by something else.
    """
    if not handles:
        return
    order = sorted(handles, key=lambda each: (each.selected, each.kind.startswith("edited")))
    places = lens.to_widget(np.array([handle.place for handle in order])).tolist()
    for handle, (x, y) in zip(order, places, strict=True):
        if not math.isfinite(x + y):
            continue
        _link(painter, lens, handle, x, y)
        if handle.vertex in pointed:
            painter.setBrush(QColor(255, 255, 255, 60))
            for pen in (QPen(marks.UNDERLAY, 3.4), QPen(QColor(255, 255, 255, 200), 1.6)):
                painter.setPen(pen)
                painter.drawEllipse(QPointF(x, y), 13.0, 13.0)
                painter.setBrush(Qt.BrushStyle.NoBrush)
        paint_shape(painter, handle, x, y)
        if handle.selected:
            _axes(painter, lens, handle, x, y)
        if handle.selected or handle.vertex in pointed:
            fits = x + 14 + marks.plate_size(handle.title)[0] < lens.size[0] - taken
            look, side = theme.DARK.colour(_colour(handle)), "left" if fits else "right"
            marks.plate(painter, x + 14 if fits else x - 14, y - 20, handle.title, look, align=side)


def _colour(handle: Handle) -> str:
    return {"edited": "edit", "edited ray": "edit", "anchor": "contact"}.get(handle.kind, handle.colour)


def paint_shape(painter: QPainter, handle: Handle, x: float, y: float) -> None:
    """Draw what a handle is: filled for 3D, a ring for an image point, large where it was moved in this frame."""
    colour = theme.DARK.colour(_colour(handle))
    radius = 7.5 if handle.kind.startswith("edited") else 5.5
    marks.ring(painter, x, y, colour, radius, filled=handle.kind in ("edited", "anchor"))
    if handle.warning:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.DARK.colour("err"), 2.0))
        painter.drawEllipse(QPointF(x, y), radius + 4.0, radius + 4.0)


def _link(painter: QPainter, lens: Lens, handle: Handle, x: float, y: float) -> None:
    if handle.before is None:
        return
    start = lens.to_widget(np.array(handle.before))
    if np.isfinite(start).all() and np.hypot(start[0] - x, start[1] - y) > 4:
        way = QPolygonF([QPointF(float(start[0]), float(start[1])), QPointF(x, y)])
        marks.stroke(painter, way, QColor(255, 255, 255, 200), 1.4, dash=True)
        marks.ring(painter, float(start[0]), float(start[1]), QColor(255, 255, 255, 150), 4.5, dot=False)


def axis_tips(lens: Lens, handle: Handle) -> dict[str, tuple[float, float]]:
    """Widget places of the ends of a selected handle's axes, by name; those behind the camera are left out."""
    length = ARM * float(lens.camera.depth(np.array(handle.place))) / lens.camera.K[1, 1]
    ends = lens.to_widget(np.array(handle.place) + length * np.eye(3))
    found = zip("xyz", ends.tolist(), strict=True)
    return {name: (x, y) for name, (x, y) in found if np.isfinite(x + y)}


def _axes(painter: QPainter, lens: Lens, handle: Handle, x: float, y: float) -> None:
    colours = dict(zip("xyz", AXIS_COLOURS, strict=True))
    for name, place in axis_tips(lens, handle).items():
        tip, colour = QPointF(*place), QColor(colours[name])
        for pen in (QPen(marks.UNDERLAY, 4.0), QPen(colour, 2.0)):
            painter.setPen(pen)
            painter.drawLine(QPointF(x, y), tip)
        painter.setPen(QPen(marks.UNDERLAY, 1.2))
        painter.setBrush(colour)
        painter.drawEllipse(tip, 4.0, 4.0)
    paint_shape(painter, handle, x, y)
