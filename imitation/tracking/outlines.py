"""Masks from hand-drawn outlines, and signed distances of masks."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.tracking.flow import single_threaded_cv2

Mask = NDArray[np.bool_]
FAR = 1e6


def _points(value: ArrayLike) -> NDArray[np.float64]:
    points = np.array(value, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise InputError(f"An outline needs at least three points (x, y), but has the shape {points.shape}.")
    if not np.isfinite(points).all():
        raise InputError("An outline has points that are not finite numbers; draw it again.")
    points.setflags(write=False)
    return points


@attrs.frozen(eq=False)
class Outline:
    """A closed outline around the subject (a lasso).

    Attributes
    ----------
    points : (k, 2) pixels, pixel centres at integers; may lie outside the picture and cross itself.
    subtract : take the inside away from what the outlines before it added.
    """

    points: NDArray[np.float64] = attrs.field(converter=_points)
    subtract: bool = False


KeyMask = Mask | Sequence[Outline | ArrayLike]


def fill_outlines(outlines: Sequence[Outline | ArrayLike], height: int, width: int) -> Mask:
    """Mask (height, width) of outlines that add and subtract in their order; a bare (k, 2) array adds."""
    cv2, mask = single_threaded_cv2(), np.zeros((height, width), np.uint8)
    for given in outlines:
        outline = given if isinstance(given, Outline) else Outline(given)
        # Sixteenths of a pixel; far points would overflow the fixed-point numbers of the fill.
        bound = np.clip(outline.points, -8 * max(height, width), 8 * max(height, width))
        inside = np.zeros_like(mask)
        cv2.fillPoly(inside, [np.rint(bound * 16).astype(np.int32)], 1, shift=4)
        mask[inside > 0] = 0 if outline.subtract else 1
    return mask.astype(bool)


def key_mask(key: KeyMask, frame: int, height: int, width: int) -> Mask:
    """Mask of a key frame, drawn or given; refuses a mask of another size."""
    if not isinstance(key, np.ndarray):
        return fill_outlines(key, height, width)
    if key.shape != (height, width) or key.dtype != np.bool_:
        raise InputError(f"The mask of frame {frame} is {key.dtype} {key.shape}, but must be bool ({height}, {width}).")
    return key


def signed_distance(mask: Mask) -> NDArray[np.float32]:
    """Distance to the edge of the mask, pixels, positive inside; -FAR everywhere for an empty mask."""
    if not mask.any():
        return np.full(mask.shape, -FAR, np.float32)
    if mask.all():
        return np.full(mask.shape, FAR, np.float32)
    cv2, inside = single_threaded_cv2(), mask.astype(np.uint8)
    within = cv2.distanceTransform(inside, cv2.DIST_L2, cv2.DIST_MASK_5)
    without = cv2.distanceTransform(1 - inside, cv2.DIST_L2, cv2.DIST_MASK_5)
    distance: NDArray[np.float32] = np.where(mask, within - 0.5, 0.5 - without).astype(np.float32)
    return distance
