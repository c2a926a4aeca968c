"""Ghosts of neighbouring frames: the vertices as fine dots, before in one colour, after in another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from PySide6.QtGui import QPainter, QPen, QPolygonF

from app.window import theme
from app.window.viewport.lens import Lens

STEPS = (-8, -4, 4, 8)
MOST = 1200


def paint_ghosts(
    painter: QPainter, lens: Lens, poses: Sequence[tuple[int, NDArray[np.float64]]], *, film: bool = False
) -> None:
    """Draw poses (distance in frames, vertices), over a film or in space; the farther, the fainter."""
    look = theme.DARK if film else theme.active()
    for step, vertices in poses:
        thin = vertices[:: max(len(vertices) // MOST, 1)]
        places = lens.to_widget(thin)
        places = places[np.isfinite(places).all(1)]
        colour = look.colour("contact" if step < 0 else "ok", 150 - 8 * abs(step))
        painter.setPen(QPen(colour, 1.6))
        painter.drawPoints(QPolygonF([QPointF(x, y) for x, y in places.tolist()]))
