"""Camera paths against the truth, whatever world they were solved in."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def path_error(found: Floats, truth: Floats) -> float:
    """Rms distance (share of the path's length) of centres (n, 3) after the best similarity."""
    a, b = found - found.mean(0), truth - truth.mean(0)
    left, values, right = np.linalg.svd(b.T @ a)
    signs = np.array([1, 1, np.sign(np.linalg.det(left @ right))])
    scale = (values * signs).sum() / (a**2).sum()
    off = scale * a @ (left * signs @ right).T - b
    length = np.linalg.norm(np.diff(truth, axis=0), axis=1).sum()
    return float(np.sqrt((off**2).sum(1).mean()) / length)


def turn_error(found: Floats, truth: Floats) -> Floats:
    """Angles (n,), degrees, between rotations (n, 3, 3) relative to the first frame."""
    turned = (found @ found[0].T) @ np.swapaxes(truth @ truth[0].T, 1, 2)
    cosine = (np.trace(turned, axis1=1, axis2=2) - 1) / 2
    angles: Floats = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    return angles
