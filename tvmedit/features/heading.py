"""Which way the performer faces: from the feet, from the direction of travel, held together over time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHOE = 0.035
"""Body heights: a foot cue this long is trusted fully."""
TRAVEL_SPEED = 0.35
"""Body heights a second: above it the direction of travel counts."""
SMOOTHING = 0.12
"""Seconds."""
BRIDGE = 0.25
"""Seconds over which headings are held together where the body's turning is known."""
MOST_TURN = 0.3
"""Radians between two frames."""
SPIN = 10.0
"""Radians a second that a performer may turn."""


def turning(histograms: NDArray[np.float32], most: float = MOST_TURN) -> Array:
    """Turn from each frame to the next, as the body's shape shows it: the yaw of the best correlation over azimuth.

    Parameters
    ----------
    histograms : (n, h, r, a) float32
        Robust features.
    most : float
        Radians; larger turns between two frames are not looked for.

    Returns
    -------
    (n,) float64
        Radians, summed up from frame 0, which has 0.
    """
    spectrum = np.fft.rfft(histograms.astype(np.float64), axis=3)
    cross = (np.conj(spectrum[:-1]) * spectrum[1:]).sum(axis=(1, 2))
    angles = np.linspace(-most, most, 61)
    # A turn by an angle multiplies harmonic k by exp(-i k angle).
    correlation = (cross @ np.exp(1j * np.outer(np.arange(cross.shape[1]), angles))).real
    return np.asarray(np.r_[0.0, np.cumsum(angles[correlation.argmax(axis=1)])])


def facing(
    cues: Array, centres: Array, height: float, fps: float, front: float | None = None, turns: Array | None = None
) -> Array:
    """Heading of every frame.

    Each frame gives a vector: its foot cue, as strong as it is long (a kicking or flying performer shows none), and
    the direction of travel above 0.35 body heights a second. The headings are the smooth field of directions closest
    to these vectors (one tridiagonal system on complex numbers), so a frame without a cue takes its neighbours'.

    Parameters
    ----------
    cues : (n, 2) float64
        What ``foot_cue`` gives.
    centres : (n, 2) float64
        Centroid on the ground, in the unit of height.
    height, fps : float
    front : float, optional
        The user's word on frame 0, radians: all headings are turned by the same angle to agree with it.
    turns : (n,) float64, optional
        What ``turning`` gives: carries headings over frames without a cue. It drifts: used over short times only.

    Returns
    -------
    (n,) float64
        Radians about the up axis, from +x towards +y, in (-pi, pi].
    """
    n = len(cues)
    vector = cues[:, 0] + 1j * cues[:, 1]
    length = np.abs(vector)
    vector = np.where(length > 1e-9, vector / np.maximum(length, 1e-9), 0.0) * np.minimum(length / SHOE, 1.0) ** 2
    if n > 1:
        place = _smooth(centres[:, 0] + 1j * centres[:, 1], 0.15 * fps)
        velocity = np.gradient(place) * fps / height
        speed = np.abs(velocity)
        ramp = np.clip((speed - TRAVEL_SPEED) / TRAVEL_SPEED, 0.0, 1.0)
        vector = vector + 1.5 * ramp * velocity / np.maximum(speed, 1e-9)
    field = _smooth(vector, SMOOTHING * fps, floor=1e-4, confidence=np.abs(vector))
    fastest = float(np.abs(np.angle(field[1:] * np.conj(field[:-1]))).max(initial=0.0))
    if turns is not None and fastest > max(MOST_TURN, SPIN / fps):
        # Faster than anyone turns: the cue is lost somewhere (a high kick, a jump, feet that are no shoes).
        # Smooth what is left of the cues once the turning is taken out, and put it back.
        still = vector * np.exp(-1j * turns)
        field = _smooth(still, BRIDGE * fps, floor=1e-4, confidence=np.abs(vector)) * np.exp(1j * turns)
    angles = np.angle(field)
    if front is not None:
        angles = np.angle(np.exp(1j * (angles - angles[0] + front)))
    return np.asarray(angles, np.float64)


def _smooth(
    values: NDArray[np.complex128], width: float, *, floor: float = 1.0, confidence: Array | None = None
) -> NDArray[np.complex128]:
    """Minimise sum c |u - v / max(c, .)|^2 + width^2 sum |u' |^2: a low-pass that bridges what has no confidence."""
    from scipy.linalg import solveh_banded

    n = len(values)
    if n == 1:
        return values
    weight = np.ones(n) if confidence is None else np.maximum(confidence, floor)
    target = values if confidence is None else values / np.maximum(confidence, 1e-9)
    bands = np.zeros((2, n))
    bands[1] = weight + 2 * width**2
    bands[1, [0, -1]] -= width**2
    bands[0, 1:] = -(width**2)
    real = solveh_banded(bands, weight * target.real)
    imaginary = solveh_banded(bands, weight * target.imag)
    return np.asarray(real + 1j * imaginary)
