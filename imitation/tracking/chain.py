"""What both modes give for a run of frames, before it is judged."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = tuple[float, float]
SUDDEN = 0.15  # correlation with the frame before, below which the look changed at once
UNLIKE = 0.4  # correlation with the clicks, below which the point does not look like them


@attrs.frozen(eq=False)
class Chain:
    """A solved run of m frames, in the order of solving (away from the click where an end is open).

    Attributes
    ----------
    positions : (m, 2) pixels.
    steps : (m,) cost of the step into each frame, 0 in the first.
    match : (m,) correlation with the click that looks more alike; NaN where the mode does not say.
    gap : (m,) distance by which the flow there and back fails to return, pixels; NaN where the mode does not say.
    hidden : (m,) whether something is in front of the point.
    margin : (m,) how much dearer the best chain is that passes elsewhere; NaN where the mode does not say.
    """

    positions: Array
    steps: Array
    match: Array
    gap: Array
    margin: Array
    hidden: NDArray[np.bool_]


def hidden_frames(match: Array, kin: Array) -> NDArray[np.bool_]:
    """Frames where something passes in front of the point: unlike the clicks, between two sudden changes.

    A look that changes little by little (a turning body) is not taken for it. ``match`` (m,) correlation with the
    clicks, ``kin`` (m,) with the frame before. Sure on things that pass in front; a limb that turns its far side
    to the camera is mostly not found.
    """
    frames, abrupt = len(match), kin < SUDDEN
    hidden = np.zeros(frames, bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], match < UNLIKE, [False]]).astype(int)))
    for first, after in zip(edges[::2], edges[1::2], strict=True):
        last = after - 1
        if abrupt[max(first - 1, 1) : first + 2].any() and abrupt[last : last + 3].any():
            hidden[first:after] = True
    return hidden
