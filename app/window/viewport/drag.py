"""Dragging a vertex with the mouse, as a state machine without widgets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from imitation.geometry import Camera

Place = tuple[float, float]
Mode = Literal["plane", "depth", "image", "x", "y", "z"]
AXES: dict[str, int] = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True)
class VertexMoving:
    """A vertex is being dragged to a world place; nothing is decided yet.

    on_ray : only the image point of the place counts, as the frame's own camera sees it.
    """

    vertex: int
    place: tuple[float, float, float]
    on_ray: bool = False


@dataclass(frozen=True)
class VertexMoved:
    """The drag has ended: one entry of the history."""

    vertex: int
    place: tuple[float, float, float]
    on_ray: bool = False


@dataclass(frozen=True)
class VertexChosen:
    """A vertex was clicked without being moved; -1 means nothing."""

    vertex: int


@dataclass(frozen=True)
class VertexReleased:
    """The drag was given up."""

    vertex: int


def place_under(
    camera: Camera, start: NDArray[np.float64], grab: Place, mouse: Place, mode: Mode
) -> NDArray[np.float64]:
    """Where a vertex that was at ``start`` goes when the mouse that took it at ``grab`` is at ``mouse``.

    plane, image : parallel to the picture, at the vertex's own depth.
    depth : along its own ray, nearer for a mouse that goes down, by a factor e for 200 pixels.
    x, y, z : along a world axis, to the place nearest to the mouse's ray.
    """
    depth = float(camera.depth(start))
    pixel = camera.project(start)
    if mode == "depth":
        return camera.lift(pixel, depth * math.exp((grab[1] - mouse[1]) / 200.0))
    aimed = pixel + np.subtract(mouse, grab)
    if mode in ("plane", "image"):
        return camera.lift(aimed, depth)
    axis = np.eye(3)[AXES[mode]]
    ray = camera.rays(aimed)
    ray = ray / np.linalg.norm(ray)
    slope = float(axis @ ray)
    if 1 - slope**2 < 1e-4:
        return start
    away = start - camera.centre
    moved: NDArray[np.float64] = start + axis * (slope * float(ray @ away) - float(axis @ away)) / (1 - slope**2)
    return moved


def held_mode(locked: Mode, *, shift: bool, control: bool) -> Mode:
    """How a drag goes on under the keys held: Shift along the ray, Ctrl by the image point, else as it is locked."""
    return "depth" if shift else "image" if control else locked


@dataclass
class VertexDrag:
    """Press on a vertex, move it, release: the vertex keeps its distance to the mouse."""

    camera: Camera
    vertex: int
    start: NDArray[np.float64]
    mode: Mode = "plane"
    slack: float = 3.0
    locked: Mode = "plane"
    _grab: Place = (0.0, 0.0)
    _last: Place = (0.0, 0.0)
    _dragging: bool = False

    def press(self, place: Place) -> None:
        """Take hold of it."""
        self._grab = self._last = place

    def _target(self) -> tuple[float, float, float]:
        x, y, z = place_under(self.camera, self.start, self._grab, self._last, self.mode)
        return float(x), float(y), float(z)

    def _moving(self) -> VertexMoving:
        return VertexMoving(self.vertex, self._target(), self.mode == "image")

    @property
    def place(self) -> tuple[float, float, float]:
        """Where the vertex is held now."""
        return self._target()

    @property
    def dragging(self) -> bool:
        """Whether the mouse went far enough to mean a drag."""
        return self._dragging

    def move(self, place: Place) -> VertexMoving | None:
        """Carry it along."""
        self._last = place
        if not self._dragging and math.dist(place, self._grab) < self.slack:
            return None
        self._dragging = True
        return self._moving()

    def hold(self, *, shift: bool, control: bool) -> None:
        """Take the keys that are held while it moves."""
        self.mode = held_mode(self.locked, shift=shift, control=control)

    def lock(self, axis: Mode) -> VertexMoving | None:
        """Hold it to an axis, or let it go where it was held to that one."""
        return self.switch("plane" if self.locked == axis else axis)

    def switch(self, mode: Mode) -> VertexMoving | None:
        """Go on in another plane or along an axis, from where the vertex was at the press."""
        self.mode = self.locked = mode
        return self._moving() if self._dragging else None

    def release(self, place: Place) -> VertexMoved | VertexChosen:
        """Put it down."""
        self._last = place
        if self._dragging:
            return VertexMoved(self.vertex, self._target(), self.mode == "image")
        return VertexChosen(self.vertex)

    def cancel(self) -> VertexReleased | None:
        """Let it snap back."""
        return VertexReleased(self.vertex) if self._dragging else None
