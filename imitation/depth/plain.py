# mypy: disable-error-code="untyped-decorator"
"""Planes for surfaces of one colour, whose pixels tell too little of their depth one by one.

On a plain wall noise decides, and what stands before it spreads over it. All pixels of the wall together do tell: the
plane whose costs are least over the whole of it is taken, unless they are clearly worse than what was found before.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

EVEN = 6  # levels, the worst channel, that three neighbouring pixels of a plain surface differ by at most
ALIKE = 8.0  # levels by which its rim may differ from the pixel beside it
STEP = 3  # the same of five, within one part of a surface that is no plane as a whole
RIM = 2  # pixels that smoothing has taken off
SMALLEST = 60  # pixels of a surface, at a width of 480
TRIED = 60  # planes through three of its pixels
ASKED = 6000  # pixels of a surface that are asked at most
WORSE = 5.0  # levels of cost (0 to 255): single pixels fit their noise, so that a plane always costs a little more
STEEPEST = 3.0  # planes of the search per pixel
WIDEST, NARROWEST = 5, 3  # pixels that a surface must at least extend over


def plain_surfaces(picture: NDArray[np.uint8], hidden: NDArray[np.uint8]) -> tuple[NDArray[np.int32], int]:
    """Number the connected surfaces of one colour (h, w), 0 where there is none; how many there are.

    Parameters
    ----------
    picture : (h, w, 3). hidden : (h, w) 1 where the subject is.
    """
    import cv2

    shown = hidden == 0
    smooth = np.where(shown[..., None], picture, np.uint8(128))
    for sigma in (14, 10):
        smooth = cv2.bilateralFilter(smooth, 7, sigma, 2.5)
    kernel = np.ones((3, 3), np.uint8)
    uneven = cv2.absdiff(cv2.dilate(smooth, kernel), cv2.erode(smooth, kernel)).max(axis=-1)
    names, count = _numbered((uneven <= EVEN) & shown, max(hidden.shape))
    return _with_rims(names, smooth, shown), count


def parts_of(names: NDArray[np.int32], picture: NDArray[np.uint8]) -> tuple[NDArray[np.int32], int]:
    """Number the parts (h, w) of surfaces between which colours step by a few levels; how many there are.

    A side of a box may be nearly of the colour of the wall behind it: smoothing joins the two across their edge. A
    median keeps the step.

    Parameters
    ----------
    names : (h, w) above 0 on the surfaces. picture : (h, w, 3).
    """
    import cv2

    parts = np.zeros_like(names)
    rows, columns = np.flatnonzero(names.any(axis=1)), np.flatnonzero(names.any(axis=0))
    if not len(rows):
        return parts, 0
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    shown = names[box] > 0
    calm = np.where(shown[..., None], picture[box], np.uint8(128))
    for _ in range(3):
        calm = cv2.medianBlur(calm, 5)
    kernel = np.ones((2 * RIM + 1, 2 * RIM + 1), np.uint8)
    uneven = cv2.absdiff(cv2.dilate(calm, kernel), cv2.erode(calm, kernel)).max(axis=-1)
    found, count = _numbered((uneven <= STEP) & shown, max(names.shape))
    parts[box] = _with_rims(found, calm, shown, STEP)
    return parts, count


def _numbered(even: NDArray[np.bool_], longest: int) -> tuple[NDArray[np.int32], int]:
    """The connected areas (h, w) that are large enough in a picture so long, from 1; how many there are."""
    import cv2

    count, found, statistics, _ = cv2.connectedComponentsWithStats(even.astype(np.uint8), connectivity=4)
    least = SMALLEST * (longest / 480) ** 2
    kept = np.zeros(count, np.int32)
    large = np.flatnonzero(statistics[1:, cv2.CC_STAT_AREA] >= least) + 1
    kept[large] = np.arange(1, len(large) + 1)
    names: NDArray[np.int32] = kept[found]
    return names, len(large)


def _with_rims(
    names: NDArray[np.int32], smooth: NDArray[np.uint8], shown: NDArray[np.bool_], alike: float = ALIKE
) -> NDArray[np.int32]:
    """Give pixels beside a surface to it where they are of its colour."""
    colour = smooth.astype(np.int16)
    for _ in range(RIM):
        for axis, way in ((1, 1), (1, -1), (0, 1), (0, -1)):
            name, beside = np.roll(names, way, axis), np.roll(colour, way, axis)
            end = [slice(None), slice(None)]
            end[axis] = slice(0, 1) if way > 0 else slice(-1, None)
            name[tuple(end)] = 0  # nothing comes from the other side of the picture
            taken = (names == 0) & (name > 0) & shown & (np.abs(beside - colour).max(axis=-1) <= alike)
            names = np.where(taken, name, names)
            colour = np.where(taken[..., None], beside, colour)
    return names


def with_planes(
    plane: NDArray[np.float32],
    volume: NDArray[np.uint8],
    picture: NDArray[np.uint8],
    hidden: NDArray[np.uint8],
    apart: float = 0.0,
) -> NDArray[np.float32]:
    """Lay plain surfaces onto planes.

    Parameters
    ----------
    plane : (h, w) index into the search's depths, with fractions; evenly spaced in inverse depth, so that the picture
        of a plane is linear in it. volume : (h, w, d) costs. picture, hidden : see ``plain_surfaces``.
    apart : what lies nearer to its plane than this, in steps of the search, stays as it is.
    """
    names, count = plain_surfaces(picture, hidden)
    result = plane.copy()
    refused = _lay(result, plane, volume, names, count, apart)
    if refused.any():
        # What is no plane may be two surfaces of nearly one colour.
        _lay(result, plane, volume, *parts_of(np.where(refused, names, 0), picture), apart)
    return result


def _lay(
    result: NDArray[np.float32],
    plane: NDArray[np.float32],
    volume: NDArray[np.uint8],
    names: NDArray[np.int32],
    count: int,
    apart: float,
) -> NDArray[np.bool_]:
    """Lay numbered surfaces onto planes, in place; which pixels (h, w) belong to one that is none."""
    refused = np.zeros(names.shape, bool)
    if not count:
        return refused
    order = np.argsort(names, axis=None, kind="stable")
    ends = np.searchsorted(names.ravel()[order], np.arange(1, count + 2))
    random = np.random.default_rng(0)
    last = np.float64(volume.shape[2] - 1)
    for first, end in pairwise(ends):
        rows, columns = np.unravel_index(order[first:end], names.shape)
        if np.ptp(columns) < WIDEST or np.ptp(rows) < NARROWEST:
            continue
        step = -(-len(rows) // ASKED)
        y, x = np.ascontiguousarray(rows[::step]), np.ascontiguousarray(columns[::step])
        own = _cost_found(volume, x, y, plane)
        corners = random.integers(0, len(x), (TRIED, 3))
        best, cost = _fit(volume, x, y, plane, corners)
        if cost > own + WORSE:
            refused[rows, columns] = True
            continue
        laid = np.clip(best[0] + best[1] * columns + best[2] * rows, 0, last)
        found = plane[rows, columns]
        result[rows, columns] = np.where(np.abs(laid - found) >= apart, laid, found)
    return refused


@njit(cache=True, nogil=True, error_model="numpy")
def _between(costs: Any, d: Any) -> Any:
    low = int(d)
    part = d - low
    return (1 - part) * costs[low] + part * costs[low + 1]


@njit(cache=True, nogil=True, error_model="numpy")
def _cost_found(volume: Any, x: Any, y: Any, plane: Any) -> float:
    """Mean cost of what was found, pixel by pixel."""
    end = volume.shape[2] - 1.001
    total = 0.0
    for k in range(len(x)):
        total += _between(volume[y[k], x[k]], min(max(plane[y[k], x[k]], 0.0), end))
    return total / len(x)


@njit(cache=True, nogil=True, error_model="numpy")
def _cost(volume: Any, x: Any, y: Any, level: float, across: float, down: float) -> float:
    """Mean cost of a plane; as bad as can be where it leaves the search."""
    end = volume.shape[2] - 1.001
    total = 0.0
    for k in range(len(x)):
        d = level + across * x[k] + down * y[k]
        total += _between(volume[y[k], x[k]], d) if 0 <= d <= end else 255.0
    return total / len(x)


@njit(cache=True, nogil=True, error_model="numpy")
def _fit(volume: Any, x: Any, y: Any, plane: Any, corners: Any) -> Any:
    """The plane (level, across, down) of least cost, and its cost: the best through three pixels, then step by step."""
    best = np.zeros(3)
    least = 1e9
    for k in range(corners.shape[0]):
        a, b, c = corners[k, 0], corners[k, 1], corners[k, 2]
        w = np.float64(plane[y[a], x[a]])
        x1, y1, w1 = x[b] - x[a], y[b] - y[a], plane[y[b], x[b]] - w
        x2, y2, w2 = x[c] - x[a], y[c] - y[a], plane[y[c], x[c]] - w
        area = x1 * y2 - x2 * y1
        if abs(area) < 20:
            continue
        across, down = (w1 * y2 - w2 * y1) / area, (x1 * w2 - x2 * w1) / area
        if max(abs(across), abs(down)) > STEEPEST:
            continue
        level = w - across * x[a] - down * y[a]
        cost = _cost(volume, x, y, level, across, down)
        if cost < least:
            least = cost
            best[:] = level, across, down
    if least > 255:
        return best, least
    # Turned about its middle, a step moves its ends by as much as its middle.
    mx, my = x.mean(), y.mean()
    wide, high = max(3.0, 1.7 * x.std()), max(3.0, 1.7 * y.std())
    now = np.array([best[0] + best[1] * mx + best[2] * my, best[1], best[2]])
    step = 1.0
    while step > 0.05:
        moved = False
        for k in range(6):
            to = now.copy()
            i = k // 2
            size = step if i == 0 else (step / wide if i == 1 else step / high)
            to[i] += size if k % 2 == 0 else -size
            cost = _cost(volume, x, y, to[0] - to[1] * mx - to[2] * my, to[1], to[2])
            if cost < least - 1e-6:
                least = cost
                now, moved = to, True
        if not moved:
            step /= 2
    best[:] = now[0] - now[1] * mx - now[2] * my, now[1], now[2]
    return best, least
