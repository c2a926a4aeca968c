"""Layers that show the recovered scene: background points with their errors, and the grid on the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.window import fonts, theme
from app.window.canvas import marks
from app.window.canvas.overlays import path_through
from app.window.canvas.view import View

FAIR, FAR_OFF = 0.5, 1.0
"""Pixels of error up to which a point is good, and above which it is bad."""
GRADES = (("ok", 2.6), ("warn", 3.8), ("err", 5.2))


def grade(residuals: NDArray[np.float64]) -> NDArray[np.int64]:
    """0 good, 1 fair, 2 far off, for residuals (k,) in pixels; what is not known counts as good."""
    known = np.nan_to_num(residuals, nan=0.0)
    found: NDArray[np.int64] = (known > FAIR).astype(np.int64) + (known > FAR_OFF)
    return found


@dataclass(frozen=True, eq=False)
class ScenePoints:
    """Recovered points: the worse, the larger and the redder. Chosen ones have a ring.

    places : (k, 2) picture pixels. residuals : (k,) pixels, NaN where unknown. chosen : (k,) of bool.
    """

    places: NDArray[np.float64]
    residuals: NDArray[np.float64]
    chosen: NDArray[np.bool_]

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw good points first, so that bad ones lie on top."""
        placed = view.to_widget(self.places)
        seen = (placed >= 0).all(1) & (placed[:, 0] < size[0]) & (placed[:, 1] < size[1])
        grades = grade(self.residuals)
        for number, (token, width) in enumerate(GRADES):
            dots = marks.polygon(placed[seen & (grades == number)])
            for colour, wide in ((marks.UNDERLAY, width + 2.2), (theme.DARK.colour(token), width)):
                pen = QPen(colour, wide)
                pen.setCapStyle(Qt.PenCapStyle.RoundCap)
                painter.setPen(pen)
                painter.drawPoints(dots)
        for x, y in placed[seen & self.chosen]:
            marks.ring(painter, float(x), float(y), theme.DARK.colour("edit"), 6.0, dot=False)


@dataclass(frozen=True, eq=False)
class GroundGrid:
    """The ground as lines (k, 2) in picture pixels, NaN where they break, the horizon (2, 2), and what a cell is.

    picture : width and height of the picture, which the grid does not leave.
    """

    lines: tuple[NDArray[np.float64], ...]
    picture: tuple[int, int]
    horizon: NDArray[np.float64] | None = None
    cell: str = ""

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the grid thin inside the picture, the horizon dashed with its name."""
        painter.save()
        width, height = self.picture
        painter.setClipRect(QRectF(view.x, view.y, width * view.scale, height * view.scale))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        paths = [path_through(view.to_widget(line)) for line in self.lines]
        for colour, wide in ((QColor(0, 0, 0, 90), 2.2), (QColor(255, 255, 255, 120), 0.9)):
            painter.setPen(QPen(colour, wide))
            for path in paths:
                painter.drawPath(path)
        painter.restore()
        if self.horizon is None:
            return
        left, right = view.to_widget(self.horizon)
        line = marks.polygon([left, right])
        marks.stroke(painter, line, theme.DARK.colour("accent"), 1.4, dash=True)
        y = min(max(float(left[1]), 34.0), size[1] - 34.0)
        place = QPointF(max(12.0, float(left[0]) + 8), y - 14)
        text = "horizon" if 0 < left[1] < size[1] else "horizon above" if left[1] <= 0 else "horizon below"
        words = f"{text}  ·  {self.cell}" if self.cell else text
        marks.plate(painter, place.x(), place.y(), words, theme.DARK.colour("accent"), size=fonts.CAPTION)
