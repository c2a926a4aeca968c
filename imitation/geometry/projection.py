"""Pinhole cameras: OpenCV axes (x right, y down, z forward), pixel centres at integers, ``x_cam = R x_world + T``."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]


def _matrix(value: ArrayLike, shape: tuple[int, ...]) -> Array:
    array = np.array(value, dtype=np.float64)
    if array.size != int(np.prod(shape)) or not np.isfinite(array).all():
        raise InputError(f"A camera needs {shape} finite numbers, but got an array of shape {array.shape}.")
    array = array.reshape(shape)
    array.setflags(write=False)
    return array


def _square(value: ArrayLike) -> Array:
    return _matrix(value, (3, 3))


def _vector(value: ArrayLike) -> Array:
    return _matrix(value, (3,))


@attrs.frozen(eq=False)
class Camera:
    """One frame's camera.

    Attributes
    ----------
    K : (3, 3) intrinsic matrix, pixels.
    R : (3, 3) rotation, world to camera.
    T : (3,) translation, world units; ``x_cam = R x_world + T``.
    """

    K: Array = attrs.field(converter=_square)
    R: Array = attrs.field(converter=_square)
    T: Array = attrs.field(converter=_vector)

    @property
    def centre(self) -> Array:
        """The centre of projection (3,), world."""
        return -self.R.T @ self.T

    def project(self, points: ArrayLike) -> Array:
        """Project world points (..., 3) to pixels (..., 2); NaN where a point is not in front of the camera."""
        local = np.asarray(points, np.float64) @ self.R.T + self.T
        image = local @ self.K.T
        with np.errstate(divide="ignore", invalid="ignore"):
            pixels: Array = np.where(local[..., 2:] > 0, image[..., :2] / image[..., 2:], np.nan)
        return pixels

    def depth(self, points: ArrayLike) -> Array:
        """Camera z (...,) of world points (..., 3)."""
        z: Array = np.asarray(points, np.float64) @ self.R[2] + self.T[2]
        return z

    def rays(self, pixels: ArrayLike) -> Array:
        """World directions (..., 3) of pixels (..., 2), with unit camera z: ``centre + z * ray`` has depth z."""
        pixels = np.asarray(pixels, np.float64)
        homogeneous = np.concatenate([pixels, np.ones((*pixels.shape[:-1], 1))], axis=-1)
        directions: Array = homogeneous @ np.linalg.inv(self.K).T @ self.R
        return directions

    def lift(self, pixels: ArrayLike, depth: ArrayLike) -> Array:
        """World points (..., 3) seen at pixels (..., 2) with camera z depth (...,) (paper A, eq. 1)."""
        points: Array = self.centre + np.asarray(depth, np.float64)[..., None] * self.rays(pixels)
        return points
