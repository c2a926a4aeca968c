"""Track transfer: a target's track has the source's motion gradient and given places (paper A, 3.3, eq. 5-6)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array


def transfer_track(source: ArrayLike, boundary: Mapping[int, ArrayLike], *, smooth: bool = False) -> Array:
    """Carry a track's motion onto another point (paper A, eq. 5-6).

    Parameters
    ----------
    source : (n, d) track of the source (pixels, d = 2, or world, d = 3); NaN where absent.
    boundary : edited frame -> place (d,) of the target in it.
    smooth : False spreads the difference linearly between edited frames, which is the least-squares solution of
        eq. 5-6; True spreads it by a monotone cubic that rests at the edited frames: no velocity jump, and a
        boundary value changes nothing beyond the next edited frame on either side. Before the first and after
        the last edited frame the difference is held, as eq. 5 implies.

    Returns
    -------
    (n, d) the target's track; exactly the boundary values in the edited frames, NaN where the source is.

    Raises
    ------
    InputError
        No boundary value, one outside the track or of another dimension, or one where the source is absent.
    """
    source = np.asarray(source, np.float64)
    if source.ndim != 2:
        raise InputError(f"A track to transfer needs shape (frames, dimensions), but has {source.shape}.")
    if not boundary:
        raise InputError("A track can only be transferred with a boundary value; give the target's place in one frame.")
    frames = sorted(boundary)
    places = []
    for frame in frames:
        place = np.asarray(boundary[frame], np.float64)
        if not 0 <= frame < len(source):
            raise InputError(f"The boundary value in frame {frame} is outside the track of {len(source)} frames.")
        if place.shape != source.shape[1:] or not np.isfinite(place).all():
            raise InputError(f"The boundary value in frame {frame} needs {source.shape[1]} finite numbers.")
        if not np.isfinite(source[frame]).all():
            raise InputError(
                f"The track is absent in edited frame {frame}; track the point there, or edit another frame."
            )
        places.append(place)
    offsets = np.array(places) - source[frames]
    track = source + correction_curve(len(source), frames, offsets, smooth=smooth)
    track[frames] = places
    return track


def correction_curve(
    count: int, frames: Sequence[int], values: Array, *, smooth: bool = True, clock: Array | None = None
) -> Array:
    """Interpolate corrections (m, ...) given in edited frames to all frames (count, ...).

    Between two edited frames the curve depends on these two alone, so that an edit reaches to its neighbours and no
    further. ``clock`` (count,) is the time in which it runs (see `swing_clock`); default the frame number. Before
    the first and after the last edited frame the correction is held.
    """
    values = np.asarray(values, np.float64)
    curve = np.zeros((count, *values.shape[1:]))
    curve[: frames[0] + 1] = values[0]
    curve[frames[-1] :] = values[-1]
    for place, (first, last) in enumerate(pairwise(frames)):
        share = span_share(first, last, smooth=smooth, clock=clock)
        share = share.reshape(-1, *[1] * (values.ndim - 1))
        curve[first : last + 1] = (1 - share) * values[place] + share * values[place + 1]
        curve[last] = values[place + 1]
    return curve


def span_share(first: int, last: int, *, smooth: bool, clock: Array | None = None) -> Array:
    """Share (last - first + 1,) of the later edited frame's correction in the frames of a span."""
    time = np.arange(first, last + 1, dtype=np.float64) if clock is None else clock[first : last + 1]
    if time[-1] <= time[0]:
        # Both edits lie in one contact: it has to move from one place to the other in the time there is.
        time = np.arange(first, last + 1, dtype=np.float64)
    share: Array = (time - time[0]) / (time[-1] - time[0])
    return share * share * (3 - 2 * share) if smooth else share


def swing_clock(planted: NDArray[np.bool_]) -> Array:
    """Time (n,) that stands still while a foot is planted (n,): a correction running in it does not drag the foot."""
    moving = ~(planted[1:] & planted[:-1])
    return np.concatenate([[0.0], np.cumsum(moving, dtype=np.float64)])
