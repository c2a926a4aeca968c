"""Contacts proposed from a track: frames in which it moves as a point that stands still in the world would."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.banded import Array

OnGround = Callable[[int, Array], Array | None]


def propose_contacts(
    positions: ArrayLike,
    cameras: CameraPath,
    *,
    depth: float | None = None,
    tolerance: float = 1.5,
    shortest: int = 4,
    ground: OnGround | None = None,
    others: ArrayLike | None = None,
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
    ground : (frame, pixel) -> place (3,), world, where the pixel's ray meets the ground, None where it meets none. A
        contact is still *there*: a foot in the air may be still at some other depth.
    others : (n, m, 2) tracks of other points of the subject, NaN where absent. At the top of a leap the whole body is
        still for a moment; where the camera's motion does not tell the ground's depth from others, a short run counts
        only while other points move.

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
    points = np.zeros((len(positions), 0, 2)) if others is None else np.asarray(others, np.float64)
    if points.ndim != 3 or points.shape[::2] != (len(positions), 2):
        raise InputError(f"Other tracks need shape ({len(positions)}, tracks, 2), not {points.shape}.")
    fit = StillPoint(positions, cameras, depth)
    rest = [StillPoint(points[:, other], cameras, depth) for other in range(points.shape[1])]
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
            if _touches(fit, rest, frame, last, tolerance, ground, short=3 * shortest):
                found.append((frame, last))
            frame = last + 1
        else:
            frame += 1
    return found


def _touches(
    fit: StillPoint,
    rest: list[StillPoint],
    first: int,
    last: int,
    tolerance: float,
    ground: OnGround | None,
    short: int,
) -> bool:
    """Whether a still run can be a contact: on the ground, and not a moment in which all of the body is still."""
    told = False
    if ground is not None:
        frames = sorted({round(share * (last - first)) + first for share in (0.0, 0.25, 0.5, 0.75, 1.0)})
        met = [place for frame in frames if (place := ground(frame, fit.positions[frame])) is not None]
        if not met:
            return False
        place = np.median(np.array(met), axis=0)
        if fit.off(first, last, place) > 2 * tolerance:
            return False
        # Half way to the camera: if that is seen to be wrong, the run tells that the point is on the ground.
        nearer = (place + fit.cameras.centres[(first + last) // 2]) / 2
        told = fit.off(first, last, nearer) > 2 * tolerance
    if told or not rest or last - first + 1 >= short:
        return True
    errors = [error for other in rest if np.isfinite(error := other.error(first, last))]
    return not errors or float(np.median(errors)) > max(tolerance, 1.5 * fit.error(first, last))


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
        return self.off(first, last, self._fit(frames))

    def place(self, first: int, last: int) -> Array:
        """The still point (3,), world, that frames first..last see; all of them must."""
        return self._fit(slice(first, last + 1))

    def off(self, first: int, last: int, point: Array) -> float:
        """Largest distance, pixels, of the track from a point's picture in frames first..last."""
        frames = slice(first, last + 1)
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
