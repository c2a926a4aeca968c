"""Which way a long body faces: a performer on four legs shows no shoes, but lies along its heading."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.features.heading import SHOE, TRAVEL_SPEED

Array = NDArray[np.float64]
LONGER = 1.2
"""Median length over height (standard deviations of the surface) from which a body counts as long."""
HEAD = 0.95
"""What lies above this quantile of the height is taken for the head."""
SLENDER = 1.7
"""Median length over width; a person with outstretched arms stays below ``LONGER``."""


def lengthwise_cues(samples: NDArray[np.floating], height: float, fps: float) -> Array | None:
    """Unit cues of the length of ``SHOE`` bodies along the body, or None for a body that is not long.

    The long axis of the surface's shadow on the ground, its sense carried from frame to frame. Which end is the front
    is said by the travel; where there is little of it, by the highest points, which belong to the head.

    Parameters
    ----------
    samples : (n, p, 3) float
        Points spread over each frame's surface, z up.
    height : float
        Body height in the same unit.
    fps : float

    Returns
    -------
    (n, 2) float64, in bodies, as ``foot_cue`` gives them
    """
    points = np.asarray(samples, np.float64)
    centred = points - points.mean(axis=1, keepdims=True)
    ground = centred[:, :, :2]
    values, vectors = np.linalg.eigh(np.einsum("npi,npj->nij", ground, ground) / points.shape[1])
    spread = np.sqrt(np.maximum(values, 1e-18))
    tall = np.sqrt(np.maximum((centred[:, :, 2] ** 2).mean(axis=1), 1e-18))
    if np.median(spread[:, 1] / tall) < LONGER or np.median(spread[:, 1] / spread[:, 0]) < SLENDER:
        return None
    axis = vectors[:, :, 1].copy()
    agree = np.sign((axis[1:] * axis[:-1]).sum(axis=1))
    axis[1:] *= np.cumprod(np.where(agree == 0, 1.0, agree))[:, None]
    forward = 0.0
    if len(points) > 1:
        velocity = np.gradient(points.mean(axis=1)[:, :2], axis=0) * fps / height
        fast = np.hypot(*velocity.T) > 0.5 * TRAVEL_SPEED
        forward = float((velocity * axis).sum(axis=1)[fast].sum())
    if abs(forward) < TRAVEL_SPEED * fps * 0.2:
        along = np.einsum("npi,ni->np", ground, axis)
        top = np.quantile(centred[:, :, 2], HEAD, axis=1)
        forward = float(np.where(centred[:, :, 2] >= top[:, None], along, 0.0).sum())
    return np.asarray(SHOE * np.where(forward < 0, -1.0, 1.0) * axis)
