"""What of the background may hide a character that stands where the subject stood."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.depth.boxes import box_round
from imitation.depth.completion import Plate
from imitation.errors import InputError

ALIKE = 24.0
"""Levels, the worst channel, up to which a frame shows what its plate says that the background looks like."""
STRAYS = 3.0
SMOOTH = 1.0  # pixels: single noisy pixels do not decide
MARGIN = 8  # pixels: from farther away smoothing takes nothing


def shown_background(picture: NDArray[np.uint8], plate: Plate) -> NDArray[np.bool_]:
    """Where a frame (h, w, 3) shows the background: off the subject's mask, and within it where its plate's colour is.

    Masks drawn by hand take in the post that stands before the subject.
    """
    import cv2

    if picture.shape != plate.picture.shape:
        raise InputError(f"The frame is {picture.shape[:2]}, but its plate is {plate.picture.shape[:2]}.")
    shown: NDArray[np.bool_] = ~(plate.filled | plate.invented)
    box = box_round(plate.filled, MARGIN)  # colours have a say in what was filled only
    if box is None:
        return shown
    ours, theirs = (cv2.GaussianBlur(each[box], (0, 0), SMOOTH).astype(np.float32) for each in (picture, plate.picture))
    apart = np.abs(ours - theirs)
    alike = np.maximum(np.maximum(apart[..., 0], apart[..., 1]), apart[..., 2]) < ALIKE
    shown[box] |= plate.filled[box] & alike
    return shown


def hiding_depth(picture: NDArray[np.uint8], plate: Plate) -> NDArray[np.float32]:
    """Depth (h, w) of what may hide a character in the subject's place, camera z, NaN elsewhere.

    Depth behind the subject is measured from other frames only and strays; but where the frame itself shows the
    subject, nothing stands before it, and so nothing stands before who takes its place. A character that stands much
    farther away than the subject is hidden too little there. Where the frame shows what may as well be the subject, a
    white leg before a white step, depth must be nearer by more than it strays: ``STRAYS`` steps of its search.
    """
    hole = plate.filled | plate.invented
    depth = np.where(shown_background(picture, plate), plate.depth.depth, np.nan)
    return np.where(hole, depth * (1 + STRAYS * plate.depth.tolerance), depth).astype(np.float32)
