"""An anchor on its way onto the measured surface: where it will lie, how far away that is, how sure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.window import theme
from app.window.canvas import marks
from app.window.canvas.overlays import path_through
from app.window.canvas.view import View


@dataclass(frozen=True, eq=False)
class SnapMark:
    """A preview of a snap.

    place : picture point. text : what is said of it. disc : (k, 2) round on the surface in picture pixels, None where
    there is no surface. before : where the anchor lies so far, None where it does not.
    """

    place: tuple[float, float]
    text: str
    disc: NDArray[np.float64] | None = None
    before: tuple[float, float] | None = None

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the round on the surface, the way from the old place, the anchor, and the words."""
        look = theme.DARK
        x, y = view.point(*self.place)
        token = "contact" if self.disc is not None else "err"
        colour = look.colour(token)
        if self.before is not None:
            old = view.point(*self.before)
            way = QPainterPath(QPointF(*old))
            way.lineTo(x, y)
            marks.stroke(painter, way, look.colour("contact", 190), 1.4, dash=True)
            marks.ring(painter, *old, look.colour("contact", 190), 4.0, dot=False)
        if self.disc is not None:
            round_ = path_through(view.to_widget(self.disc))
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("contact", 70))
            painter.drawPath(round_)
            marks.stroke(painter, round_, colour, 1.6)
            painter.setPen(QPen(QColor(255, 255, 255, 235), 1.6))
            for dx, dy in ((5, 0), (0, 5)):
                painter.drawLine(QPointF(x - dx, y - dy), QPointF(x + dx, y + dy))
        else:
            marks.cross(painter, x, y, colour)
        wide = marks.plate_size(self.text)[0]
        side = "right" if x + 18 + wide > size[0] else "left"
        marks.plate(painter, x - 18 if side == "right" else x + 18, y + 18, self.text, colour, align=side)
