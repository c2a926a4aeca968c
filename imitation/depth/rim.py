# mypy: disable-error-code="untyped-decorator"
"""What is thin and stands before a subject: it parts the mask, and the mask's rim must not swallow it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.boxes import box_round

MARGIN = 2.5  # pixels at a width of 960 beside a mask that hold some of the subject
EDGE = 0.8  # the same where the colour says that it is not the subject
ALIKE = 40.0  # grey levels, the worst channel, that a thin thing's edge differs from its middle
NEAR = 4  # pixels: so far from the rim depth is taken over
LEVEL = 2.0  # grey levels that are worth a pixel of way
ROUNDS = 4


def between_parts(
    picture: NDArray[np.uint8], mask: NDArray[np.uint8], hidden: NDArray[np.uint8], radius: float
) -> NDArray[np.bool_]:
    """The part of a mask's rim (h, w) that lies between two parts of the mask and that the frame itself shows.

    A post before the subject parts its mask; were its rim taken from both sides, nothing of a thin post would be left.

    Parameters
    ----------
    picture : uint8 (h, w, 3). mask : 1 on the subject. hidden : 1 on the subject and its rim.
    radius : width of the rim, pixels.
    """
    spared = np.zeros(mask.shape, bool)
    reach, scale = round(radius) + 2, max(mask.shape) / 960
    box = box_round(hidden, 4 * reach)  # nothing farther away than the colours' mean reaches has a say
    if box is None or not mask.any():
        return spared
    spared[box] = _between(picture[box], mask[box], hidden[box], reach, scale)
    return spared


def _between(
    picture: NDArray[np.uint8], mask: NDArray[np.uint8], hidden: NDArray[np.uint8], reach: int, scale: float
) -> NDArray[np.bool_]:
    import cv2

    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    padded = cv2.copyMakeBorder(mask, reach, reach, reach, reach, cv2.BORDER_CONSTANT, value=0)
    closed = cv2.morphologyEx(padded, cv2.MORPH_CLOSE, disc)[reach:-reach, reach:-reach]
    rim = (mask == 0) & (hidden > 0)
    away = cv2.distanceTransform(1 - mask, cv2.DIST_L2, 5)
    between: NDArray[np.bool_] = rim & (closed > 0) & (away > max(1.5, MARGIN * scale))
    if not between.any():
        return between
    # Its edges, and where it leaves the rim, are of the colour that it has between.
    smooth, sure = picture.astype(np.float32), between.astype(np.float32)
    share = cv2.GaussianBlur(sure, (0, 0), reach)
    colour = cv2.GaussianBlur(smooth * sure[..., None], (0, 0), reach) / np.maximum(share, 1e-4)[..., None]
    alike = np.abs(smooth - colour).max(axis=-1) < ALIKE
    more = rim & alike & (share > 0.01) & (away > EDGE * scale)
    grown: NDArray[np.bool_] = between | (cv2.medianBlur((more | between).astype(np.uint8), 3) > 0) & rim
    return grown


def depth_along(
    inverse: NDArray[np.float32], picture: NDArray[np.uint8], rim: NDArray[np.bool_], wanted: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """Inverse depth (h, w) with that of the wanted pixels taken from outside the rim, along what looks alike.

    A post is as far within the rim as above and below it, and the way along it costs less than the way across its edge.

    Parameters
    ----------
    inverse : 0 where none. picture : uint8 (h, w, 3). rim, wanted : bool (h, w), the second within the first.
    """
    import cv2

    if not wanted.any():
        return inverse
    rows, columns = np.nonzero(rim)
    high, wide = rim.shape
    top, bottom = max(0, rows.min() - NEAR), min(high, rows.max() + NEAR + 1)
    left, right = max(0, columns.min() - NEAR), min(wide, columns.max() + NEAR + 1)
    box = slice(top, bottom), slice(left, right)
    near = cv2.dilate(rim[box].astype(np.uint8), np.ones((2 * NEAR + 1, 2 * NEAR + 1), np.uint8)) > 0
    seeds = near & ~rim[box] & (inverse[box] > 0)
    smooth = cv2.GaussianBlur(picture[box], (0, 0), 0.8).astype(np.float32)
    found = np.where(seeds, inverse[box], np.float32(0))
    _spread(smooth, near, np.where(seeds, np.float32(0), np.float32(1e9)), found, np.float32(1 / LEVEL), ROUNDS)
    made = inverse.copy()
    taken = wanted[box] & (found > 0)
    made[box][taken] = found[taken]
    return made


@njit(cache=True, nogil=True, error_model="numpy")
def _spread(smooth: Any, area: Any, cost: Any, values: Any, per_level: Any, rounds: int) -> None:
    """Carry values from where the cost is 0 through an area, along the cheapest ways: sweeps to and fro."""
    height, width = cost.shape
    for turn in range(2 * rounds):
        step = 1 if turn % 2 == 0 else -1
        for row in range(height):
            y = row if step == 1 else height - 1 - row
            for column in range(width):
                x = column if step == 1 else width - 1 - column
                if not area[y, x] or cost[y, x] == 0:
                    continue
                for k in range(4):
                    j = y if k == 0 else y - step
                    i = x - step if k == 0 else x - step + (k - 1) * step
                    if j < 0 or i < 0 or j >= height or i >= width or not area[j, i] or cost[j, i] > np.float32(1e8):
                        continue
                    apart = np.float32(0)
                    for c in range(3):
                        apart = max(apart, abs(smooth[y, x, c] - smooth[j, i, c]))
                    way = cost[j, i] + np.float32(1) + per_level * apart
                    if way < cost[y, x]:
                        cost[y, x] = way
                        values[y, x] = values[j, i]
