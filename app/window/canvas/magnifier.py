"""A loupe that follows the mouse: the picture six times as large, with a cross-hair."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen

from app.window import fonts, theme
from app.window.canvas import marks

RADIUS, FACTOR = 62.0, 6.0


def paint(
    painter: QPainter, picture: QImage, place: tuple[float, float], mouse: QPointF, size: tuple[int, int]
) -> None:
    """Draw the loupe for a picture point, beside the mouse and inside a widget of a size."""
    gap = RADIUS + 28
    x = mouse.x() + gap if mouse.x() + gap + RADIUS < size[0] else mouse.x() - gap
    y = mouse.y() - gap if mouse.y() - gap - RADIUS > 0 else mouse.y() + gap
    centre = QPointF(x, y)
    half = RADIUS / FACTOR
    circle = QPainterPath()
    circle.addEllipse(centre, RADIUS, RADIUS)
    painter.save()
    painter.setClipPath(circle)
    painter.fillPath(circle, QColor(0, 0, 0))
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
    source = QRectF(place[0] + 0.5 - half, place[1] + 0.5 - half, 2 * half, 2 * half)
    painter.drawImage(QRectF(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS), picture, source)
    for colour, width in ((marks.UNDERLAY, 3.0), (QColor(255, 255, 255, 230), 1.0)):
        painter.setPen(QPen(colour, width))
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            painter.drawLine(QPointF(x + 5 * dx, y + 5 * dy), QPointF(x + 22 * dx, y + 22 * dy))
    painter.restore()
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(marks.UNDERLAY, 4))
    painter.drawEllipse(centre, RADIUS, RADIUS)
    painter.setPen(QPen(theme.DARK.colour("edit"), 2))
    painter.drawEllipse(centre, RADIUS, RADIUS)
    marks.plate(painter, x, y + RADIUS - 14, "6×", QColor(255, 255, 255), size=fonts.LANE, align="centre")
