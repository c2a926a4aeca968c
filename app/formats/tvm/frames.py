"""What every sequence of meshes offers, whatever files it is made of."""

from __future__ import annotations

import abc
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Self, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import Up


@attrs.frozen(eq=False)
class Texture:
    """How pictures lie on a mesh; kept as it came, for playback and export.

    Attributes
    ----------
    coordinates : (k, 2) float64, (0, 0) the lower left corner of the picture.
    corners : (m, 3) int32, the coordinates of each face's corners; -1 where a corner has none.
    images : the pictures' files.
    image_of_face : (m,) int32 index into ``images``; -1 where a face has none.
    """

    coordinates: NDArray[np.float64]
    corners: NDArray[np.int32]
    images: tuple[Path, ...]
    image_of_face: NDArray[np.int32]


@attrs.frozen(eq=False)
class FrameMesh:
    """One frame, in the unit and axes of its file (glTF is turned to Z up).

    Attributes
    ----------
    vertices : (v, 3) float64. faces : (m, 3) int32.
    colours : (v, 3) uint8 sRGB, or None.
    texture : pictures on it, or None.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8] | None = None
    texture: Texture | None = None


class MeshFrames(Sequence[FrameMesh]):
    """The frames of a sequence in order, read on demand; ``frames[k]`` raises ``InputError`` where one is damaged.

    Nothing is kept between two readings, so a sequence of any length needs the memory of one frame. Safe to use from
    several threads. Close it, or use it as a context manager.

    Attributes
    ----------
    name : for messages. form : what it is made of, in a word or two.
    fps : frames a second, None where the files do not say.
    up : the axis that points up, None where the files do not say. unit : metres a unit, None where unknown.
    moving : whether all frames have the same faces and numbers of vertices by the files' nature.
    remark : a sentence on what was chosen where the files leave it open; empty if nothing.
    """

    name: str
    form: str
    fps: Fraction | None = None
    up: Up | None = None
    unit: float | None = None
    moving: bool = False
    remark: str = ""

    @overload
    def __getitem__(self, frame: int) -> FrameMesh: ...
    @overload
    def __getitem__(self, frame: slice) -> list[FrameMesh]: ...
    def __getitem__(self, frame: int | slice) -> FrameMesh | list[FrameMesh]:
        if isinstance(frame, slice):
            return [self._frame(k) for k in range(len(self))[frame]]
        return self._frame(range(len(self))[frame])

    def __iter__(self) -> Iterator[FrameMesh]:
        for frame in range(len(self)):
            yield self._frame(frame)

    @abc.abstractmethod
    def _frame(self, frame: int) -> FrameMesh:
        """Read one frame, 0 <= frame < len."""

    def close(self) -> None:
        """Let go of files."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()
