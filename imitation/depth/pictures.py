"""The frames of a clip as depth estimation reads them: signals to compare, and where the background shows."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.depth.depthmap import scaled_camera
from imitation.errors import InputError
from imitation.geometry.projection import Camera

LOCAL = 31  # pixels over which the mean intensity is taken off, at a width of 480
GROWTH = 0.0085  # of the longest side: the subject's rim is neither subject nor background
LONGEST = 960
KEPT = 24  # frames whose signals stay in memory


class Pictures:
    """Signals of frames at a workable size, made on demand, few kept; threads may share it.

    Parameters
    ----------
    frames : sequence of uint8 RGB (h, w, 3).
    cameras : one a frame, pixels of the frames.
    masks : sequence of bool (h, w), True on the subject and its shadow, or None.
    longest : the frames are reduced to at most this many pixels on the longest side.
    """

    def __init__(
        self, frames: Sequence[Any], cameras: CameraPath, masks: Sequence[Any] | None, longest: int = LONGEST
    ) -> None:
        first = np.asarray(frames[0])
        self.frames, self.masks, self.cameras = frames, masks, cameras
        self.full = (first.shape[1], first.shape[0])
        scale = min(1.0, longest / max(self.full))
        self.size = (round(self.full[0] * scale), round(self.full[1] * scale))
        self.scale = (self.size[0] / self.full[0], self.size[1] / self.full[1])
        self._signals: OrderedDict[int, NDArray[np.float32]] = OrderedDict()
        self._hidden: dict[int, NDArray[np.uint8]] = {}  # a bit a pixel

    def __len__(self) -> int:
        return len(self.frames)

    def camera(self, frame: int) -> Camera:
        """A frame's camera, working pixels."""
        return scaled_camera(self.cameras[frame], self.scale)

    def colour(self, frame: int) -> NDArray[np.uint8]:
        """The frame (h, w, 3) uint8 RGB, working size."""
        import cv2

        picture = np.asarray(self.frames[frame])
        if picture.shape != (self.full[1], self.full[0], 3) or picture.dtype != np.uint8:
            raise InputError(
                f"Frame {frame} is {picture.dtype} {picture.shape}, but the clip is uint8 "
                f"({self.full[1]}, {self.full[0]}, 3)."
            )
        if self.size == self.full:
            return picture
        small: NDArray[np.uint8] = cv2.resize(picture, self.size, interpolation=cv2.INTER_AREA)
        return small

    def shown(self, frame: int) -> NDArray[np.uint8]:
        """The frame (h, w, 3), middle grey where the subject is: its edges are none of the background's."""
        return np.where(self.hidden(frame)[..., None] > 0, np.uint8(128), self.colour(frame))

    def mask(self, frame: int) -> NDArray[np.uint8]:
        """1 on the subject (h, w), 0 elsewhere, working size, not grown."""
        import cv2

        if self.masks is None:
            return np.zeros(self.size[::-1], np.uint8)
        mask = np.asarray(self.masks[frame])
        if mask.shape != self.full[::-1]:
            raise InputError(
                f"The mask of frame {frame} is {mask.shape}, but the frames are {self.full[1]} high and "
                f"{self.full[0]} wide."
            )
        small: NDArray[np.uint8] = cv2.resize(
            mask.astype(bool).view(np.uint8), self.size, interpolation=cv2.INTER_NEAREST_EXACT
        )
        return small

    def hidden(self, frame: int) -> NDArray[np.uint8]:
        """1 on the subject and its rim (h, w), 0 elsewhere, working size."""
        import cv2

        bits = self._hidden.get(frame)
        if bits is None:
            radius = max(1, round(GROWTH * max(self.size)))
            disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
            bits = self._hidden[frame] = np.packbits(cv2.dilate(self.mask(frame), disc))
        flat: NDArray[np.uint8] = np.unpackbits(bits, count=self.size[0] * self.size[1])
        return flat.reshape(self.size[::-1])

    def signal(self, frame: int) -> NDArray[np.float32]:
        """What is compared (h, w, 4): intensity less its local mean, its gradients along x and y, 1 where hidden."""
        return self._kept(frame, self._make_signal)

    def _kept(self, frame: int, make: Callable[[int], NDArray[np.float32]]) -> NDArray[np.float32]:
        try:
            # Each step is one of the interpreter's, so that threads may share the pictures: at worst two make the same.
            self._signals.move_to_end(frame)
            return self._signals[frame]
        except KeyError:
            value = make(frame)
        self._signals[frame] = value
        while len(self._signals) > KEPT:
            self._signals.popitem(last=False)
        return value

    def _make_signal(self, frame: int) -> NDArray[np.float32]:
        import cv2

        grey = cv2.cvtColor(self.colour(frame), cv2.COLOR_RGB2GRAY).astype(np.float32)
        side = 2 * round(LOCAL * max(self.size) / 960) + 1
        hidden = self.hidden(frame).astype(np.float32)
        # The mean of what is not hidden: the subject's brightness must not reach past its rim.
        share = cv2.boxFilter(1 - hidden, -1, (side, side))
        mean = cv2.boxFilter(grey * (1 - hidden), -1, (side, side)) / np.maximum(share, np.float32(1e-3))
        across = cv2.Sobel(grey, cv2.CV_32F, 1, 0, ksize=1, scale=0.5)
        down = cv2.Sobel(grey, cv2.CV_32F, 0, 1, ksize=1, scale=0.5)
        return np.ascontiguousarray(np.stack([grey - mean, across, down, hidden], axis=-1))
