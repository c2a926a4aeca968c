"""A camera that turns round a target, as a value. World: Z up."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from imitation.geometry import Camera

STEEPEST = math.radians(89.0)


@dataclass(frozen=True)
class Orbit:
    """Where it looks at, from how far, from which side (radians), with which field of view (radians, vertical)."""

    target: tuple[float, float, float] = (0.0, 0.0, 0.5)
    distance: float = 4.0
    azimuth: float = math.radians(-60.0)
    elevation: float = math.radians(18.0)
    field: float = math.radians(32.0)

    def turned(self, dx: float, dy: float) -> Orbit:
        """Turn by mouse pixels."""
        elevation = min(max(self.elevation + dy * 0.008, -STEEPEST), STEEPEST)
        return replace(self, azimuth=self.azimuth - dx * 0.008, elevation=elevation)

    def closer(self, factor: float) -> Orbit:
        """Go nearer to the target by a factor."""
        return replace(self, distance=min(max(self.distance / factor, 1e-3), 1e5))

    def shifted(self, dx: float, dy: float, height: int) -> Orbit:
        """Move the target by mouse pixels, so that it follows the mouse."""
        camera = self.camera((height, height))
        step = self.distance * 2 * math.tan(self.field / 2) / max(height, 1)
        target = np.array(self.target) - camera.R[0] * dx * step - camera.R[1] * dy * step
        return replace(self, target=(float(target[0]), float(target[1]), float(target[2])))

    def camera(self, size: tuple[int, int]) -> Camera:
        """The camera for a widget of a size (w, h)."""
        width, height = size
        focal = height / (2 * math.tan(self.field / 2))
        flat, rise = math.cos(self.elevation), math.sin(self.elevation)
        cosine, sine = math.cos(self.azimuth), math.sin(self.azimuth)
        back = np.array([flat * cosine, flat * sine, rise])
        # Right, down and forward; down is the cross product of the two others.
        R = np.array([[-sine, cosine, 0.0], [rise * cosine, rise * sine, -flat], -back])
        centre = np.array(self.target) + self.distance * back
        return Camera([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]], R, -R @ centre)


def around(points: ArrayLike, orbit: Orbit | None = None, *, aspect: float = 1.4) -> Orbit:
    """An orbit that shows all points (n, 3), from the same side as before."""
    places = np.asarray(points, np.float64).reshape(-1, 3)
    before = orbit or Orbit()
    if not len(places):
        return before
    low, high = places.min(0), places.max(0)
    radius = max(float(np.linalg.norm(high - low)) / 2, 1e-3)
    spread = math.sin(math.atan(math.tan(before.field / 2) * min(1.0, aspect)))
    middle = (low + high) / 2
    target = (float(middle[0]), float(middle[1]), float(middle[2]))
    return replace(before, target=target, distance=1.02 * radius / spread)


def facing(camera: Camera, target: ArrayLike, orbit: Orbit) -> Orbit:
    """The orbit that looks at the target from near a solved camera, a little from the side and from above."""
    offset = camera.centre - np.asarray(target, np.float64)
    azimuth = math.atan2(float(offset[1]), float(offset[0])) + math.radians(24.0)
    return replace(orbit, azimuth=azimuth, elevation=math.radians(16.0))


def beside(camera: Camera, target: ArrayLike, orbit: Orbit) -> Orbit:
    """The orbit that looks at the target from the side of a solved camera: errors in depth can be seen there."""
    middle = np.asarray(target, np.float64)
    offset = camera.centre - middle
    azimuth = math.atan2(float(offset[1]), float(offset[0])) + math.pi / 2
    place = (float(middle[0]), float(middle[1]), float(middle[2]))
    return replace(orbit, target=place, azimuth=azimuth, elevation=math.radians(6.0))
