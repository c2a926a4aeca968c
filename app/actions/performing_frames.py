"""The frames of a performance, one at a time: for playback, export and films."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import attrs
import numpy as np

from app.actions.session import Session
from app.formats.tvm import FrameMesh
from app.stages.performance.footage import Footage, needs_of, open_footage, source_of
from app.stages.performance.results import Assembled, Blended
from imitation.errors import InputError


class PerformanceFrames(Sequence[FrameMesh]):
    """Meshes of a performance, z up and in metres, placed; from a blend where there is one.

    Blended frames have the topology of the clip that is left, or of the one that is entered where only that blends
    well, and colours a vertex, passed over from one clip's to the nearest ones of the other; all others are as
    captured, with their colours and pictures.

    Attributes
    ----------
    performance : the engine's. fps : frames a second.
    moving : whether all frames have the same faces.
    """

    def __init__(self, footages: Sequence[Footage], performance: Any, blends: Sequence[Any], fps: float) -> None:
        self._footages, self.performance, self.fps = footages, performance, fps
        self._shapes = {position: shape for blend in blends for position, shape in blend.shapes.items()}
        used = {int(sequence) for sequence in performance.frames[:, 0]}
        self.moving = all(footages[number].moving for number in used) and _one_mesh(footages, used)

    def __len__(self) -> int:
        return len(self.performance)

    def __iter__(self) -> Iterator[FrameMesh]:
        for position in range(len(self)):
            yield self[position]

    def __getitem__(self, position: Any) -> Any:
        if isinstance(position, slice):
            return [self[k] for k in range(len(self))[position]]
        position = range(len(self))[position]
        shape = self._shapes.get(position)
        if shape is not None:
            return FrameMesh(shape.vertices, shape.faces, shape.colours)
        sequence, frame = (int(value) for value in self.performance.frames[position])
        mesh = self._footages[sequence][frame]
        return attrs.evolve(mesh, vertices=self.performance.place(position, mesh.vertices))

    def blended(self, position: int) -> bool:
        """Whether a frame is an in-between."""
        return position in self._shapes


def performance_frames(session: Session, *, blended: bool = True, aligned: bool = True) -> PerformanceFrames:
    """Give the frames of the composed performance; to compare, without blends or with every clip as filmed.

    Raises ``InputError`` when it has not been composed.
    """
    placed = session.ready(session.stages.performance)
    if not isinstance(placed, Assembled):
        raise InputError("The performance has not been composed yet: run perform compose first.")
    performance = placed.performance
    if not aligned:
        performance = attrs.evolve(performance, transforms=np.zeros_like(performance.transforms))
    made = session.ready(session.stages.blends) if blended and aligned else None
    blends = made.blends if isinstance(made, Blended) else ()
    footages = [sequence_footage(session, sequence.id) for sequence in session.document.sequences]
    return PerformanceFrames(footages, performance, blends, session.document.sequences[0].fps)


def sequence_footage(session: Session, sequence_id: str) -> Footage:
    """Open the meshes of one sequence, z up and in metres; a character's motion must have been computed."""
    document = session.document
    sequence = document.sequence(sequence_id)
    results = tuple(session.result(stage) for stage in needs_of(document, sequence))
    return open_footage(session.media, source_of(document, sequence), results)


def _one_mesh(footages: Sequence[Footage], used: set[int]) -> bool:
    first, *others = (footages[number][0] for number in sorted(used))
    return all(
        other.vertices.shape == first.vertices.shape and np.array_equal(other.faces, first.faces) for other in others
    )
