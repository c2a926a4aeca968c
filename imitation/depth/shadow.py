"""The subject's own shadow: where a frame is darker than the background is in other frames, beside the subject."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

DARK, SURE = 0.84, 0.72  # of the background's brightness: from where a place may, and where it must lie in shadow
BLACK = 0.12  # darker than this is no shadow
TINT = 0.05  # how far the colour of a place, its sum 1, may change in shadow
REACH = 1.1  # sizes of the subject round it in which its shadow is looked for
FAR = 0.25  # of its size: so far away a shadow may begin
ASTRAY = 7.0  # pixels at a width of 960 by which what other frames show may be misplaced
UNEXPLAINED = 0.92  # of the darkest that other frames show nearby: what is darker than that is no misplaced thing
THICK = 2.2  # pixels at a width of 960: half the least width of a shadow
SMOOTH = 1.5  # pixels at a width of 960
STRAY = 12.0  # grey levels that are noise where all is dark


def round_subject(mask: NDArray[np.uint8]) -> tuple[slice, slice]:
    """Rows and columns in which the subject's shadow is looked for; empty where there is no subject."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return slice(0, 0), slice(0, 0)
    reach = round(REACH * max(int(np.ptp(rows)), int(np.ptp(columns)), 1))
    return (
        slice(max(0, int(rows[0]) - reach), int(rows[-1]) + reach + 1),
        slice(max(0, int(columns[0]) - reach), int(columns[-1]) + reach + 1),
    )


def darkest_round(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The darkest that a picture (h, w, 3) shows within a few pixels of each, fine grain aside.

    A dark bar that other frames show a little beside its place, for want of exact depth, is no shadow.
    """
    import cv2

    width = max(picture.shape)
    smooth = cv2.GaussianBlur(picture, (0, 0), max(0.6, SMOOTH * width / 960))
    darkest: NDArray[np.uint8] = cv2.erode(smooth, _disc(ASTRAY * width / 960))
    return darkest


def shadow_of(
    picture: NDArray[np.uint8],
    bare: NDArray[np.float32],
    darkest: NDArray[np.float32],
    known: NDArray[np.bool_],
    mask: NDArray[np.uint8],
    width: int,
) -> NDArray[np.bool_]:
    """Where a picture (h, w, 3) lies in the subject's shadow, bool (h, w).

    Darker than the background by a share that shadows take, of nearly the same colour, connected, near the subject.

    Parameters
    ----------
    bare : the background as other frames show it, as bright as the picture. darkest : the same of what
        ``darkest_round`` gives of them. known : bool (h, w), where it is known.
    mask : 1 on the subject and its rim. width : of the whole frame, pixels.
    """
    import cv2

    sigma = max(0.6, SMOOTH * width / 960)
    weight = cv2.GaussianBlur(known.astype(np.float32), (0, 0), sigma)[..., None]

    def smooth(values: NDArray[np.float32]) -> NDArray[np.float32]:
        mean: NDArray[np.float32] = cv2.GaussianBlur(values * known[..., None], (0, 0), sigma) / np.maximum(
            weight, 1e-3
        )
        return mean

    ours, theirs = smooth(picture.astype(np.float32)), smooth(bare)
    light, full = ours.sum(axis=-1) / 3, theirs.sum(axis=-1) / 3
    share = (light + 1) / (full + 1)
    tint = np.abs(ours / np.maximum(3 * light, 1)[..., None] - theirs / np.maximum(3 * full, 1)[..., None]).max(axis=-1)
    usable = known & (weight[..., 0] > 0.3) & (mask == 0)
    lowest = darkest.sum(axis=-1) / 3
    dim = (
        usable
        & (light < UNEXPLAINED * lowest)
        & (share < DARK)
        & (share > BLACK)
        & (tint < TINT)
        & (full - light > STRAY)
    )
    # Bars are thinner than shadows; thick parts take back what lies round them.
    thick = cv2.morphologyEx((dim | (mask > 0)).astype(np.uint8), cv2.MORPH_OPEN, _disc(THICK * width / 960))
    dim &= cv2.dilate(thick & dim.astype(np.uint8), _disc(1.2 * THICK * width / 960)) > 0
    count, label, figures, _ = cv2.connectedComponentsWithStats(dim.astype(np.uint8), connectivity=8)
    if count < 2 or not mask.any():
        return np.zeros(mask.shape, bool)
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    size = max(int(np.ptp(rows)), int(np.ptp(columns)), 1)
    away = cv2.distanceTransform((mask == 0).astype(np.uint8), cv2.DIST_L2, 5)
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, label.ravel(), away.ravel())
    deep = np.bincount(label.ravel(), ((share < SURE) & dim).ravel(), count)
    area = figures[:, cv2.CC_STAT_AREA]
    kept = (nearest < FAR * size) & (area > 4e-4 * size * size + 12) & (deep > 0.25 * area)
    kept[0] = False
    found = kept[label].astype(np.uint8)
    disc = _disc(4 * width / 960)
    grown: NDArray[np.bool_] = (cv2.dilate(cv2.morphologyEx(found, cv2.MORPH_CLOSE, disc), disc) > 0) & (mask == 0)
    return grown


def _disc(radius: float) -> NDArray[np.uint8]:
    import cv2

    reach = max(1, round(radius))
    disc: NDArray[np.uint8] = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    return disc
