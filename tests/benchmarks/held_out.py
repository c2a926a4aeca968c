"""How exact points of a camera solve are themselves that dense depth is measured against."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from imitation import CameraPath

NEAR = 25.0  # pixels between neighbours
LEVEL = 0.05  # relative depth: neighbours that differ by more lie on both sides of a step


def own_errors(path: CameraPath, frame: int, names: np.ndarray) -> np.ndarray:
    """Relative depth (k,) by which a frame's points may be off themselves: what their residuals leave open.

    Errors of one track are taken for independent from frame to frame; a corner that slides along an edge is worse.
    """
    at = path.observations[:, 0].astype(int)
    count = np.bincount(path.observed, minlength=len(path.points))

    def seen(points: np.ndarray) -> np.ndarray:
        inside = np.einsum("nij,nj->ni", path.R[at], points[path.observed]) + path.T[at]
        pixels = np.einsum("nij,nj->ni", path.K[at], inside)
        return pixels[:, :2] / pixels[:, 2:]

    def summed(offsets: np.ndarray) -> np.ndarray:
        return np.bincount(path.observed, weights=(offsets**2).sum(1), minlength=len(path.points))

    here = seen(path.points)
    left = np.sqrt(summed(here - path.observations[:, 1:]) / np.maximum(count, 1))
    # One per cent farther along this frame's rays moves a point by so much in all its frames.
    centre = path.centres[frame]
    moved = np.sqrt(summed(seen(path.points + 0.01 * (path.points - centre)) - here))
    return (0.01 * np.maximum(left, 0.2) / np.maximum(moved, 1e-9))[names]


def meeting_angles(path: CameraPath) -> np.ndarray:
    """Widest angle (p,) between two rays of each point, degrees; 0 where it is seen once."""
    rays = path.points[path.observed] - path.centres[path.observations[:, 0].astype(int)]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    order = np.argsort(path.observed, kind="stable")
    ends = np.searchsorted(path.observed[order], np.arange(len(path.points) + 1))
    widest = np.zeros(len(path.points))
    for point, (first, last) in enumerate(pairwise(ends)):
        if last - first > 1:
            each = rays[order[first:last]]
            widest[point] = np.degrees(np.arccos(np.clip((each @ each.T).min(), -1, 1)))
    return widest


def neighbours(pixels: np.ndarray, z: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far depth is from points of one frame that have a neighbour on the same surface, and from each other.

    A smooth error of the depth map is the same for both neighbours and leaves their difference as it is: what differs
    is the points' own scatter, and relief finer than the map.

    Parameters
    ----------
    pixels : (k, 2). z : (k,) camera z of the points. depth : (k,) the map's, finite.

    Returns
    -------
    off : (m,) relative differences of depth from points. scatter : (m,) what the points differ by, over root two.
    """
    if len(z) < 2:
        return np.zeros(0), np.zeros(0)
    away, other = cKDTree(pixels).query(pixels, k=2)
    signed = np.log(depth / z)
    paired = (away[:, 1] < NEAR) & (np.abs(np.log(depth / depth[other[:, 1]])) < LEVEL)
    return np.abs(signed[paired]), np.abs(signed - signed[other[:, 1]])[paired] / np.sqrt(2)
