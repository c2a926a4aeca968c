"""What stands on the stage of the preview: the performer, the ghosts beside it, the ground that goes along."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from app.window.viewport import Viewport
from app.window.viewport.orbit import Orbit, around

if TYPE_CHECKING:
    from app.actions.performing_playback import ShownFrame

GHOSTS = 2
GHOSTLY = 0.28
SMOOTH = 0.3
"""Seconds over which the view follows the performer."""
RISE = 0.08
"""Shares of the performer's height that the ground lies lower before the grid moves with it."""


class StageView:
    """Shows frames in a viewport. Nothing is computed of a mesh but where its box is."""

    def __init__(self, viewport: Viewport) -> None:
        from app.window.viewport.streamed import StreamedMesh, StreamedShadow

        self.viewport = viewport
        self._mesh = StreamedMesh(viewport.scene, "performer")
        self._shadow = StreamedShadow(viewport.scene, "performer shadow")
        self._ghosts = [StreamedMesh(viewport.scene, f"ghost {k}", opacity=GHOSTLY) for k in range(GHOSTS)]
        self.follow = True
        self.begin()

    def begin(self) -> None:
        """Another source: the view is placed anew with the first frame."""
        self._centre: NDArray[np.float64] | None = None
        self._ground, self._grid = math.inf, np.full(4, np.inf)
        self._placed = False

    def clear(self) -> None:
        """Show nothing."""
        for each in (self._mesh, self._shadow, *self._ghosts):
            each.hide()
        self.viewport.redraw()

    def show(self, frame: ShownFrame, ghosts: Sequence[ShownFrame] = (), *, elapsed: float, moving: bool) -> None:
        """Show a frame; ``elapsed`` seconds after the one before, infinite where it does not follow it.

        While it is moving the shadow is left out, which costs as much as the mesh.
        """
        self._mesh.show(frame, quick=moving)
        for place, ghost in enumerate(self._ghosts):
            if place < len(ghosts):
                ghost.show(ghosts[place])
            else:
                ghost.hide()
        boxes = [frame, *ghosts]
        low, high = np.min([each.low for each in boxes], axis=0), np.max([each.high for each in boxes], axis=0)
        self._stand(frame)
        if moving:
            self._shadow.hide()
        else:
            self._shadow.show(frame, self._ground + 0.001 * float(np.ptp([frame.low[2], frame.high[2]])))
        self.viewport.scene.extent = np.array([low, high])
        self._go_along(frame, elapsed)
        self.viewport.redraw()

    def fit(self) -> None:
        """Look at the whole performer."""
        self.viewport.fit()
        self._widen()

    def face(self, azimuth: float) -> None:
        """Look from a side, radians from +x."""
        self.viewport.orbit = replace(self.viewport.orbit, azimuth=azimuth)
        self.viewport.redraw()

    def _widen(self) -> None:
        """Leave room round the performer: it moves."""
        self.viewport.orbit = replace(self.viewport.orbit, distance=1.15 * self.viewport.orbit.distance)

    def _stand(self, frame: ShownFrame) -> None:
        """Keep the grid under the performer: at the lowest point seen, round where it is."""
        height = float(frame.high[2] - frame.low[2])
        if self._ground == math.inf or frame.low[2] < self._ground - RISE * height:
            self._ground = float(frame.low[2])
        self._ground = min(self._ground, float(frame.low[2]))
        middle = 0.5 * (frame.low + frame.high)
        radius = 2.5 * float(np.linalg.norm(frame.high - frame.low))
        moved = float(np.linalg.norm(middle[:2] - self._grid[:2])) if np.isfinite(self._grid).all() else math.inf
        grown = not 0.5 < radius / self._grid[2] < 2.0
        if moved > 0.25 * radius or grown or abs(self._ground - self._grid[3]) > 0.02 * height:
            self._grid = np.array([middle[0], middle[1], radius, self._ground])
            self.viewport.scene.set_ground(middle[:2], radius, self._ground)

    def _go_along(self, frame: ShownFrame, elapsed: float) -> None:
        centre = 0.5 * (frame.low + frame.high)
        viewport = self.viewport
        if not self._placed:
            self._placed = True
            self._centre = centre
            aspect = viewport.width() / max(viewport.height(), 1)
            viewport.orbit = around([frame.low, frame.high], viewport.orbit, aspect=aspect)
            self._widen()
            return
        before = self._centre
        assert before is not None
        share = 1.0 - math.exp(-elapsed / SMOOTH) if math.isfinite(elapsed) else 1.0
        self._centre = before + share * (centre - before)
        if self.follow:
            viewport.orbit = _shifted(viewport.orbit, self._centre - before)


def _shifted(orbit: Orbit, by: NDArray[np.float64]) -> Orbit:
    """The orbit moved over the ground; how high it looks stays."""
    x, y, z = orbit.target
    return replace(orbit, target=(x + float(by[0]), y + float(by[1]), z))
