"""How the gizmo looks: arrows, rings or cubes in the colours of the axes, with a dark underlay."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.window import theme
from app.window.canvas import marks
from app.window.viewport.gizmo import SIZE, Gizmo, Part
from app.window.viewport.handles import AXIS_COLOURS
from app.window.viewport.lens import Lens

COLOURS: dict[Part, str] = dict(zip(("x", "y", "z"), AXIS_COLOURS, strict=True))  # type: ignore[arg-type]


def paint_gizmo(painter: QPainter, lens: Lens, gizmo: Gizmo, hovered: Part | None = None) -> None:
    """Draw the gizmo, the part under the mouse or in the hand brighter."""
    camera = lens.camera
    middle = camera.project(np.array(gizmo.centre))
    if not np.isfinite(middle).all():
        return
    for part, line in gizmo.lines(camera).items():
        if np.isfinite(line).all():
            colour = QColor("#FFFFFF") if part == hovered else QColor(COLOURS[part])
            marks.stroke(painter, marks.polygon(line.tolist()), colour, 3.0 if part == hovered else 2.2)
            if gizmo.mode != "rotate":
                _tip(painter, gizmo, line[1], part.upper(), colour)
    accent = theme.DARK.colour("text") if hovered == "body" else theme.DARK.colour("edit")
    centre = QPointF(float(middle[0]), float(middle[1]))
    if gizmo.mode == "rotate":
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(255, 255, 255, 70), 1.2, Qt.PenStyle.DashLine))
        painter.drawEllipse(centre, SIZE * 1.12, SIZE * 1.12)
    marks.ring(painter, centre.x(), centre.y(), accent, 7.0, filled=True)


def _tip(painter: QPainter, gizmo: Gizmo, place: np.ndarray, name: str, colour: QColor) -> None:
    x, y = float(place[0]), float(place[1])
    painter.setPen(QPen(marks.UNDERLAY, 1.6))
    painter.setBrush(colour)
    if gizmo.mode == "scale":
        painter.drawRect(QRectF(x - 5.5, y - 5.5, 11, 11))
    else:
        painter.drawEllipse(QPointF(x, y), 6.5, 6.5)
    painter.setPen(QColor(0, 0, 0, 220))
    face = painter.font()
    face.setPixelSize(9)
    face.setBold(True)
    painter.setFont(face)
    painter.drawText(QRectF(x - 7, y - 7, 14, 14), Qt.AlignmentFlag.AlignCenter, name)
