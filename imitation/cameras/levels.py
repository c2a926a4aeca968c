"""The ground of a place with several levels: a plane through all of them is none, for things are seen beneath it."""

from __future__ import annotations

import numpy as np

from imitation.cameras.ground import Ground, plane_ground
from imitation.cameras.path import CameraPath
from imitation.cameras.plane import Plane
from imitation.geometry.projection import Array

BENEATH = 0.15
"""What lies lower than this, of the camera's height, lies beneath a ground, and not in its unevenness."""
FEW = 0.1
"""Share of the points that may lie beneath a ground: ditches, and points that were recovered wrongly."""
LEAN = np.radians(3.0)
"""By which a plane may lean against what the cameras were kept level by, besides what those leave open."""
HELD = 0.5
"""A lower level is the ground if it holds so many of the points that the best one holds."""


def recovered_ground(path: CameraPath) -> Ground:
    """The plane through most recovered points; where things are seen beneath it, the lowest level with many points.

    A ground is opaque. A plane with a good part of the points beneath it that also leans against what a hand holding
    the camera keeps level was laid through a wall's top, the paving and the street at once. Up is then what the rows of
    all pictures are level to, and the ground the lowest height that about as many points share as any.

    Parameters
    ----------
    path : cameras with recovered points; up is roughly +Z.

    Raises
    ------
    NoSolution
        No plane through the points is anywhere near level.
    """
    ground = plane_ground(path.points, up=(0.0, 0.0, 1.0), selected=False)
    assert ground.plane is not None
    up, open_ = _held_level(path.R)
    lean = float(np.arccos(np.clip(ground.plane.normal @ up, -1.0, 1.0)))
    if lean <= LEAN + 3 * open_ or _beneath(ground.plane, path) <= FEW:
        return ground
    return _lowest_level(path, up)


def _held_level(R: Array) -> tuple[Array, float]:
    """The direction (3,) that all rows of the pictures are most level to, and the angle (radians) they leave open.

    Unlike `likely_up` it is not drawn to the pictures' own up, which leans with the pitch: a camera that hardly turns
    leaves a large angle open instead.
    """
    values, vectors = np.linalg.eigh(R[:, 0].T @ R[:, 0] / len(R))
    up: Array = vectors[:, 0]
    up = up if up @ -R[:, 1].mean(axis=0) >= 0 else -up
    return up, float(np.sqrt(max(values[0], 0.0) / max(values[1], 1e-12)))


def _beneath(plane: Plane, path: CameraPath) -> float:
    """Share of the points that lie beneath a plane."""
    height = float(np.median(plane.height(path.centres)))
    return float((plane.height(path.points) < -BENEATH * abs(height)).mean())


def _lowest_level(path: CameraPath, up: Array) -> Ground:
    heights = np.sort(path.points @ up)
    thin = 0.02 * float(np.median(np.abs(heights - np.median(path.centres @ up))))
    ends = np.searchsorted(heights, heights + 2 * thin, side="right")
    held = ends - np.arange(len(heights))
    # The lowest that holds many, and of what overlaps it the one that holds most.
    first = int(np.argmax(held >= HELD * held.max()))
    best = first + int(np.argmax(held[first : ends[first]]))
    offset = float(np.median(heights[best : ends[best]]))
    off = path.points @ up - offset
    used = np.abs(off) <= thin
    residual = float(np.sqrt(np.mean(off[used] ** 2)))
    name = f"level plane through {int(used.sum())} of {len(used)} recovered points, up as the camera was held"
    return Ground(name, plane=Plane(up, offset, residual, used), residual=residual)
