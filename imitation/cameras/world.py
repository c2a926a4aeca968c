"""A sensible world for cameras that know neither up nor metres, and the user's own: from a ground and a length."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from imitation.cameras.path import CameraPath
from imitation.cameras.plane import Plane
from imitation.errors import InputError
from imitation.geometry.projection import Array

TYPICAL_DEPTH = 5.0  # units; so that figures look like metres until a known length makes them so

Similarity = tuple[float, Array, Array]


def rotation_to_z(up: Array) -> Array:
    """The smallest rotation (3, 3) that takes the direction ``up`` (3,) to +Z."""
    up = up / np.linalg.norm(up)
    z = np.array([0.0, 0.0, 1.0])
    v, c = np.cross(up, z), float(up @ z)
    if c < -1 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    rotation: Array = np.eye(3) + skew + skew @ skew / (1 + c)
    return rotation


def likely_up(R: Array) -> Array:
    """The direction (3,) that hands holding a camera keep level: across all image rows, against gravity."""
    across, up = R[:, 0], -R[:, 1].mean(0)
    up /= np.linalg.norm(up) + 1e-12
    # A camera that never turns leaves the tilt open; then the picture's own up decides.
    spread = across.T @ across / len(R) + 0.03 * (np.eye(3) - np.outer(up, up))
    vector: Array = np.linalg.eigh(spread)[1][:, 0]
    return vector if vector @ up >= 0 else -vector


def heading(forward: Array) -> Array:
    """The turn (3, 3) about Z that takes a direction (3,) to +Y, as far as it is level."""
    turn = np.pi / 2 - np.arctan2(forward[1], forward[0]) if np.hypot(*forward[:2]) > 1e-6 else 0.0
    c, s = np.cos(turn), np.sin(turn)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def likely_world(R: Array, T: Array, points: Array) -> Similarity:
    """Similarity to a world with likely up +Z, the first camera over (or, without points, at) the origin.

    The first camera looks along +Y; the lower points lie about the height 0, the median depth is typical.
    """
    up = likely_up(R)
    level = rotation_to_z(up)
    rotation = heading(level @ R[0, 2]) @ level
    centre = -R[0].T @ T[0]
    depth = points @ R[0, 2] + T[0, 2] if len(points) else np.zeros(0)
    depth = depth[depth > 0]
    scale = TYPICAL_DEPTH / float(np.median(depth)) if len(depth) else 1.0
    moved = scale * (points - centre) @ rotation.T
    height = -float(np.percentile(moved[:, 2], 10)) if len(points) else 0.0
    translation = -scale * rotation @ centre + np.array([0, 0, height])
    return scale, rotation, translation


def world_from_ground(
    plane: Plane,
    cameras: CameraPath,
    *,
    length: tuple[ArrayLike, ArrayLike, float] | None = None,
    camera_height: float | None = None,
    origin: ArrayLike | None = None,
) -> Similarity:
    """Similarity to a world with the ground at height 0, Z up, metres where a length is known.

    Parameters
    ----------
    plane : the ground, in the cameras' world; up is the side on which the cameras are.
    length : two points (3,) of that world and their distance in metres.
    camera_height : or the height of the first camera above the ground, metres.
    origin : the point (3,) under which the new origin lies, such as the subject; by default the middle of the points.

    Returns
    -------
    (scale, rotation (3, 3), translation (3,)) : ``X' = scale * rotation @ X + translation``; +Y is the first camera's
        direction on the ground. Without a length the scale is 1.
    """
    if length is not None and camera_height is not None:
        raise InputError("Give one known length: two points and their distance, or the camera's height.")
    centres = cameras.centres
    plane = plane.towards(centres.mean(0))
    scale = 1.0
    if length is not None:
        first, second, metres = np.asarray(length[0], np.float64), np.asarray(length[1], np.float64), float(length[2])
        between = float(np.linalg.norm(second - first))
        if not (np.isfinite(metres) and metres > 0 and np.isfinite(between) and between > 0):
            raise InputError("A known length needs two different points and a positive distance in metres.")
        scale = metres / between
    if camera_height is not None:
        above = float(plane.height(centres[0]))
        if not (np.isfinite(camera_height) and camera_height > 0 and above > 0):
            raise InputError("The camera's height must be positive, and the first camera must be above the ground.")
        scale = camera_height / above
    level = rotation_to_z(plane.normal)
    rotation = heading(level @ cameras.R[0, 2]) @ level
    if origin is None:
        origin = np.median(cameras.points, axis=0) if len(cameras.points) else centres[0]
    middle = np.asarray(origin, np.float64)
    foot = middle - plane.height(middle) * plane.normal
    return scale, rotation, -scale * rotation @ foot
