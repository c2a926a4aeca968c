"""What every source of frames offers, whether a video or a folder of pictures."""

from __future__ import annotations

import abc
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Self, overload

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
"""A picture: uint8 RGB (h, w, 3)."""


class FrameSource(Sequence[Picture]):
    """The frames of a clip in presentation order, decoded on demand.

    ``source[t]`` is a read-only uint8 RGB array (h, w, 3); ``source[a:b]`` is a lazy view. Safe to use from several
    threads. Close it, or use it as a context manager.

    Attributes
    ----------
    times : (n,) seconds of each frame's presentation, the first frame at 0.
    fps : frames per second; the average where the rate varies.
    size : (width, height) of the upright picture, pixels.
    fingerprint : a cheap hash of the medium's content.
    """

    times: NDArray[np.float64]
    fps: Fraction
    size: tuple[int, int]
    fingerprint: str

    def __len__(self) -> int:
        return len(self.times)

    @overload
    def __getitem__(self, frame: int) -> Picture: ...
    @overload
    def __getitem__(self, frame: slice) -> FrameView: ...
    def __getitem__(self, frame: int | slice) -> Picture | FrameView:
        if isinstance(frame, slice):
            return FrameView(self, range(len(self))[frame])
        return self._picture(range(len(self))[frame])

    @abc.abstractmethod
    def _picture(self, frame: int) -> Picture:
        """Decode one frame, 0 <= frame < len."""

    @abc.abstractmethod
    def close(self) -> None:
        """Let go of files and memory; frames cannot be read afterwards."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()


class FrameView(Sequence[Picture]):
    """Some frames of a source, still decoded on demand."""

    def __init__(self, source: FrameSource, frames: range) -> None:
        self._source, self._frames = source, frames

    def __len__(self) -> int:
        return len(self._frames)

    def __iter__(self) -> Iterator[Picture]:
        return (self._source[frame] for frame in self._frames)

    @overload
    def __getitem__(self, frame: int) -> Picture: ...
    @overload
    def __getitem__(self, frame: slice) -> FrameView: ...
    def __getitem__(self, frame: int | slice) -> Picture | FrameView:
        if isinstance(frame, slice):
            return FrameView(self._source, self._frames[frame])
        return self._source[self._frames[frame]]
