"""What camera files of other programs have in common: names in order, pinhole parameters, what is lost."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]

CENTRE = 0.5  # their pixel coordinate of the centre of the top-left pixel


def intrinsics(fx: float, fy: float, cx: float, cy: float, where: str) -> Array:
    """K (3, 3) with pixel centres at integers from parameters with centres at halves."""
    values = np.array([fx, fy, cx, cy], np.float64)
    if not np.isfinite(values).all() or fx <= 0 or fy <= 0:
        raise InputError(f"The camera in {where} has no usable focal length ({fx}, {fy}).")
    return np.array([[fx, 0, cx - CENTRE], [0, fy, cy - CENTRE], [0, 0, 1.0]])


def parameters(K: Array) -> tuple[float, float, float, float]:
    """(fx, fy, cx, cy) with pixel centres at halves; a skewed K has no such form."""
    if abs(K[0, 1]) > 1e-9 * K[0, 0]:
        raise InputError("Cameras with skewed pixels cannot be written to this format; make K[0, 1] zero.")
    return float(K[0, 0]), float(K[1, 1]), float(K[0, 2] + CENTRE), float(K[1, 2] + CENTRE)


def lost(distortion: Mapping[str, float]) -> str:
    """A sentence about lens distortion that is left out, or nothing."""
    named = ", ".join(f"{key} = {value:.3g}" for key, value in distortion.items() if abs(value) > 1e-9)
    if not named:
        return ""
    return f" Its lens distortion ({named}) is left out: undistort the video for exact results."
