# mypy: disable-error-code="untyped-decorator"
"""Semi-global matching (Hirschmueller 2008): smooth along eight paths, cheaper where the picture has an edge."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.sweep import bands
from imitation.progress import Progress, silent

SMALL, LARGE, LEAST = 14, 800, 60  # penalties of a step of one plane, and of a larger one: at no edge, at least
FINE = 0.3  # planes a pixel of the picture's width: where there are more, slanted ground makes larger steps
SOFTENING = 8.0  # grey levels over which the larger penalty halves
_FAR = 8000  # no path comes from outside the volume


def semiglobal(
    volume: NDArray[np.uint8],
    picture: NDArray[np.uint8],
    *,
    small: int = SMALL,
    large: int = LARGE,
    least: int = LEAST,
    progress: Progress = silent,
) -> NDArray[np.float32]:
    """Choose a plane for every pixel.

    Parameters
    ----------
    volume : (h, w, d) cost of each plane.
    picture : (h, w, 3); how much two pixels differ is told by the channel that differs most: the edge of a box before
        a wall as bright as it, but of another colour, is one.
    progress : gets fractions every few rows; may raise ``Cancelled``.

    Returns
    -------
    float32 (h, w) index of the best plane, with a parabola's fraction.
    """
    steps = np.arange(256, dtype=np.float64)
    fine = min(1.0, FINE * max(volume.shape[:2]) / volume.shape[2]) ** 1.5
    table = np.maximum(fine * large / (1 + steps / SOFTENING), least).round().astype(np.int16)
    total = np.zeros(volume.shape, np.uint16)
    height, width, depth = volume.shape
    for half, backward in enumerate((False, True)):
        # Two rows of path costs for the three paths from the row before.
        rows = np.full((2, 3, width, depth + 2), _FAR, np.int16)
        lowest = np.zeros((2, 3, width), np.int16)
        for first, last in bands(height):
            progress(0.5 * half + 0.5 * first / height)
            _paths(volume, picture, np.int16(small), table, total, backward, rows, lowest, first, last)
    plane = np.empty(volume.shape[:2], np.float32)
    _choose(total, plane)
    return plane


@njit(cache=True, nogil=True, error_model="numpy")
def _step(cost: Any, before: Any, least: Any, small: Any, large: Any, after: Any, total: Any) -> Any:
    """One pixel further along a path (all but the ends of ``before`` and ``after`` are planes); its least cost."""
    depth = cost.shape[0]
    jump = np.int16(least + large)
    lowest = np.int16(32767)
    for d in range(depth):
        aside = np.int16(min(before[d], before[d + 2]) + small)
        best = min(min(before[d + 1], aside), jump)
        value = np.int16(np.int16(cost[d]) + np.int16(best - least))
        after[d + 1] = value
        total[d] += np.uint16(value)
        lowest = min(lowest, value)
    return lowest


@njit(cache=True, nogil=True, error_model="numpy")
def _apart(one: Any, other: Any) -> Any:
    """How many levels two colours differ by, in the channel that differs most."""
    red, green, blue = (abs(np.int64(one[0]) - other[0]), abs(np.int64(one[1]) - other[1]),
                        abs(np.int64(one[2]) - other[2]))  # fmt: skip
    return max(red, green, blue)


@njit(cache=True, nogil=True, error_model="numpy")
def _paths(
    volume: Any, picture: Any, small: Any, table: Any, total: Any, backward: bool, rows: Any, lowest: Any, first: int,
    end: int,
) -> None:  # fmt: skip
    """Four of the eight paths: along the row, and from the row before, straight and both ways aslant."""
    height, width, depth = volume.shape
    # Path costs of two pixels for the path along the row.
    along = np.full((2, depth + 2), _FAR, np.int16)
    start = np.zeros(depth + 2, np.int16)
    way = -1 if backward else 1
    for k in range(first, end):
        y = height - 1 - k if backward else k
        now, last = k % 2, 1 - k % 2
        least = np.int16(0)
        for j in range(width):
            x = width - 1 - j if backward else j
            cost, sums, colour = volume[y, x], total[y, x], picture[y, x]
            here, before = along[j % 2], along[1 - j % 2]
            if j == 0:
                least = _step(cost, start, np.int16(0), small, np.int16(0), here, sums)
            else:
                edge = table[_apart(colour, picture[y, x - way])]
                least = _step(cost, before, least, small, edge, here, sums)
            for p in range(3):
                source = x + p - 1
                if k == 0 or source < 0 or source >= width:
                    lowest[now, p, x] = _step(cost, start, np.int16(0), small, np.int16(0), rows[now, p, x], sums)
                else:
                    large = table[_apart(colour, picture[y - way, source])]
                    lowest[now, p, x] = _step(
                        cost, rows[last, p, source], lowest[last, p, source], small, large, rows[now, p, x], sums
                    )


@njit(cache=True, nogil=True, error_model="numpy")
def _choose(total: Any, plane: Any) -> None:
    height, width, depth = total.shape
    for y in range(height):
        for x in range(width):
            sums = total[y, x]
            best = 0
            for d in range(1, depth):
                if sums[d] < sums[best]:
                    best = d
            value = float(best)
            if 0 < best < depth - 1:
                before, here, after = float(sums[best - 1]), float(sums[best]), float(sums[best + 1])
                bend = before - 2 * here + after
                if bend > 0:
                    value += 0.5 * (before - after) / bend
            plane[y, x] = value
