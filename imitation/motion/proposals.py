"""Contacts proposed from a track: frames in which it moves as a point that stands still in the world would."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.banded import Array


def propose_contacts(
    positions: ArrayLike,
    cameras: CameraPath,
    *,
    depth: float | None = None,
    tolerance: float = 1.5,
    shortest: int = 4,
) -> list[tuple[int, int]]:
    """Intervals in which a track could be a planted point: its velocity vanishes once the camera's is taken out.

    For a run of frames one still point is fitted to all its rays; the run is a contact while the track stays within
    the tolerance of that point's picture. Nothing is accepted here: the intervals are for the user to confirm.

    Parameters
    ----------
    positions : (n, 2) track, pixels; NaN where absent.
    cameras : the clip's cameras.
    depth : rough camera z of the subject, world units. It decides where the camera hardly moves, so that a point
        moving along its ray's picture is not taken for one standing elsewhere; default the depth that fits best.
    tolerance : largest distance from the still point's picture, pixels.
    shortest : fewest frames of a contact.

    Returns
    -------
    [(first, last), ...] both included, in order, not overlapping.

    Raises
    ------
    InputError
        The lengths differ, or the depth or tolerance is not positive.
    """
    positions = np.asarray(positions, np.float64)
    if positions.ndim != 2 or positions.shape[1:] != (2,) or len(positions) != len(cameras):
        raise InputError(f"A track for {len(cameras)} cameras needs shape ({len(cameras)}, 2), not {positions.shape}.")
    if tolerance <= 0 or (depth is not None and depth <= 0):
        raise InputError("The tolerance and the depth for proposing contacts must be positive.")
    fit = StillPoint(positions, cameras, depth)
    still = _still_runs(fit, tolerance, shortest)
    found: list[tuple[int, int]] = []
    frame = 0
    while frame < len(positions):
        if not still[frame]:
            frame += 1
            continue
        last = frame
        while last + 1 < len(positions) and fit.error(frame, last + 1) <= tolerance:
            last += 1
        if last - frame + 1 >= shortest:
            found.append((frame, last))
            frame = last + 1
        else:
            frame += 1
    return found


class StillPoint:
    """The still world point that explains a run of frames best, and how badly it does."""

    def __init__(self, positions: Array, cameras: CameraPath, depth: float | None) -> None:
        self.positions, self.cameras = positions, cameras
        self.present: NDArray[np.bool_] = np.asarray(np.isfinite(positions).all(axis=1))
        self.depth = depth
        # Two rows a frame of x cross (K [R | T] X) = 0, so that rows @ X = right.
        projection = cameras.K @ np.concatenate([cameras.R, cameras.T[:, :, None]], axis=2)
        rows = positions[:, :, None] * projection[:, 2:3] - projection[:, :2]
        self._rows, self._right = rows[..., :3], -rows[..., 3]

    def error(self, first: int, last: int) -> float:
        """Largest distance, pixels, of the track from the fitted point's picture in frames first..last."""
        frames = slice(first, last + 1)
        if not self.present[frames].all():
            return np.inf
        point = self._fit(frames)
        picture = self.cameras.K[frames] @ (self.cameras.R[frames] @ point + self.cameras.T[frames])[..., None]
        if (picture[:, 2, 0] <= 0).any():
            return np.inf
        distance = picture[:, :2, 0] / picture[:, 2:, 0] - self.positions[frames]
        return float(np.sqrt((distance**2).sum(axis=1)).max())

    def _fit(self, frames: slice) -> Array:
        middle = (frames.start + frames.stop) // 2
        scale = 1.0 if self.depth is None else self.depth
        rows, right = self._rows[frames].reshape(-1, 3) / scale, self._right[frames].ravel() / scale
        if self.depth is not None:
            # The depth is known to a tenth; a pixel counts as much as a tenth of the depth.
            forward = self.cameras.R[middle, 2]
            rows = np.concatenate([rows, 10 * forward[None] / self.depth])
            right = np.concatenate([right, [10 * (self.depth - self.cameras.T[middle, 2]) / self.depth]])
        solution: Array = np.linalg.lstsq(rows, right, rcond=1e-10)[0]
        return solution


def _still_runs(fit: StillPoint, tolerance: float, shortest: int) -> NDArray[np.bool_]:
    """Frames (n,) from which a run of the shortest length is still."""
    count = len(fit.positions)
    still = np.zeros(count, bool)
    for first in range(count - shortest + 1):
        still[first] = fit.error(first, first + shortest - 1) <= tolerance
    return still
