"""The gizmo that moves, turns and scales a whole character, as values and a state machine without widgets.

Its shape has the same size on the screen at any distance. A press on one of its parts, or on the character itself,
begins a drag; what the drag means is a ``Placement`` about the gizmo's centre.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from app.window.viewport.drag import AXES, Mode, Place, place_under
from imitation.geometry import Camera

Array = NDArray[np.float64]
GizmoMode = Literal["move", "rotate", "scale"]
Part = Literal["x", "y", "z", "body"]
SIZE = 84.0
"""Pixels from the centre to the end of an axis or to a ring."""
REACH = 9.0
SNAP_ANGLE, SNAP_SCALE, SNAP_PART = math.radians(15.0), 0.05, 0.1
EDGE_ON = 0.2
"""Below this slope of the view to a ring's axis its plane is seen from the edge, and the turn follows its tangent."""


@dataclass(frozen=True)
class Placement:
    """A change of how something stands: scaled and turned about ``centre``, then shifted.

    shift : (3,) world. turn : (3,) axis times angle, radians, world. scale : factor.
    """

    centre: tuple[float, float, float]
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    scale: float = 1.0


@dataclass(frozen=True)
class GizmoMoving:
    """The character is being placed; nothing is decided yet."""

    change: Placement


@dataclass(frozen=True)
class GizmoMoved:
    """The drag has ended: one entry of the history."""

    change: Placement


@dataclass(frozen=True)
class GizmoReleased:
    """The drag was given up."""


@dataclass(frozen=True)
class Gizmo:
    """A gizmo that is shown: what it does, and its centre (3,) in the world."""

    mode: GizmoMode
    centre: tuple[float, float, float]

    def length(self, camera: Camera) -> float:
        """World length of ``SIZE`` pixels at the centre."""
        return SIZE * max(float(camera.depth(np.array(self.centre))), 1e-9) / float(camera.K[1, 1])

    def lines(self, camera: Camera) -> Mapping[Part, Array]:
        """Widget places (k, 2) of each part: an axis for moving and scaling, a ring for turning."""
        centre, length = np.array(self.centre), self.length(camera)
        if self.mode != "rotate":
            ends = {name: centre + length * np.eye(3)[axis] for name, axis in AXES.items()}
            return {name: camera.project(np.array([centre, end])) for name, end in ends.items()}  # type: ignore[misc]
        angles = np.linspace(0.0, 2 * math.pi, 73)
        found: dict[Part, Array] = {}
        for name, axis in AXES.items():
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            ring = centre + length * (np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v)
            found[name] = camera.project(ring)  # type: ignore[index]
        return found

    def part_at(self, camera: Camera, place: Place) -> Part | None:
        """The part under a widget place: the centre first, then the nearest line; None for none."""
        middle = camera.project(np.array(self.centre))
        if np.isfinite(middle).all() and math.dist(place, middle) <= 1.4 * REACH:
            return "body"
        away = {name: _away(place, line) for name, line in self.lines(camera).items()}
        nearest = min(away, key=lambda name: away[name])
        return nearest if away[nearest] <= REACH else None


def _away(place: Place, line: Array) -> float:
    """Pixels from a place to a line (k, 2)."""
    start, end = line[:-1], line[1:]
    along = end - start
    square = np.maximum((along**2).sum(1), 1e-12)
    share = np.clip(((np.asarray(place) - start) * along).sum(1) / square, 0.0, 1.0)
    gaps = np.linalg.norm(start + share[:, None] * along - place, axis=1)
    return float(np.nanmin(np.where(np.isfinite(gaps), gaps, np.inf)))


