# mypy: disable-error-code="untyped-decorator"
"""Planes for surfaces of one colour, whose pixels tell too little of their depth one by one.

On a plain wall noise decides, and what stands before it spreads over it. All pixels of the wall together do tell: the
plane whose costs are least over the whole of it is taken, unless they are clearly worse than what was found before.
Where a part of slightly other colour is clearly off that plane, the top of a box before a wall of its colour, it gets
one of its own.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.boxes import box_round

EVEN = 6  # levels, the worst channel, that three neighbouring pixels of a plain surface differ by at most
ALIKE = 8.0  # levels by which its rim may differ from the pixel beside it
STEP = 3  # the same of five, within one part of a surface that is no plane as a whole
RIM = 2  # pixels that smoothing has taken off
SMALLEST = 60  # pixels of a surface, at a width of 480
CORE = 40  # the same of the inner of one part of it, that no step is near
TRIED = 60  # planes through three of its pixels
ASKED = 6000  # pixels of a surface that are asked at most
WORSE = 5.0  # levels of cost (0 to 255): single pixels fit their noise, so that a plane always costs a little more
STRAY = 2 * WORSE  # the same for one part of a surface, fewer pixels than the whole
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
    names, count = _numbered((uneven <= EVEN) & shown, _least(hidden.shape))
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
    box = box_round(names)
    if box is None:
        return parts, 0
    shown = names[box] > 0
    calm = np.where(shown[..., None], picture[box], np.uint8(128))
    for _ in range(3):
        calm = cv2.medianBlur(calm, 5)
    kernel = np.ones((2 * RIM + 1, 2 * RIM + 1), np.uint8)
    uneven = cv2.absdiff(cv2.dilate(calm, kernel), cv2.erode(calm, kernel)).max(axis=-1)
    # A strip of a few rows has a core of one or two: it is with its rims that a part must be large enough.
    found, _ = _numbered((uneven <= STEP) & shown, CORE * (max(names.shape) / 480) ** 2)
    for alike in (STEP, EVEN, ALIKE):
        found = _with_rims(found, calm, shown, alike)
    sizes = np.bincount(found.ravel())
    large = np.flatnonzero(sizes[1:] >= _least(names.shape)) + 1
    kept = np.zeros(len(sizes), np.int32)
    kept[large] = np.arange(1, len(large) + 1)
    parts[box] = kept[found]
    return parts, len(large)


def _least(shape: tuple[int, ...]) -> float:
    """Pixels of a surface, at least, in a picture (h, w)."""
    return SMALLEST * (max(shape) / 480) ** 2


def _numbered(even: NDArray[np.bool_], least: float) -> tuple[NDArray[np.int32], int]:
    """The connected areas (h, w) of at least so many pixels, from 1; how many there are."""
    import cv2

    count, found, statistics, _ = cv2.connectedComponentsWithStats(even.astype(np.uint8), connectivity=4)
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
    if not count:
        return result
    parts = _parted(names, parts_of(names, picture)[0])
    # What is no plane, or of which a part is not on it, may be two surfaces of nearly one colour.
    refused = _lay(result, plane, volume, names, apart, parts)
    if refused.any():
        _lay(result, plane, volume, np.where(refused, parts, 0), apart)
    return result


def _parted(names: NDArray[np.int32], parts: NDArray[np.int32]) -> NDArray[np.int32]:
    """Number the parts (h, w) of each surface for itself, 0 where there is none."""
    keys = np.where((names > 0) & (parts > 0), names.astype(np.int64) * (int(parts.max()) + 1) + parts, 0)
    numbered = np.unique(np.append(keys.ravel(), 0), return_inverse=True)[1][:-1]
    return numbered.reshape(names.shape).astype(np.int32)


def _lay(
    result: NDArray[np.float32],
    plane: NDArray[np.float32],
    volume: NDArray[np.uint8],
    names: NDArray[np.int32],
    apart: float,
    parts: NDArray[np.int32] | None = None,
) -> NDArray[np.bool_]:
    """Lay numbered surfaces onto planes, in place; which pixels (h, w) belong to one that is none.

    With ``parts`` (h, w), those of a surface that its plane explains badly are refused by themselves: on a large wall
    the small top of a box before it costs little, and would go with the wall. Without, the names are such parts.
    """
    refused = np.zeros(names.shape, bool)
    count = int(names.max(initial=0))
    order = np.argsort(names, axis=None, kind="stable")
    ends = np.searchsorted(names.ravel()[order], np.arange(1, count + 2))
    random = np.random.default_rng(0)
    last = np.float64(volume.shape[2] - 1)
    for first, end in pairwise(ends):
        rows, columns = np.unravel_index(order[first:end], names.shape)
        if not _extended(rows, columns):
            continue
        worse = STRAY if parts is None else WORSE
        best, fits = _plane_of(volume, rows, columns, plane, worse, random)
        if fits and parts is not None:
            stray = _strays(volume, rows, columns, plane, best, parts[rows, columns])
            if stray.any():
                refused[rows[stray], columns[stray]] = True
                rows, columns = rows[~stray], columns[~stray]
                if not _extended(rows, columns):
                    continue
                best, fits = _plane_of(volume, rows, columns, plane, worse, random)
        if not fits:
            refused[rows, columns] = True
            continue
        laid = np.clip(best[0] + best[1] * columns + best[2] * rows, 0, last)
        found = plane[rows, columns]
        result[rows, columns] = np.where(np.abs(laid - found) >= apart, laid, found)
    return refused


def _extended(rows: NDArray[np.int64], columns: NDArray[np.int64]) -> bool:
    """Whether pixels extend far enough to tell a plane."""
    return len(rows) > 0 and bool(np.ptp(columns) >= WIDEST and np.ptp(rows) >= NARROWEST)


def _plane_of(
    volume: NDArray[np.uint8],
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    plane: NDArray[np.float32],
    worse: float,
    random: np.random.Generator,
) -> tuple[NDArray[np.float64], bool]:
    """The plane (level, across, down) of least cost for pixels, and whether it is at most so much worse than found."""
    step = -(-len(rows) // ASKED)
    y, x = np.ascontiguousarray(rows[::step]), np.ascontiguousarray(columns[::step])
    best, cost = _fit(volume, x, y, plane, random.integers(0, len(x), (TRIED, 3)))
    return best, bool(cost <= _cost_found(volume, x, y, plane) + worse)


def _strays(
    volume: NDArray[np.uint8],
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    plane: NDArray[np.float32],
    best: NDArray[np.float64],
    part: NDArray[np.int32],
) -> NDArray[np.bool_]:
    """Which of a surface's pixels (k,) are of a part for which its plane costs clearly more than what was found."""
    stray = np.zeros(len(rows), bool)
    for name in np.unique(part[part > 0]):
        mine = part == name
        x, y = columns[mine], rows[mine]
        stray[mine] = _cost(volume, x, y, *best) > _cost_found(volume, x, y, plane) + STRAY
    return stray


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
