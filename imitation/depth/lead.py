# mypy: disable-error-code="untyped-decorator"
"""What the other maps say of a frame's depth, as part of the cost of its planes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

WORTH = 0.4  # share of a cost that the other maps decide, where all of them speak


def lead(volume: NDArray[np.uint8], layers: NDArray[np.float32], planes: NDArray[np.float32], spread: float) -> None:
    """Make planes dearer, in place, that other maps do not show.

    Unlike the prior within the sweep, which judges a view's samples by that view's own map, this lets every map speak
    and so averages the errors of single poses.

    Parameters
    ----------
    volume : (h, w, d) costs. layers : (k, h, w) inverse depth that the other maps bring to this frame, 0 where none.
    planes : (d,) inverse depths. spread : planes over which a map's word falls off.
    """
    first, step = float(planes[0]), float(planes[1] - planes[0])
    reach = int(np.ceil(3 * spread))
    _lead(volume, layers, np.float32(first), np.float32(step), np.float32(1 / (2 * spread * spread)), reach,
          np.float32(255 * WORTH))  # fmt: skip


@njit(cache=True, nogil=True, error_model="numpy")
def _lead(volume: Any, layers: Any, first: Any, step: Any, tight: Any, reach: int, worth: Any) -> None:
    height, width, depth = volume.shape
    count = layers.shape[0]
    support = np.zeros(depth, np.float32)
    for y in range(height):
        for x in range(width):
            support[:] = 0
            number = 0
            for k in range(count):
                w = layers[k, y, x]
                if w <= 0:
                    continue
                number += 1  # a map whose word lies outside the planes speaks against all of them
                place = (w - first) / step
                middle = int(place + np.float32(0.5))
                for d in range(max(0, middle - reach), min(depth, middle + reach + 1)):
                    away = np.float32(d) - place
                    support[d] += np.exp(-away * away * tight)
            if number == 0:
                continue
            # One map alone may be wrong: its word counts for less.
            share = worth * np.float32(number) / np.float32(number + 2)
            scale = (np.float32(255) - share) / np.float32(255)
            for d in range(depth):
                cost = np.float32(volume[y, x, d]) * scale + share * (1 - support[d] / number)
                volume[y, x, d] = np.uint8(cost + np.float32(0.5))
