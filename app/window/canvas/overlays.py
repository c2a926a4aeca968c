"""Layers drawn over the picture; each is a small value that paints itself, made anew when what it shows changes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.window import theme
from app.window.canvas import marks
from app.window.canvas.view import View

PAST, FUTURE = 14, 10


class Overlay(Protocol):
    """A layer: it paints itself for a view, and knows nothing of who shows it."""

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the layer."""


@dataclass(frozen=True)
class TrackMark:
    """One track as the canvas needs it.

    positions : (n, 2) picture pixels, NaN where there is none.
    state : seen, hidden, outside or missing, in the frame shown.
    """

    name: str
    title: str
    colour: str
    positions: NDArray[np.float64]
    state: str = "seen"
    clicked: bool = False
    selected: bool = False
    contact: bool = False
    place: tuple[float, float] | None = None

    def at(self, frame: int) -> tuple[float, float] | None:
        """Where the track is in a frame: where it is being dragged, else its own position."""
        if self.place is not None:
            return self.place
        if not 0 <= frame < len(self.positions):
            return None
        x, y = self.positions[frame]
        return (float(x), float(y)) if np.isfinite(x) and np.isfinite(y) else None


@dataclass(frozen=True)
class TrackLayer:
    """Tracks in one frame: the way behind solid, the way ahead dashed, the point, its name where wanted."""

    tracks: tuple[TrackMark, ...]
    frame: int
    paths: bool = True
    names: bool = True
    hovered: str = ""

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw paths first, then points, then names where there is room, those of the selected track first."""
        order = sorted(self.tracks, key=lambda track: track.selected)
        if self.paths:
            for track in order:
                self._path(painter, view, track)
        taken: list[QRectF] = []
        for track in order:
            self._point(painter, view, track)
        for track in reversed(order):
            if self.names or track.selected or track.name == self.hovered:
                self._name(painter, view, track, size, taken)

    def _path(self, painter: QPainter, view: View, track: TrackMark) -> None:
        colour = theme.DARK.colour(track.colour)
        reach = 2 if track.selected else 1
        first, last = max(self.frame - PAST * reach, 0), min(self.frame + FUTURE * reach, len(track.positions) - 1)
        placed, now = view.to_widget(track.positions[first : last + 1]), self.frame - first
        for part, dash in ((placed[: now + 1], False), (placed[now:], True)):
            marks.stroke(painter, path_through(part), colour, 2.2 if track.selected else 1.6, dash)

    def _point(self, painter: QPainter, view: View, track: TrackMark) -> None:
        place = track.at(self.frame)
        if place is None:
            return
        look = theme.DARK
        x, y = view.point(*place)
        colour = look.colour("edit" if track.clicked and track.selected else track.colour)
        if track.state == "hidden":
            marks.cross(painter, x, y, colour)
            return
        if track.selected:
            painter.setPen(QPen(QColor(255, 255, 255, 220), 1.4))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(QRectF(x - 10, y - 10, 20, 20))
        marks.ring(painter, x, y, colour, 6.0 if track.selected else 5.0, filled=track.clicked or track.contact)

    def _name(
        self, painter: QPainter, view: View, track: TrackMark, size: tuple[int, int], taken: list[QRectF]
    ) -> None:
        place = track.at(self.frame)
        if place is None:
            return
        x, y = view.point(*place)
        if not (0 <= x <= size[0] and 0 <= y <= size[1]):
            return
        side = "right" if x > size[0] - 90 else "left"
        shift = -14 if side == "right" else 14
        colour = theme.DARK.colour(track.colour)
        width, height = marks.plate_size(track.title)
        wanted = track.selected or track.name == self.hovered
        for rise in (-14.0, 14.0, -34.0, 34.0):
            box = QRectF(x + shift - (width if side == "right" else 0), y + rise - height / 2, width, height)
            if wanted or not any(box.intersects(other) for other in taken):
                taken.append(marks.plate(painter, x + shift, y + rise, track.title, colour, align=side))
                return


def path_through(points: NDArray[np.float64]) -> QPainterPath:
    """A path through points (n, 2); a NaN row breaks it."""
    path, down = QPainterPath(), False
    for x, y in points.tolist():
        if x != x or y != y:
            down = False
        elif down:
            path.lineTo(x, y)
        else:
            path.moveTo(x, y)
            down = True
    return path


@dataclass(frozen=True)
class GhostPath:
    """The path a track had before a correction, thin and dashed, while the new one is being solved."""

    positions: NDArray[np.float64]
    colour: str

    def paint(self, painter: QPainter, view: View, size: tuple[int, int]) -> None:
        """Draw the old path."""
        colour = theme.DARK.colour(self.colour, 150)
        marks.stroke(painter, path_through(view.to_widget(self.positions)), colour, 1.2, dash=True)
