"""A sensible world for cameras that know neither up nor metres, and the user's own: from a ground and a length."""

from __future__ import annotations

import numpy as np

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


def likely_world(R: Array, T: Array, points: Array) -> Similarity:
    """Similarity to a world with likely up +Z, the first camera over the origin, a typical depth.

    The first camera looks along +Y; the lower points lie about the height 0.
    """
    up = likely_up(R)
    level = rotation_to_z(up)
    forward = level @ R[0, 2]
    turn = np.pi / 2 - np.arctan2(forward[1], forward[0]) if np.hypot(*forward[:2]) > 1e-6 else 0.0
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]) @ level
    centre = -R[0].T @ T[0]
    depth = points @ R[0, 2] + T[0, 2] if len(points) else np.zeros(0)
    depth = depth[depth > 0]
    scale = TYPICAL_DEPTH / float(np.median(depth)) if len(depth) else 1.0
    moved = scale * (points - centre) @ rotation.T
    height = -float(np.percentile(moved[:, 2], 10)) if len(points) else 1.5
    translation = -scale * rotation @ centre + np.array([0, 0, height])
    return scale, rotation, translation
