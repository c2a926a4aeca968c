"""Pictures and depths with holes: resized, voted, seamed and carried on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from imitation.depth.boxes import box_round

SEAM = 1.5  # pixels over which the fill blends into the frame, at a width of 960
AROUND = 5  # pixels: from so far away a place is painted in


def nearest_of(values: NDArray[Any], size: tuple[int, int]) -> NDArray[Any]:
    """Values (h, w) at another size: each pixel takes the nearest one's."""
    import cv2

    if values.shape == size[::-1]:
        return values
    made: NDArray[Any] = cv2.resize(values, size, interpolation=cv2.INTER_NEAREST_EXACT)
    return made


def touched(wanted: NDArray[np.bool_], size: tuple[int, int]) -> NDArray[np.bool_]:
    """Which pixels of a smaller size hold anything of what is wanted."""
    import cv2

    if wanted.shape == size[::-1]:
        return wanted
    touched: NDArray[np.bool_] = cv2.resize(wanted.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0
    return touched


def voted(
    inverse: NDArray[np.float32],
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    size: tuple[int, int],
    tolerance: float,
) -> NDArray[np.float32]:
    """Take single pixels that stand out from their surroundings back into them: the median of 5 x 5 known ones."""
    import cv2

    picture = np.zeros(size[::-1], np.float32)
    picture[rows, columns] = inverse
    middle = cv2.medianBlur(picture, 5)[rows, columns]
    stray = (inverse > 0) & (middle > 0) & (np.abs(inverse - middle) > 2 * tolerance)
    empty = (inverse <= 0) & (middle > 0)
    return np.where(stray | empty, middle, inverse).astype(np.float32)


def painted(picture: NDArray[np.uint8], invented: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """A picture (h, w, 3) painted in from around where nothing is known of it (Telea 2004)."""
    import cv2

    box = box_round(invented, 4 * AROUND)  # nothing farther away has a say
    if box is None:
        return picture
    made = picture.copy()
    made[box] = cv2.inpaint(
        np.ascontiguousarray(picture[box]), invented[box].astype(np.uint8), AROUND, cv2.INPAINT_TELEA
    )
    return made


def seamless(picture: NDArray[np.uint8], filled: NDArray[np.uint8], hole: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Blend a fill into the frame along the hole's rim, inside the hole."""
    import cv2

    # Nothing happens elsewhere; the known pixels right beside the hole are what distances are taken to.
    box = box_round(hole, 1)
    if box is None:
        return picture
    inside = cv2.distanceTransform(hole[box].astype(np.uint8), cv2.DIST_L2, 3)
    width = SEAM * max(hole.shape) / 960
    alpha = np.clip(inside / width, 0, 1)[..., None]
    mixed = picture.copy()
    mixed[box] = np.rint(picture[box] + alpha * (filled[box].astype(np.float32) - picture[box])).astype(np.uint8)
    return mixed


def extended(inverse: NDArray[np.float32], hole: NDArray[np.bool_], weak: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Depth where no view has any: from around, smoothly.

    What is ``weak``, confirmed by no other frame, stays but is not carried on: beside a hole it is often a guess.
    """
    import cv2

    missing = hole | (inverse <= 0)
    if not missing.any() or missing.all():
        return inverse
    silent = missing if (missing | weak).all() else missing | weak
    known = np.where(silent, 0, inverse).astype(np.float32)
    weight = (~silent).astype(np.float32)
    result = np.where(missing, 0, inverse).astype(np.float32)
    open_ = missing.copy()
    radius = 2.0
    while open_.any() and radius < 4 * max(inverse.shape):
        total, share = cv2.GaussianBlur(known, (0, 0), radius), cv2.GaussianBlur(weight, (0, 0), radius)
        here = open_ & (share > 0.02)
        result[here] = total[here] / share[here]
        open_ &= ~here
        radius *= 2
    return result
