"""The part of a picture that a computation needs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def box_round(mask: NDArray[Any], margin: int = 0) -> tuple[slice, slice] | None:
    """Rows and columns of a picture (h, w) that hold what is marked, and so many pixels round it; None of nothing."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return None
    return (
        slice(max(0, int(rows[0]) - margin), int(rows[-1]) + margin + 1),
        slice(max(0, int(columns[0]) - margin), int(columns[-1]) + margin + 1),
    )
