"""Feature vectors of a sequence: one histogram a frame, and what is needed to compare them."""

from __future__ import annotations

from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

Method = Literal["robust", "paper"]


@attrs.frozen(eq=False)
class Features:
    """Histograms of a sequence.

    Attributes
    ----------
    method : "robust" or "paper"
    histograms : (n, d) float32 or (n, 10, 6, 24) float32
        "paper": shares of the bins of r, theta and phi, one after another (eq. 1 and 4).
        "robust": square roots of shares over height, radius and azimuth; the squares of a frame sum to 1.
    parts : tuple of int
        "paper": how many bins r, theta and phi have. "robust": (10, 6, 24).
    origin : (3,) float64
        "paper": the origin of the spherical coordinates. "robust": (0, 0, z of the ground).
    height : float
        Body height that the robust histogram's lengths are divided by; 0 for "paper".
    """

    method: Method
    histograms: NDArray[np.float32]
    parts: tuple[int, ...]
    origin: NDArray[np.float64]
    height: float = 0.0

    def __len__(self) -> int:
        return len(self.histograms)