@dataclass
class GizmoDrag:
    """Press on a part of the gizmo, move, release."""

    camera: Camera
    gizmo: Gizmo
    part: Part
    slack: float = 3.0
    _grab: Place = (0.0, 0.0)
    _last: Place = (0.0, 0.0)
    _shift: bool = False
    _snap: bool = False
    _dragging: bool = False

    def press(self, place: Place) -> None:
        """Take hold of it."""
        self._grab = self._last = place

    @property
    def dragging(self) -> bool:
        """Whether the mouse went far enough to mean a drag."""
        return self._dragging

    def hold(self, *, shift: bool, control: bool) -> None:
        """Take the keys that are held: Shift moves the body along its ray, Ctrl goes in whole steps."""
        self._shift, self._snap = shift, control

    def move(self, place: Place) -> GizmoMoving | None:
        """Carry it along."""
        self._last = place
        if not self._dragging and math.dist(place, self._grab) < self.slack:
            return None
        self._dragging = True
        return GizmoMoving(self.change())

    def lock(self, axis: Mode) -> GizmoMoving | None:
        """Hold a drag to an axis, or let it go where it was held to that one."""
        self.part = "body" if self.part == axis else axis  # type: ignore[assignment]
        return GizmoMoving(self.change()) if self._dragging else None

    def release(self, place: Place) -> GizmoMoved | None:
        """Put it down; None where it was only clicked."""
        self._last = place
        return GizmoMoved(self.change()) if self._dragging else None

    def cancel(self) -> GizmoReleased | None:
        """Let it snap back."""
        return GizmoReleased() if self._dragging else None

    def change(self) -> Placement:
        """What the drag means by now."""
        centre = self.gizmo.centre
        if self.gizmo.mode == "move":
            return Placement(centre, shift=_triple(self._shifted()))
        if self.gizmo.mode == "rotate":
            axis, angle = self._turned()
            angle = round(angle / SNAP_ANGLE) * SNAP_ANGLE if self._snap else angle
            return Placement(centre, turn=_triple(axis * angle))
        return Placement(centre, scale=self._scaled())

    def _shifted(self) -> Array:
        start = np.array(self.gizmo.centre)
        mode: Mode = ("depth" if self._shift else "plane") if self.part == "body" else self.part
        step = place_under(self.camera, start, self._grab, self._last, mode) - start
        if self._snap and self.part != "body":
            unit = SNAP_PART * self.gizmo.length(self.camera)
            step = np.round(step / unit) * unit
        return np.asarray(step, np.float64)

    def _turned(self) -> tuple[Array, float]:
        """Axis (3,) and angle of a turn that follows the mouse."""
        middle = self.camera.project(np.array(self.gizmo.centre))
        if self.part == "body":
            before, after = (np.subtract(each, middle) for each in (self._grab, self._last))
            angle = math.atan2(*after[::-1]) - math.atan2(*before[::-1])
            return self.camera.R[2], (angle + math.pi) % (2 * math.pi) - math.pi
        axis = np.eye(3)[AXES[self.part]]
        sight = np.array(self.gizmo.centre) - self.camera.centre
        if abs(float(axis @ sight)) > EDGE_ON * float(np.linalg.norm(sight)):
            return axis, self._round(axis)
        along = np.cross(axis, -sight)
        tip = np.array(self.gizmo.centre) + along / np.linalg.norm(along) * self.gizmo.length(self.camera)
        tangent = self.camera.project(tip) - middle
        moved = np.subtract(self._last, self._grab)
        return axis, float(moved @ tangent) / float(tangent @ tangent)

    def _round(self, axis: Array) -> float:
        """The angle about an axis between the places where the plane of its ring was taken and is now."""
        centre = np.array(self.gizmo.centre)
        arms = []
        for place in (self._grab, self._last):
            ray = self.camera.rays(np.array(place))
            slope = float(axis @ ray)
            if abs(slope) < 1e-9:
                return 0.0
            meets = self.camera.centre + ray * float(axis @ (centre - self.camera.centre)) / slope
            arms.append(meets - centre)
        before, after = arms
        return math.atan2(float(axis @ np.cross(before, after)), float(before @ after))

    def _scaled(self) -> float:
        """How many times farther from the centre the mouse is than it was; on the body, e times for 200 pixels up."""
        middle = self.camera.project(np.array(self.gizmo.centre))
        first = math.dist(self._grab, middle)
        if self.part == "body" or first < 2 * REACH:
            factor = math.exp((self._grab[1] - self._last[1]) / 200.0)
        else:
            axis = np.subtract(self._grab, middle) / first
            factor = float(np.subtract(self._last, middle) @ axis) / first
        factor = min(max(factor, 0.02), 50.0)
        return max(round(factor / SNAP_SCALE), 1) * SNAP_SCALE if self._snap else factor


def _triple(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
