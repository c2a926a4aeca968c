"""Which part of a character the background hides, with soft edges on both sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

MEDIAN, SOFT = 5, 0.7  # pixels: stray depths are voted down, then the edge is as soft as a pixel's


def extended_depth(depth: NDArray[np.floating]) -> NDArray[np.float32]:
    """A character's depth (h, w), inf outside it, continued outside by the nearest pixel's.

    Without it any smoothing of the visibility would leave a ghost of the hidden part's outline.
    """
    import cv2

    there = np.isfinite(depth)
    if not there.any():
        return depth.astype(np.float32)
    _, label = cv2.distanceTransformWithLabels(
        (~there).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    table = np.zeros(int(label.max()) + 1, np.float32)
    table[label[there]] = depth[there]
    extended: NDArray[np.float32] = table[label]
    return extended


def visibility(
    depth: NDArray[np.floating], background: NDArray[np.floating], tolerance: float = 0.0, *, soft: bool = True
) -> NDArray[np.float32]:
    """How much of each pixel (h, w) of a character stands before the background, 0 to 1.

    A hard test on the extended depth, the median of 5 x 5 pixels of it, then a Gaussian of 0.7 pixels: a ramp in depth
    was measured to be worse than the hard test, even with exact depth.

    Parameters
    ----------
    depth : (h, w) camera z of the character, inf outside it.
    background : (h, w) camera z, NaN where unknown; there the character is visible.
    tolerance : how far behind the background still counts as before it, world units.
    soft : False leaves the hard test.
    """
    import cv2

    if depth.shape != background.shape:
        raise InputError(f"The background's depth is {background.shape}, but the picture is {depth.shape}.")
    with np.errstate(invalid="ignore"):
        if not soft:
            return (~(depth > background + tolerance)).astype(np.float32)
        shown = (~(extended_depth(depth) > background + tolerance)).astype(np.uint8)
    if shown.all():
        return np.ones(depth.shape, np.float32)
    voted = cv2.medianBlur(shown, MEDIAN).astype(np.float32)
    matte: NDArray[np.float32] = cv2.GaussianBlur(voted, (0, 0), SOFT)
    return matte
