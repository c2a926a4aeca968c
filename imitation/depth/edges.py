# mypy: disable-error-code="untyped-decorator"
"""Where exactly a near surface ends: pixels beside a step of depth go to the side that other frames bear out.

A sweep compares windows, and a window over an edge sees the near surface on both sides of it: that surface comes out a
pixel or two too wide. Here single pixels are compared, at the depths of either side, and pixels of one colour decide
together.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.colours import gains
from imitation.depth.sweep import geometry
from imitation.geometry.projection import Camera

REACH = 3  # pixels from a step
STEEP = 0.03  # relative depth that is one
SHARE = 0.5  # of the frames that see a place, the best: in the others it may be hidden
CUT = 30.0  # levels from which a difference is as bad as can be
COLOUR, AWAY = 12.0, 2.0  # levels and pixels over which a neighbour's word falls off to a third
STAY = 5.0  # levels that a side has in advance where all pixels round it of its colour are on it
CLEAR = 2.0  # levels by which one side must be better for anything to change


def with_edges(
    inverse: NDArray[np.float32],
    picture: NDArray[np.uint8],
    hidden: NDArray[np.uint8],
    settled: NDArray[np.bool_],
    camera: Camera,
    stack: NDArray[np.uint8],
    hidden_there: NDArray[np.uint8],
    poses: Sequence[Camera],
) -> NDArray[np.float32]:
    """Inverse depth (h, w) with steps where the pictures have them.

    Parameters
    ----------
    inverse : (h, w), positive. picture : (h, w, 3). hidden : (h, w) 1 where the subject is; it stays as it is.
    settled : (h, w) what must not change sides: single pixels of plain surfaces say nothing.
    stack, hidden_there, poses : (k, h, w, 3), (k, h, w) and the cameras of other frames.
    """
    import cv2

    maps = geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in poses])
    scale = gains(picture, hidden > 0, inverse, camera, stack, hidden_there, poses)
    sides = np.zeros((2, *inverse.shape), np.float32)
    costs = np.zeros((2, *inverse.shape), np.float32)
    _weigh(inverse, picture, hidden, settled, maps.A, maps.b, stack, hidden_there, scale, sides, costs)
    result = inverse.copy()
    _decide(inverse, cv2.medianBlur(picture, 3), sides, costs, result)
    return result


@njit(cache=True, nogil=True, error_model="numpy")
def _sides(inverse: Any, hidden: Any, y: int, x: int) -> Any:
    """Inverse depths (near, far) of both sides of a step near a pixel: its own and the nearest other; 0 without one."""
    height, width = inverse.shape
    top, bottom = max(0, y - REACH), min(height, y + REACH + 1)
    left, right = max(0, x - REACH), min(width, x + REACH + 1)
    low = high = inverse[y, x]
    for j in range(top, bottom):
        for i in range(left, right):
            if hidden[j, i] == 0:
                low, high = min(low, inverse[j, i]), max(high, inverse[j, i])
    if high - low < np.float32(STEEP) * high:
        return np.float32(0), np.float32(0)
    middle = (low + high) / 2
    near = inverse[y, x] > middle
    other, least = np.float32(0), 1 << 20
    for j in range(top, bottom):
        for i in range(left, right):
            away = (j - y) * (j - y) + (i - x) * (i - x)
            if hidden[j, i] == 0 and (inverse[j, i] > middle) != near and away < least:
                other, least = inverse[j, i], away
    return (inverse[y, x], other) if near else (other, inverse[y, x])


@njit(cache=True, nogil=True, error_model="numpy")
def _disagreement(x: int, y: int, w: Any, colour: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any,
                  work: Any) -> Any:  # fmt: skip
    """Mean difference from a pixel's colour, levels, in the best of the frames that see an inverse depth at it."""
    count = 0
    height, width = stack.shape[1], stack.shape[2]
    for n in range(stack.shape[0]):
        z = A[n, 2, 0] * x + A[n, 2, 1] * y + A[n, 2, 2] + w * b[n, 2]
        if z <= 0:
            continue
        u = (A[n, 0, 0] * x + A[n, 0, 1] * y + A[n, 0, 2] + w * b[n, 0]) / z
        v = (A[n, 1, 0] * x + A[n, 1, 1] * y + A[n, 1, 2] + w * b[n, 1]) / z
        if not (u >= 0 and v >= 0 and u < width - 1.001 and v < height - 1.001):
            continue
        iu, iv = int(u), int(v)
        if hidden[n, iv, iu] or hidden[n, iv, iu + 1] or hidden[n, iv + 1, iu] or hidden[n, iv + 1, iu + 1]:
            continue
        q, r = np.float32(u - iu), np.float32(v - iv)
        apart = np.float32(0)
        for c in range(3):
            above = (1 - q) * stack[n, iv, iu, c] + q * stack[n, iv, iu + 1, c]
            below = (1 - q) * stack[n, iv + 1, iu, c] + q * stack[n, iv + 1, iu + 1, c]
            apart += abs(((1 - r) * above + r * below) * scale[n, c] - np.float32(colour[c]))
        apart = min(apart / 3, np.float32(CUT))
        i = count
        while i > 0 and work[i - 1] > apart:
            work[i] = work[i - 1]
            i -= 1
        work[i] = apart
        count += 1
    if count == 0:
        return np.float32(CUT)
    used = max(1, int(np.ceil(SHARE * count)))
    return work[:used].mean()


@njit(cache=True, nogil=True, error_model="numpy")
def _weigh(
    inverse: Any, picture: Any, hidden: Any, settled: Any, A: Any, b: Any, stack: Any, hidden_there: Any, scale: Any,
    sides: Any, costs: Any,
) -> None:  # fmt: skip
    """Fill in what both sides of a step would be at each pixel near one, and how badly other frames bear them out."""
    height, width = inverse.shape
    work = np.empty(stack.shape[0], np.float32)
    for y in range(height):
        for x in range(width):
            if hidden[y, x] or settled[y, x]:
                continue
            sides[0, y, x], sides[1, y, x] = _sides(inverse, hidden, y, x)
            if sides[0, y, x] > 0:
                for k in range(2):
                    costs[k, y, x] = _disagreement(
                        x, y, sides[k, y, x], picture[y, x], A, b, stack, hidden_there, scale, work
                    )


@njit(cache=True, nogil=True, error_model="numpy")
def _decide(inverse: Any, picture: Any, sides: Any, costs: Any, result: Any) -> None:
    height, width = inverse.shape
    for y in range(height):
        for x in range(width):
            near, far = sides[0, y, x], sides[1, y, x]
            if near <= 0:
                continue
            better, votes, total = 0.0, 0.0, 0.0
            for j in range(max(0, y - REACH), min(height, y + REACH + 1)):
                for i in range(max(0, x - REACH), min(width, x + REACH + 1)):
                    apart = 0.0
                    for c in range(3):
                        apart = max(apart, abs(np.float64(picture[j, i, c]) - picture[y, x, c]))
                    weight = np.exp(-apart / COLOUR - np.sqrt((j - y) ** 2 + (i - x) ** 2) / AWAY)
                    total += weight
                    votes += weight if inverse[j, i] > (near + far) / 2 else -weight
                    if sides[0, j, i] > 0:
                        better += weight * (costs[1, j, i] - costs[0, j, i])
            if abs(better) >= CLEAR * total:
                result[y, x] = near if better + STAY * votes > 0 else far
