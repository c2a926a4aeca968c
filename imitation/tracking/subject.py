"""The subject alone: pictures whose background is painted over, and the flow between them.

A thin limb is narrower than the windows of correlation and of flow; what lies beside it moves otherwise and wins.
Where a mask says what the subject is, the background is made plain: the outline stays as something to hold on to.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from imitation.tracking.flow import Flow16, PairFlow, Picture, single_threaded_cv2

GROW = 2
BESIDE = 40  # pixels of plain background left round the subject
FINEST = 500_000  # pixels of the enlarged piece up to which flow is sought at twice the size


def plain_grey(frames: Sequence[Picture], masks: Sequence[NDArray[np.bool_]]) -> int:
    """White or black (255 or 0), whichever is farther from the subject's brightness in a few frames."""
    count = len(frames)
    bright = []
    for t in sorted({0, count // 4, count // 2, 3 * count // 4, count - 1}):
        mask = np.asarray(masks[t], bool)
        if mask.any():
            bright.append(float(np.asarray(frames[t])[mask].mean()))
    return 255 if not bright or float(np.mean(bright)) < 128 else 0


def cut_out(picture: Picture, mask: Picture, grey: int) -> Picture:
    """The picture (h, w, 3) with all outside the mask (h, w) painted in one grey, the edge soft over about 3 pixels."""
    cv2 = single_threaded_cv2()
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * GROW + 1, 2 * GROW + 1))
    share = cv2.GaussianBlur(cv2.dilate(mask, kernel) * np.uint8(255), (7, 7), 1.0)[..., None].astype(np.uint16)
    mixed: Picture = ((picture * share + np.uint16(grey) * (255 - share) + 127) // 255).astype(np.uint8)
    return mixed


def subject_flow(engine: PairFlow, first: Picture, second: Picture, inside: NDArray[np.bool_]) -> tuple[Flow16, Flow16]:
    """Flow there and back (h, w, 2) between two cut-out grey pictures, sought round the subject, 0 elsewhere.

    ``inside`` (h, w) is where the subject is in either. The piece is enlarged where that is cheap: at its own size
    the method starts from half the resolution, where a hand is four pixels wide.
    """
    cv2 = single_threaded_cv2()
    both = np.zeros((2, *first.shape, 2), np.float16)
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    if not len(rows):
        return both[0], both[1]
    top, bottom = max(rows[0] - BESIDE, 0), rows[-1] + BESIDE + 1
    left, right = max(columns[0] - BESIDE, 0), columns[-1] + BESIDE + 1
    pieces = [np.ascontiguousarray(grey[top:bottom, left:right]) for grey in (first, second)]
    height, width = pieces[0].shape
    times = 2 if 4 * height * width <= FINEST else 1
    if times > 1:
        size = (times * width, times * height)
        pieces = [cv2.resize(piece, size, interpolation=cv2.INTER_CUBIC) for piece in pieces]
    for out, (a, b) in zip(both, (pieces, pieces[::-1]), strict=True):
        flow = engine.one_way(a, b, 1)
        if times > 1:
            flow = cv2.resize(flow.astype(np.float32), (width, height), interpolation=cv2.INTER_AREA) / times
        out[top:bottom, left:right] = flow
    return both[0], both[1]
