"""Key points over a whole clip: rays, depths, lifting and projection of (frames, key points) arrays at once."""

from __future__ import annotations

import numpy as np

from imitation.cameras import CameraPath
from imitation.motion.banded import Array


def rays_of(cameras: CameraPath, pixels: Array) -> tuple[Array, Array]:
    """Camera centres (n, 3) and ray directions (n, k, 3) of unit camera z through pixels (n, k, 2), world."""
    homogeneous = np.concatenate([pixels, np.ones((*pixels.shape[:2], 1))], axis=2)
    to_world = np.linalg.inv(cameras.K).transpose(0, 2, 1) @ cameras.R
    return cameras.centres, homogeneous @ to_world


def lift_points(cameras: CameraPath, pixels: Array, depths: Array) -> Array:
    """World points (n, k, 3) at pixels (n, k, 2) with camera z (n, k) (paper A, eq. 1)."""
    centres, directions = rays_of(cameras, pixels)
    points: Array = centres[:, None] + depths[..., None] * directions
    return points


def depths_of(cameras: CameraPath, points: Array) -> Array:
    """Camera z (n, k) of world points (n, k, 3)."""
    depths: Array = np.einsum("nj,nkj->nk", cameras.R[:, 2], points) + cameras.T[:, 2, None]
    return depths


def project_points(cameras: CameraPath, points: Array) -> Array:
    """Pixels (n, k, 2) of world points (n, k, 3); NaN where a point is not in front of its camera."""
    return np.stack([cameras[frame].project(points[frame]) for frame in range(len(points))])


def pixel_size(cameras: CameraPath, points: Array) -> Array:
    """World size (n, k) of one pixel at each point."""
    focal = np.sqrt(cameras.K[:, 0, 0] * cameras.K[:, 1, 1])
    size: Array = depths_of(cameras, points) / focal[:, None]
    return size


def windowed_acceleration(points: Array, directions: Array, window: float) -> tuple[Array, Array]:
    """Squared second difference of points (n, k, 3) across and along their rays, Gaussian mean over ``window`` frames.

    Returns
    -------
    across (n - 2, k) : what the picture shows of a point's acceleration, jitter of the track included.
    along (n - 2, k) : what the depths make of it.
    """
    from scipy.ndimage import gaussian_filter1d

    ray = directions[1:-1] / np.linalg.norm(directions[1:-1], axis=-1, keepdims=True)
    change = np.diff(points, 2, axis=0)
    depth = (change * ray).sum(axis=-1)
    across = ((change - depth[..., None] * ray) ** 2).sum(axis=-1)
    seen, made = (gaussian_filter1d(part, window, axis=0, mode="nearest") for part in (across, depth**2))
    return np.maximum(seen, 0), np.maximum(made, 0)
