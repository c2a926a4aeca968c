"""Rotations: best fits between point sets, quaternions (w, x, y, z), turns about an axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from imitation.geometry.projection import Array


def axis_rotation(axis: ArrayLike, angle: float) -> Array:
    """Rotation (3, 3) by an angle in radians about an axis (3,) through the origin, right-handed (Rodrigues)."""
    direction = np.asarray(axis, np.float64)
    direction = direction / np.linalg.norm(direction)
    turn = cross_matrix(direction)
    rotation: Array = np.eye(3) + np.sin(angle) * turn + (1 - np.cos(angle)) * turn @ turn
    return rotation


def cross_matrix(vector: ArrayLike) -> Array:
    """The matrix (3, 3) with ``cross_matrix(a) @ b == cross(a, b)``."""
    x, y, z = np.asarray(vector, np.float64)
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rotation_of(vector: ArrayLike) -> Array:
    """Rotation (3, 3) by the length of a vector (3,), radians, about its direction."""
    turn = np.asarray(vector, np.float64)
    angle = float(np.linalg.norm(turn))
    return axis_rotation(turn, angle) if angle > 1e-300 else np.eye(3)


def nearest_rotation(matrix: ArrayLike, fallback: ArrayLike | None = None) -> Array:
    """The rotation R (3, 3) with the largest trace of ``R.T @ matrix``.

    Where the matrix has rank 1 or less the rotation is not determined; then the answer is the one nearest to
    ``fallback`` (identity if not given).
    """
    given = np.asarray(matrix, np.float64)
    scale = float(np.abs(given).max())
    prior = np.eye(3) if fallback is None else np.asarray(fallback, np.float64)
    if scale == 0:
        return prior.copy()
    singular = np.linalg.svd(given, compute_uv=False)
    if singular[1] < 1e-9 * singular[0]:
        given = given + 1e-6 * scale * prior
    left, _, right = np.linalg.svd(given)
    left[:, 2] *= np.sign(np.linalg.det(left @ right))
    rotation: Array = left @ right
    return rotation


def kabsch(source: ArrayLike, target: ArrayLike, weights: ArrayLike | None = None) -> tuple[Array, Array]:
    """Rotation (3, 3) and translation (3,) that take points (k, 3) best onto points (k, 3) in the least squares sense.

    ``target ~ source @ rotation.T + translation``. Points on one line leave the turn about it at zero.
    """
    before, after = np.asarray(source, np.float64), np.asarray(target, np.float64)
    share = np.ones(len(before)) if weights is None else np.asarray(weights, np.float64)
    share = share / share.sum()
    # Sums instead of matrix products: these do not depend on the number of threads.
    centre, moved = (share[:, None] * before).sum(axis=0), (share[:, None] * after).sum(axis=0)
    rotation = nearest_rotation(np.einsum("ki,kj,k->ij", after - moved, before - centre, share))
    return rotation, moved - rotation @ centre


def quaternion_of(rotation: ArrayLike) -> Array:
    """Unit quaternion (w, x, y, z), w >= 0, of a rotation (3, 3)."""
    r = np.asarray(rotation, np.float64)
    symmetric = np.array(
        [
            [r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [0, r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [0, 0, r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1]],
            [0, 0, 0, r[2, 2] - r[0, 0] - r[1, 1]],
        ]
    )
    quaternion: Array = np.linalg.eigh(symmetric, UPLO="U")[1][:, -1]
    return quaternion if quaternion[0] >= 0 else -quaternion


def quaternion_product(first: ArrayLike, second: ArrayLike) -> Array:
    """Quaternions (..., 4) of the rotation ``first @ second``."""
    a, b = np.asarray(first, np.float64), np.asarray(second, np.float64)
    scalar = a[..., :1] * b[..., :1] - np.sum(a[..., 1:] * b[..., 1:], axis=-1, keepdims=True)
    vector = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    return np.concatenate([scalar, vector], axis=-1)


def quaternion_matrix(quaternions: ArrayLike) -> Array:
    """Rotations (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions, np.float64), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
