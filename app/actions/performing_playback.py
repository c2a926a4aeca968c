"""Frames made ready to be drawn: of the composed performance, or of a sequence as captured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.performing_frames import performance_frames, sequence_footage
from app.actions.session import Session
from app.formats.tvm import FrameMesh, painted


@attrs.frozen(eq=False)
class ShownFrame:
    """A mesh as a renderer takes it; world, metres, z up.

    Attributes
    ----------
    vertices, normals : (v, 3) float32. faces : (m, 3) int32. colours : (v, 3) uint8, None where it has none.
    low, high : corners (3,) of the box around it.
    sequence : number of the sequence it comes from. source : its frame there. blended : whether it is an in-between.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8] | None
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    sequence: int
    source: int
    blended: bool = False

    @property
    def size(self) -> int:
        """Bytes that it keeps."""
        arrays = (self.vertices, self.normals, self.faces, self.colours)
        return sum(each.nbytes for each in arrays if each is not None)


class ShownFrames(Sequence[ShownFrame]):
    """``frames[k]`` reads and prepares one frame; safe to use from another thread than the window's.

    Attributes
    ----------
    fps : frames a second.
    """

    def __init__(self, meshes: Any, fps: float, sequence: int | None) -> None:
        self._meshes, self.fps, self._sequence = meshes, fps, sequence

    def __len__(self) -> int:
        return len(self._meshes)

    def __getitem__(self, position: Any) -> Any:
        if isinstance(position, slice):
            return [self[k] for k in range(len(self))[position]]
        position = range(len(self))[position]
        mesh = painted(self._meshes[position])
        if self._sequence is not None:
            return ready(mesh, self._sequence, position)
        sequence, source = (int(value) for value in self._meshes.performance.frames[position])
        return ready(mesh, sequence, source, self._meshes.blended(position))


def ready(mesh: FrameMesh, sequence: int, source: int, blended: bool = False) -> ShownFrame:
    """Prepare one mesh: single precision, normals, the box around it."""
    from imitation.geometry.drawing import drawn_normals

    vertices = np.ascontiguousarray(mesh.vertices, np.float32)
    faces = np.ascontiguousarray(mesh.faces, np.int32).reshape(-1, 3)
    colours = None if mesh.colours is None else np.ascontiguousarray(mesh.colours[:, :3], np.uint8)
    columns = vertices.T
    low, high = (np.array([end(column) for column in columns], np.float64) for end in (np.min, np.max))
    return ShownFrame(vertices, drawn_normals(vertices, faces), faces, colours, low, high, sequence, source, blended)


def performance_shown(session: Session, *, blended: bool = True, aligned: bool = True) -> ShownFrames:
    """Give the frames of the composed performance; to compare, without in-betweens or every clip as filmed.

    Raises ``InputError`` when it has not been composed.
    """
    frames = performance_frames(session, blended=blended and aligned, aligned=aligned)
    return ShownFrames(frames, frames.fps, None)


def sequence_shown(session: Session, sequence_id: str) -> ShownFrames:
    """Give the frames of a sequence as captured."""
    sequences = session.document.sequences
    number = [each.id for each in sequences].index(sequence_id)
    return ShownFrames(sequence_footage(session, sequence_id), sequences[number].fps, number)
