"""A clip as the camera solver reads it: grey pictures of a workable size, and where the background shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Array

Grey = NDArray[np.uint8]

LONGEST = 1280  # pixels; a larger picture is halved in memory and time, and gains nothing a pose needs
SMALLEST = 64
MASK_GROWTH = 0.01  # of the longest side: features on the subject's rim move with it


def _measure(frames: Sequence[Any]) -> tuple[int, int]:
    if not len(frames):
        raise InputError("The clip has no frames; give at least one picture.")
    first = np.asarray(frames[0])
    if first.ndim not in (2, 3) or first.dtype != np.uint8 or (first.ndim == 3 and first.shape[2] != 3):
        raise InputError(f"Frame 0 must be uint8 RGB (h, w, 3), but is {first.dtype} of shape {first.shape}.")
    height, width = first.shape[:2]
    if min(height, width) < SMALLEST:
        raise InputError(f"The frames are {width} x {height} pixels; cameras need at least {SMALLEST} on each side.")
    return width, height


@attrs.frozen(eq=False)
class Clip:
    """Frames and masks on demand; nothing is kept.

    Attributes
    ----------
    frames : sequence of uint8 RGB (h, w, 3).
    masks : sequence of bool (h, w), True on the subject (left out), or None.
    size : (width, height) of the frames, pixels.
    scale : factor from the frames' pixels to those of ``grey``.
    """

    frames: Sequence[Any]
    masks: Sequence[Any] | None
    size: tuple[int, int]
    scale: float

    @classmethod
    def of(cls, frames: Sequence[Any], masks: Sequence[Any] | None) -> Clip:
        """Validate what can be seen without reading the whole clip."""
        size = _measure(frames)
        if masks is not None:
            if len(masks) != len(frames):
                raise InputError(f"There are {len(masks)} masks for {len(frames)} frames; give one mask a frame.")
            cls._check_mask(masks[0], 0, size)
        return cls(frames, masks, size, min(1.0, LONGEST / max(size)))

    @staticmethod
    def _check_mask(mask: Any, frame: int, size: tuple[int, int]) -> NDArray[np.bool_]:
        array = np.asarray(mask)
        if array.shape != (size[1], size[0]):
            raise InputError(
                f"The mask of frame {frame} has shape {array.shape}, but the frames are {size[1]} high, {size[0]} wide."
            )
        return array.astype(bool)

    def __len__(self) -> int:
        return len(self.frames)

    @property
    def working_size(self) -> tuple[int, int]:
        """(width, height) of ``grey``, pixels."""
        return round(self.size[0] * self.scale), round(self.size[1] * self.scale)

    @property
    def working_centre(self) -> Array:
        """The principal point (2,) in ``grey``, pixels."""
        return (np.array(self.working_size, np.float64) - 1) / 2

    def grey(self, frame: int) -> Grey:
        """The frame as grey uint8, at most ``LONGEST`` pixels long."""
        import cv2

        picture = np.asarray(self.frames[frame])
        if picture.shape[:2] != (self.size[1], self.size[0]):
            raise InputError(
                f"Frame {frame} has shape {picture.shape}, but frame 0 is {self.size[0]} x {self.size[1]}."
            )
        grey: Grey = picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
        if self.scale < 1:
            grey = cv2.resize(grey, self.working_size, interpolation=cv2.INTER_AREA)
        return grey

    def background(self, frame: int) -> Grey | None:
        """255 where features may lie, 0 on the grown mask; None where there is no mask."""
        import cv2

        if self.masks is None:
            return None
        mask = self._check_mask(self.masks[frame], frame, self.size).astype(np.uint8)
        if self.scale < 1:
            mask = cv2.resize(mask, self.working_size, interpolation=cv2.INTER_NEAREST)
        radius = max(1, round(MASK_GROWTH * max(self.working_size)))
        disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
        allowed: Grey = (1 - cv2.dilate(mask, disc)) * np.uint8(255)
        return allowed

    def full(self, pixels: Array) -> Array:
        """Pixels (..., 2) of ``grey`` in those of the frames."""
        return (pixels + 0.5) / self.scale - 0.5

    def intrinsics(self, focal: float) -> Array:
        """The intrinsic matrix (3, 3) in the frames' pixels of a working-size focal length (pixels)."""
        width, height = self.size
        f = focal / self.scale
        return np.array([[f, 0.0, (width - 1) / 2], [0.0, f, (height - 1) / 2], [0.0, 0.0, 1.0]])
