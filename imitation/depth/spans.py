"""Which planes of a search are worth trying where a place's depth is nearly known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

TILE = 16  # pixels: planes are chosen for so many together
AROUND = 8  # planes tried beyond the nearest and the farthest that is known
BESIDE = 4  # pixels round a tile whose depths count for it: the edge of a near surface may move into it


def every_plane(size: tuple[int, int], count: int) -> NDArray[np.int16]:
    """All planes for all tiles of a picture (width, height); see ``likely_planes``."""
    spans = np.zeros((-(-size[1] // TILE), -(-size[0] // TILE), 2), np.int16)
    spans[..., 1] = count
    return spans


def likely_planes(layers: NDArray[np.float32], planes: NDArray[np.float32]) -> NDArray[np.int16]:
    """First plane and plane after the last (tile rows, tile columns, 2) that a place may be on.

    Parameters
    ----------
    layers : (k, h, w) inverse depths that are known or guessed, 0 where none.
    planes : (d,) inverse depths, evenly spaced. A tile of which nothing is known may be on any of them.
    """
    import cv2

    known = layers > 0
    low = np.where(known, layers, np.float32(np.inf)).min(axis=0)
    high = layers.max(axis=0)
    kernel = np.ones((2 * BESIDE + 1, 2 * BESIDE + 1), np.uint8)
    low, high = cv2.erode(low, kernel), cv2.dilate(high, kernel)
    starts = tuple(np.arange(0, n, TILE) for n in low.shape)
    for axis, at in enumerate(starts):
        low, high = np.minimum.reduceat(low, at, axis), np.maximum.reduceat(high, at, axis)
    step = planes[1] - planes[0]
    spans = every_plane(layers.shape[:0:-1], len(planes))
    some = high > 0
    first = np.floor((low[some] - planes[0]) / step) - AROUND
    last = np.ceil((high[some] - planes[0]) / step) + AROUND + 1
    # What lies beyond the search is looked for at its end.
    spans[some, 0] = np.clip(first, 0, max(0, len(planes) - AROUND))
    spans[some, 1] = np.clip(last, min(AROUND, len(planes)), len(planes))
    return spans
