"""A fill as blurred as the frame it goes into: the camera's own motion blurs every frame differently."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.geometry.projection import Array

EXCESS = 1.5  # frames of distance that a frame is worth less for each pixel (at a width of 960) it is more blurred by
OPEN = tuple(k / 8 for k in range(1, 9))  # shares of the frame time that a shutter may be open
LEAST = 2.0  # pixels of motion a frame (at a width of 960) from which blur is looked for
GAIN = 0.97  # of the difference round the hole that must be left at most, for a blur to be believed
RING = 28  # pixels round the hole, at a width of 960, where a fill is compared with the frame


def movement(cameras: CameraPath, frame: int, pixels: Array, inverse: NDArray[np.floating]) -> Array:
    """Pixels (k, 2) that background points move in a frame's time, from half a frame before to half a frame after.

    Parameters
    ----------
    pixels : (k, 2) in the frame. inverse : (k,) their inverse depths, above 0.
    """
    points = cameras[frame].lift(pixels, 1 / np.asarray(inverse, np.float64))
    before, after = max(frame - 1, 0), min(frame + 1, len(cameras) - 1)
    moved: Array = (cameras[after].project(points) - cameras[before].project(points)) / max(after - before, 1)
    return moved


def speeds(cameras: CameraPath, frames: Sequence[int], size: tuple[int, int], middle: float) -> Array:
    """How many pixels (k,) the picture moves in each frame's time: the median over it, were all at the middle depth."""
    columns, rows = np.meshgrid(np.linspace(0, size[0] - 1, 7), np.linspace(0, size[1] - 1, 5))
    pixels = np.stack([columns.ravel(), rows.ravel()], axis=1)
    inverse = np.full(len(pixels), 1 / middle)
    found = [np.linalg.norm(movement(cameras, frame, pixels, inverse), axis=1) for frame in frames]
    return np.array([float(np.nanmedian(each)) if np.isfinite(each).any() else 0.0 for each in found])


def sharp_first(frames: Sequence[int], frame: int, speed: Array, own: float, longest: int) -> list[int]:
    """Frames to take colours from, the best first: near ones, and none that is much more blurred than the frame itself.

    A fill that is too sharp can be blurred; the other way round nothing helps.
    """
    excess = np.maximum(speed - max(own, LEAST * longest / 960), 0) * 960 / longest
    cost = np.abs(np.asarray(frames) - frame) + EXCESS * excess
    return [frames[k] for k in np.lexsort((np.asarray(frames), cost))]


