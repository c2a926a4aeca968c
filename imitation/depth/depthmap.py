"""The depth of the background in one frame, and where a pixel's ray meets it."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Array, Camera

AGREED = 2
"""Other key frames that must agree for a depth to count as sure."""


@attrs.frozen(eq=False)
class DepthMap:
    """Depth of the static background as one frame's camera sees it (paper A, 3.1).

    Attributes
    ----------
    frame : which frame.
    depth : float32 (h, w) camera z, world units, NaN where none is known.
    confidence : uint8 (h, w) how many other key frames agree, at most 255.
    camera : of the frame, pixels of ``depth``.
    tolerance : relative depth that one step of the search stands for, at the middle depth.
    invented : bool (h, w) True where depth was filled in from around without any view of the place, or None.
    """

    frame: int
    depth: NDArray[np.float32]
    confidence: NDArray[np.uint8]
    camera: Camera
    tolerance: float = 0.02
    invented: NDArray[np.bool_] | None = None

    def sure(self, agreeing: int = AGREED) -> NDArray[np.bool_]:
        """Which pixels (h, w) have a depth that other key frames confirm."""
        sure: NDArray[np.bool_] = np.isfinite(self.depth) & (self.confidence >= agreeing)
        return sure

    def points(self, step: int = 1) -> Array:
        """World points (k, 3) of every ``step``-th pixel that has a depth."""
        rows, columns = np.mgrid[: self.depth.shape[0] : step, : self.depth.shape[1] : step]
        z = self.depth[::step, ::step].astype(np.float64)
        there = np.isfinite(z)
        return self.camera.lift(np.stack([columns[there], rows[there]], axis=-1), z[there])

    def place(self, pixel: ArrayLike, *, radius: float = 4.0) -> tuple[Array, float]:
        """Where the ray of a pixel meets the background, and how far the depths round it stray from a plane there.

        Inverse depth is linear over the picture of a plane, so a plane is fitted to the inverse depths within
        ``radius`` pixels that belong to the surface at the pixel (nearer than a step), robustly, and read off at the
        pixel itself: sub-pixel in place and in depth.

        Parameters
        ----------
        pixel : (2,) x, y.
        radius : pixels.

        Returns
        -------
        place : (3,) world. residual : rms distance along the rays, world units.

        Raises
        ------
        NoSolution
            No depth is known round the pixel.
        """
        spot = np.asarray(pixel, np.float64)
        height, width = self.depth.shape
        if spot.shape != (2,) or not np.isfinite(spot).all():
            raise InputError(f"A place in the picture is two finite numbers (x, y), but got {spot}.")
        left, top = (int(max(0, np.floor(c - radius))) for c in spot)
        right, bottom = (int(np.ceil(c + radius)) + 1 for c in spot)
        # Nothing of the picture is near a pixel far outside it.
        bottom, right = max(min(bottom, height), top), max(min(right, width), left)
        rows, columns = np.mgrid[top:bottom, left:right]
        z = self.depth[top:bottom, left:right].astype(np.float64)
        dx, dy = columns - spot[0], rows - spot[1]
        near = np.isfinite(z) & (np.hypot(dx, dy) <= radius)
        if near.sum() < 6:
            raise NoSolution(
                f"No background depth is known near pixel ({spot[0]:.0f}, {spot[1]:.0f}) of frame {self.frame}: "
                "it may lie outside the picture or behind the subject."
            )
        dx, dy, w = dx[near], dy[near], 1 / z[near]
        close = np.exp(-(dx**2 + dy**2) / (0.5 * radius**2))
        surface = _surface_at(np.hypot(dx, dy), w, 3 * self.tolerance)
        dx, dy, w, close = dx[surface], dy[surface], w[surface], close[surface]
        basis = np.stack([np.ones_like(dx), dx, dy], axis=1)
        weight = close.copy()
        plane = np.array([np.median(w), 0.0, 0.0])
        for _ in range(5):
            root = np.sqrt(weight)[:, None]
            # A little weight on level keeps a fit to few pixels from tipping over.
            ridge = np.diag([0.0, 1e-3, 1e-3]) * weight.sum()
            plane = np.linalg.solve((root * basis).T @ (root * basis) + ridge, (root * basis).T @ (root[:, 0] * w))
            off = np.abs(basis @ plane - w)
            scale = 1.5 * float(np.median(off)) + 1e-12
            weight = close / (1 + (off / scale) ** 2)
        depth = 1 / float(np.clip(plane[0], w.min(), w.max()))
        off = 1 / np.maximum(basis @ plane, 1e-12) - 1 / w
        residual = float(np.sqrt(np.average(off**2, weights=weight)))
        return self.camera.lift(spot, depth), residual


def _surface_at(away: Array, w: Array, tolerance: float) -> NDArray[np.bool_]:
    """Which of the inverse depths (k,) belong to the surface at the middle: within a tolerance of most near ones."""
    nearest = w[np.argsort(away, kind="stable")[: max(3, len(w) // 6)]]
    middle = float(np.median(nearest))
    surface: NDArray[np.bool_] = np.abs(w - middle) <= tolerance * 3 * middle
    return surface


def scaled_camera(camera: Camera, scale: tuple[float, float]) -> Camera:
    """The same camera for a picture resized by (x, y) factors; pixel centres stay at integers."""
    x, y = scale
    change = np.array([[x, 0, (x - 1) / 2], [0, y, (y - 1) / 2], [0, 0, 1.0]])
    return Camera(change @ camera.K, camera.R, camera.T)


def resized(inverse: NDArray[Any], size: tuple[int, int], step: float) -> NDArray[np.float32]:
    """Inverse depths (h, w) brought to another size (width, height); not blended over steps larger than ``step``."""
    import cv2

    if inverse.shape == size[::-1]:
        return inverse.astype(np.float32)
    values = inverse.astype(np.float32)
    smooth = cv2.resize(values, size, interpolation=cv2.INTER_LINEAR)
    nearest = cv2.resize(values, size, interpolation=cv2.INTER_NEAREST_EXACT)
    kernel = np.ones((3, 3), np.uint8)
    high, low = cv2.dilate(values, kernel), cv2.erode(values, kernel)
    broken = cv2.resize((high - low > step).astype(np.uint8), size, interpolation=cv2.INTER_NEAREST_EXACT) > 0
    result: NDArray[np.float32] = np.where(broken, nearest, smooth)
    return result
