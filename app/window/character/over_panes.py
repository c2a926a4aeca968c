"""Paints over the panes what the workspace knows: ghosts, trails of the points, the camera, legends."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainter

from app.actions.heat import Heat
from app.window.character.ghosts import paint_ghosts
from app.window.character.overlays import (
    Trail,
    paint_camera,
    paint_heat_legend,
    paint_legend,
    paint_points,
    paint_trails,
)
from app.window.character.panes import Pane
from app.window.viewport import Viewport
from app.window.viewport.lens import Lens

Array = NDArray[np.float64]


class OverPanes:
    """What lies over the panes that show the character itself.

    Attributes
    ----------
    ghosts : gives (distance in frames, pose) of neighbouring frames; ghosting : whether they are drawn.
    trails : gives the ways of the points, over the film (True) or in space. heat : what the colours stand for.
    """

    def __init__(self) -> None:
        self.ghosts: Callable[[], Sequence[tuple[int, Array]]] = tuple
        self.trails: Callable[[bool], Sequence[Trail]] = lambda film: ()
        self.ghosting = False
        self.heat: Heat | None = None

    def notes(self, pane: Pane) -> Sequence[Callable[[QPainter, Lens], None]]:
        """What paints over a pane, in this order."""
        return (
            lambda painter, lens: self._ghosts(painter, lens, pane.view),
            lambda painter, lens: self._trails(painter, lens, pane.view),
            lambda painter, lens: self._legends(painter, lens, pane),
        )

    def _ghosts(self, painter: QPainter, lens: Lens, view: Viewport) -> None:
        if self.ghosting:
            paint_ghosts(painter, lens, self.ghosts(), film=view.through_camera)

    def _trails(self, painter: QPainter, lens: Lens, view: Viewport) -> None:
        if view.carrying:
            return  # the hand's own vertex is what counts now, and every millisecond
        if view.shows("tracks"):
            if view.through_camera:
                paint_points(painter, self.trails(True), view.view.scale, view.view.x, view.view.y)
            else:
                paint_trails(painter, lens, self.trails(False))
        if view.shows("path") and not view.through_camera and view.camera is not None and view.picture is not None:
            reach = 0.25 * float(np.linalg.norm(view.scene.extent[1] - view.scene.extent[0]))
            paint_camera(painter, lens, view.camera, (view.picture.width(), view.picture.height()), reach)

    def _legends(self, painter: QPainter, lens: Lens, pane: Pane) -> None:
        if pane.view.gizmo is None and pane.kind == "main" and pane.view.handles and not pane.view.carrying:
            paint_legend(painter, lens, ghosts=self.ghosting)
        if self.heat is not None:
            paint_heat_legend(painter, lens, self.heat)
