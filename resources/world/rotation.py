"""Rotations over all frames at once."""

from __future__ import annotations

from functools import reduce

import numpy as np
from numpy.typing import ArrayLike

from resources.world.skeleton import Array


def about(axis: str, angle: ArrayLike) -> Array:
    """Rotations (..., 3, 3) about the axis x, y or z by angles (...), radians, right-handed."""
    angle = np.asarray(angle, np.float64)
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    turn = np.zeros((*angle.shape, 3, 3))
    turn[..., i, i] = 1
    turn[..., j, j] = turn[..., k, k] = np.cos(angle)
    turn[..., k, j] = np.sin(angle)
    turn[..., j, k] = -np.sin(angle)
    return turn


def compose(*turns: Array) -> Array:
    """The product (..., 3, 3) of rotations, the last one applied first."""
    return reduce(np.matmul, turns)


def basis(along: Array, side: Array) -> Array:
    """Right-handed frames (..., 3, 3) in columns: along, the part of ``side`` across it, and their normal."""
    e = along / np.linalg.norm(along, axis=-1, keepdims=True)
    across = side - np.sum(side * e, axis=-1, keepdims=True) * e
    f = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return np.stack([e, f, np.cross(e, f)], axis=-1)


def align(rest: Array, rest_side: Array, along: Array, side: Array) -> Array:
    """Rotations (n, 3, 3) that take the direction ``rest`` (3,) to ``along`` (n, 3) and its side to ``side`` (n, 3)."""
    return basis(along, side) @ basis(rest, rest_side).T
