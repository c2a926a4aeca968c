"""Polish: lifted 3D tracks freed from the jitter of their 2D tracks, contacts held still."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.cameras import CameraPath
from imitation.motion.banded import Array, solve_band
from imitation.motion.rays import lift_points, pixel_size, project_points, rays_of, windowed_acceleration

STILL = 0.0002
HELD = 0.001
ALONG = 0.003
FLOOR = 0.001
DOUBT = 20.0
"""Pixels that a track without any confidence may be off; a half means a quarter of it."""
NOISE_SHARE = 1.3 * 12
"""Noise alone shows as 6 spread^2 on each of two axes; 1.3 for what a short window's mean leaves above it."""


def pixel_noise(points: Array, cameras: CameraPath, observed: NDArray[np.bool_]) -> Array:
    """Standard deviation (k,) of each 2D track's jitter, pixels, from lifted points (n, k, 3).

    Fourth differences across the rays hold little of a body's motion and 70 times the noise's variance; their
    median is blind to single sudden moves. Measured in the world, so that the camera's shaking does not count.
    """
    count, keys = points.shape[:2]
    noise = np.zeros(keys)
    if count < 8:
        return noise
    across, scale = _across(points, cameras)
    for key in range(keys):
        present = np.convolve(observed[:, key], np.ones(5), "valid") == 5
        if present.sum() >= 8:
            size = np.abs(across[:, key][present]) * scale[2:-2, key][present, None]
            noise[key] = np.median(size) / 0.6745 / np.sqrt(70.0)
    return noise


def denoise_tracks(
    pixels: Array,
    cameras: CameraPath,
    depths: Array,
    diagonal: float,
    observed: NDArray[np.bool_],
    confidence: Array | None = None,
) -> tuple[Array, Array]:
    """2D tracks (n, k, 2) freed of their jitter, and that jitter (k,), pixels.

    They are smoothed in space, at the constant depths (k,) of frame 0, where the camera's shaking is gone. Frames of
    low ``confidence`` (n, k) count as so much less exact, and are bridged where little speaks for them.
    """
    points = lift_points(cameras, pixels, np.broadcast_to(depths, pixels.shape[:2]))
    noise = pixel_noise(points, cameras, observed)
    spread = np.broadcast_to(noise, pixels.shape[:2])
    if confidence is not None:
        spread = np.hypot(spread, DOUBT * (1 - confidence) ** 2)
    smooth = polish(points, cameras, rays_of(cameras, pixels)[1], diagonal, noise=spread, observed=observed)
    clean = project_points(cameras, smooth)
    return np.where(np.isfinite(clean), clean, pixels), noise


def polish(
    points: Array,
    cameras: CameraPath,
    directions: Array,
    diagonal: float,
    *,
    noise: Array,
    planted: NDArray[np.bool_] | None = None,
    held: NDArray[np.bool_] | None = None,
    observed: NDArray[np.bool_] | None = None,
    window: float = 3.0,
) -> Array:
    """Smooth lifted points as far as their noise asks for; one linear solve per key point.

    Parameters
    ----------
    points : (n, k, 3) lifted key points, world.
    directions : (n, k, 3) ray directions of unit camera z.
    diagonal : the character's bounding-box diagonal, world units.
    noise : (k,) or (n, k) standard deviation of each 2D track, pixels.
    planted : (n, k) frames in contact: there the point stands still.
    held : (n, k) frames whose points are known (frame 0, edits).
    observed : (n, k) frames in which the 2D track is present; in the others only smoothness speaks.

    Returns
    -------
    (n, k, 3) polished points, world.
    """
    count, keys = points.shape[:2]
    if count < 3:
        return points.copy()
    planted = np.zeros((count, keys), bool) if planted is None else planted
    held = np.zeros((count, keys), bool) if held is None else held
    observed = np.ones((count, keys), bool) if observed is None else observed
    size = pixel_size(cameras, points) / diagonal
    spread = np.maximum(noise * size, 1e-5)
    seen, along = windowed_acceleration(points / diagonal, directions, window)
    acceleration = np.maximum(seen - NOISE_SHARE * spread[1:-1] ** 2, FLOOR**2) + along
    across = np.where(observed, spread, 0.05)
    along = 2 * np.maximum(across, ALONG)
    firm = held | planted
    across, along = np.where(firm, HELD, across), np.where(firm, HELD, along)
    result = np.empty_like(points)
    for key in range(keys):
        still = (planted[1:, key] & planted[:-1, key]) / STILL**2
        result[:, key] = _solve_key(
            points[:, key] / diagonal,
            directions[:, key],
            across[:, key],
            along[:, key],
            1 / acceleration[:, key],
            still,
        )
    return result * diagonal


def _solve_key(data: Array, directions: Array, across: Array, along: Array, acceleration: Array, still: Array) -> Array:
    count = len(data)
    ray = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    outer = ray[:, :, None] * ray[:, None, :]
    weight = (np.eye(3) - outer) / across[:, None, None] ** 2 + outer / along[:, None, None] ** 2
    band = np.zeros((7, count, 3))
    for offset in range(3):
        for axis in range(3 - offset):
            band[offset, :, axis] = weight[:, axis + offset, axis]
    a = acceleration[:, None]
    band[0, :-2] += a
    band[0, 1:-1] += 4 * a
    band[0, 2:] += a
    band[3, :-2] -= 2 * a
    band[3, 1:-1] -= 2 * a
    band[6, :-2] += a
    band[0, :-1] += still[:, None]
    band[0, 1:] += still[:, None]
    band[3, :-1] -= still[:, None]
    right = np.einsum("nij,nj->ni", weight, data)
    return solve_band(band.reshape(7, count * 3), right.ravel()).reshape(count, 3)


def _across(points: Array, cameras: CameraPath) -> tuple[Array, Array]:
    """Fourth differences (n - 4, k, 2) along the picture's axes, and pixels per world unit (n, k)."""
    change = np.diff(points, 4, axis=0)
    across = np.einsum("nij,nkj->nki", cameras.R[2:-2, :2], change)
    return across, 1 / pixel_size(cameras, points)
