"""What both modes give for a run of frames, before it is judged."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = tuple[float, float]


@attrs.frozen(eq=False)
class Chain:
    """A solved run of m frames, in the order of solving (away from the click where an end is open).

    Attributes
    ----------
    positions : (m, 2) pixels.
    steps : (m,) cost of the step into each frame, 0 in the first.
    match : (m,) correlation with the click that looks more alike; NaN where the mode does not say.
    gap : (m,) distance by which the flow there and back fails to return, pixels; NaN where the mode does not say.
    margin : (m,) how much dearer the best chain is that passes elsewhere; NaN where the mode does not say.
    """

    positions: Array
    steps: Array
    match: Array
    gap: Array
    margin: Array
