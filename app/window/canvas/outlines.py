"""Outlines of masks over the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from app.window import theme
from app.window.canvas import marks
from app.window.canvas.view import View

Kind = Literal["add", "subtract", "between", "before", "after"]
ONION = {"before": "#58C4DD", "after": "#FF9F68"}


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed line (n, 2) in picture pixels.

    kind : drawn to add, drawn to take away, carried to a frame between, or a neighbouring key mask.
    active : the corner that is selected or under the mouse, -1 for none. lit : the whole line is.
    """

    points: NDArray[np.float64]
    kind: Kind = "add"
    active: int = -1
    lit: bool = False


@dataclass(frozen=True, eq=False)
class OutlineLayer:
    """Outlines: what adds is white and solid with square corners, what takes away red and dashed with round ones.

    Outlines carried to frames between are dashed and without corners; neighbouring key masks are thin and coloured.
    """

    outlines: tuple[Outline, ...] = ()
    drawing: tuple[tuple[float, float], ...] = ()
    subtracting: bool = False

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the outlines and the one being drawn."""
        for outline in self.outlines:
            self._outline(painter, view, outline)
        if self.drawing:
            line = marks.polygon(view.to_widget(np.array(self.drawing)))
            colour = theme.DARK.colour("err" if self.subtracting else "accent")
            marks.stroke(painter, line, colour, 1.8, self.subtracting)

    def _outline(self, painter: QPainter, view: View, outline: Outline) -> None:
        placed = view.to_widget(outline.points)
        if not len(placed):
            return
        closed = QPolygonF(marks.polygon(placed))
        closed.append(closed.first())
        if outline.kind in ("before", "after"):
            painter.setBrush(Qt.BrushStyle.NoBrush)
            for colour, width in ((QColor(0, 0, 0, 120), 2.4), (theme.DARK.colour(ONION[outline.kind], 200), 1.2)):
                painter.setPen(QPen(colour, width))
                painter.drawPolyline(closed)
            return
        drawn = outline.kind != "between"
        colour = theme.DARK.colour("err") if outline.kind == "subtract" else QColor(255, 255, 255, 235)
        if drawn:
            fill = QPainterPath()
            fill.addPolygon(closed)
            tint = theme.DARK.colour("err", 46) if outline.kind == "subtract" else QColor(255, 255, 255, 22)
            painter.fillPath(fill, tint)
        marks.stroke(painter, closed, colour, 2.2 if outline.lit else 1.6, outline.kind != "add")
        if drawn and (len(placed) < 120 or outline.lit):
            self._corners(painter, placed, outline, colour)

    def _corners(self, painter: QPainter, placed: NDArray[np.float64], outline: Outline, colour: QColor) -> None:
        for number, (x, y) in enumerate(placed):
            active = number == outline.active
            half = 4.5 if active else 2.5
            painter.setPen(QPen(marks.UNDERLAY, 1.6 if active else 1))
            painter.setBrush(theme.DARK.colour("edit") if active else colour)
            box = QRectF(x - half, y - half, 2 * half, 2 * half)
            painter.drawEllipse(box) if outline.kind == "subtract" else painter.drawRect(box)