def ring_of(hole: NDArray[np.bool_], known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a fill can be compared with the frame: known pixels (h, w) round the hole."""
    import cv2

    reach = round(RING * max(hole.shape) / 960)
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, 3)
    ring: NDArray[np.bool_] = ~hole & known & (away <= reach)
    return ring


@attrs.frozen(eq=False)
class Smear:
    """How a frame is blurred beside another picture of the same place.

    Attributes
    ----------
    share : of the frame's time that the shutter seems open beyond the other picture's; 0 where it is not blurred more.
    along : (2,) pixels in a frame's time.
    """

    share: float
    along: Array

    def of(self, picture: NDArray[np.float32], known: NDArray[np.bool_]) -> NDArray[np.float32]:
        """A picture (h, w, channels) blurred so, its unknown pixels not counting; unchanged where nothing is known."""
        import cv2

        kernel = line(self.share * self.along)
        weight = known.astype(np.float32)
        total = cv2.filter2D(picture * weight[..., None], cv2.CV_32F, kernel, borderType=cv2.BORDER_REPLICATE)
        total = total.reshape(picture.shape)
        count = cv2.filter2D(weight, cv2.CV_32F, kernel, borderType=cv2.BORDER_REPLICATE)[..., None]
        blurred: NDArray[np.float32] = np.where(count > 1e-3, total / np.maximum(count, 1e-3), picture)
        return blurred


def line(along: Array) -> NDArray[np.float32]:
    """A kernel that averages over a straight way (2,) centred on the pixel, as the open shutter does."""
    reach = int(np.ceil(np.abs(along).max() / 2)) + 1
    kernel = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
    steps = max(1, int(np.ceil(4 * float(np.abs(along).max()))))
    for k in range(steps):
        x, y = reach + ((k + 0.5) / steps - 0.5) * along
        i, j = int(np.floor(x)), int(np.floor(y))
        q, r = x - i, y - j
        for dy, down in ((0, 1 - r), (1, r)):
            for dx, across in ((0, 1 - q), (1, q)):
                kernel[j + dy, i + dx] += down * across
    kernel /= kernel.sum()
    return kernel


def smear(
    frame: NDArray[np.uint8],
    other: NDArray[np.float32],
    known: NDArray[np.bool_],
    ring: NDArray[np.bool_],
    along: Array,
) -> Smear:
    """Find how much more a frame is blurred than another picture of the same background, by what both show of it.

    Parameters
    ----------
    frame : uint8 (h, w, 3). other : (h, w, 3) the background from other frames, where ``known``.
    ring : bool (h, w) where both show the same. along : (2,) pixels that the background moves in the frame's time.
    """
    import cv2

    none = Smear(0.0, along)
    if float(np.linalg.norm(along)) < LEAST * max(frame.shape) / 960 or ring.sum() < 200:
        return none
    rows, columns = np.nonzero(ring | known)
    box = slice(rows.min(), rows.max() + 1), slice(columns.min(), columns.max() + 1)
    shown, picture, there = frame[box].astype(np.float32), other[box], known[box]
    # Of the compared pixels all that a blur draws on must be known, and slow shades tell nothing of blur.
    inner = ring[box] & (cv2.erode(there.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0)
    if inner.sum() < 200:
        return none

    grey, other_grey = shown.mean(axis=-1), picture.mean(axis=-1)

    def apart(made: NDArray[Any]) -> float:
        rest = made - grey
        rest -= cv2.GaussianBlur(rest, (0, 0), 6.0)
        return float(np.mean(np.minimum(np.abs(rest[inner]), 40.0) ** 2))

    sharp = apart(other_grey)
    best, least = none, GAIN * sharp
    for number, share in enumerate(OPEN):
        tried = Smear(share, along)
        left = apart(tried.of(other_grey[..., None], there)[..., 0])
        if left < least:
            best, least = tried, left
        elif number and left > 1.1 * min(sharp, least):
            # The more it is blurred beyond what fits, the worse.
            break
    return best


def blurred_alike(
    picture: NDArray[np.uint8],
    fill: NDArray[np.float32],
    hole: NDArray[np.bool_],
    known: NDArray[np.bool_],
    inverse: NDArray[np.float32],
    cameras: CameraPath,
    frame: int,
    coloured: Callable[[NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]], Any],
) -> NDArray[np.float32]:
    """A fill (h, w, 3) as blurred by the camera's motion as the frame is round the hole.

    Parameters
    ----------
    picture : the frame, uint8 (h, w, 3). hole, known : bool (h, w), what is filled, and what has a colour.
    inverse : (h, w) inverse depth, 0 where none.
    coloured : gives the colours (k, 3) that other frames have at rows, columns and inverse depths, and how many have.
    """
    ring = ring_of(hole, (inverse > 0) & known) if hole.any() else hole
    rows, columns = np.nonzero(ring)
    if not len(rows):
        return fill
    colour, seen = coloured(rows, columns, inverse[ring])
    other, there = fill.copy(), hole & known
    ring[rows[seen == 0], columns[seen == 0]] = False
    other[rows, columns], there[ring] = colour, True
    moved = movement(cameras, frame, np.stack([columns, rows], axis=1), inverse[rows, columns])
    found = smear(picture, other, there, ring, np.nanmedian(moved, axis=0))
    return fill if found.share == 0 else np.where((hole & known)[..., None], found.of(other, there), fill)
