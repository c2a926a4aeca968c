"""The meshes of a sequence as everything after them wants them: z up, metres, at the rate they are played."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import y_up_to_z_up
from app.formats.tvm import FrameMesh, MeshFrames
from app.model.document import Document
from app.model.performance import CapturedSequence
from app.model.values import MediaRef
from app.stages import animation
from app.stages.media import Media
from app.stages.results import AlignedCharacter, Animation
from app.stages.stage import Stage
from imitation.errors import InputError

CLIMB_SECONDS = 0.5
"""Over how long the lowest point is averaged where a climb is taken out."""


@attrs.frozen
class FootageSource:
    """What the document says of a sequence's meshes: the part of it that results depend on."""

    media: MediaRef | None
    mesh: MediaRef | None
    frame_count: int
    fps: float
    source_count: int
    source_fps: float
    up: str
    unit: float
    level: bool
    animation: str | None = None

    def source_frame(self, frame: int) -> int:
        """Give the file shown at a frame."""
        return min(self.source_count - 1, round(frame * self.source_fps / self.fps))


def source_of(document: Document, sequence: CapturedSequence) -> FootageSource:
    """Take what matters from a sequence."""
    mesh = None if sequence.character is None else document.character(sequence.character).mesh
    return FootageSource(
        sequence.media,
        mesh,
        sequence.frame_count,
        sequence.fps,
        sequence.source_count,
        sequence.source_fps,
        sequence.up,
        sequence.unit,
        sequence.level,
        sequence.animation,
    )


def needs_of(document: Document, sequence: CapturedSequence) -> tuple[Stage, ...]:
    """Stages that ``open_footage`` takes the results of, in order."""
    if sequence.character is None:
        return ()
    character = document.character(sequence.character)
    return (animation.alignment(document, character), animation.animation(document, character))


class Footage:
    """Frames of one sequence on demand; ``footage[k]`` is a mesh z up, in metres.

    Parameters
    ----------
    source : what the document says.
    frames : its files; None where ``moving`` holds the motion of a character.
    moving : placed character, its motion, colours a vertex.
    """

    def __init__(
        self,
        source: FootageSource,
        frames: MeshFrames | None,
        moving: tuple[AlignedCharacter, Animation, NDArray[np.uint8] | None] | None,
    ) -> None:
        self.source, self._frames, self._moving = source, frames, moving
        self._drop: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        return self.source.frame_count

    def __iter__(self) -> Iterator[FrameMesh]:
        for frame in range(len(self)):
            yield self[frame]

    def __getitem__(self, frame: int) -> FrameMesh:
        mesh = self._placed(range(len(self))[frame])
        if not self.source.level:
            return mesh
        if self._drop is None:
            self._drop = _climb(self)
        lowered = mesh.vertices - np.array([0.0, 0.0, self._drop[frame]])
        return attrs.evolve(mesh, vertices=lowered)

    @property
    def moving(self) -> bool:
        """Whether all frames have the same faces."""
        return self._moving is not None or (self._frames is not None and self._frames.moving)

    def _placed(self, frame: int) -> FrameMesh:
        at = self.source.source_frame(frame)
        if self._moving is not None:
            aligned, animated, colours = self._moving
            return FrameMesh(np.array(animated.vertices[at], np.float64), aligned.faces, colours)
        assert self._frames is not None
        mesh = self._frames[at]
        if self.source.up == "z" and self.source.unit == 1.0:
            return mesh
        vertices = y_up_to_z_up(mesh.vertices) if self.source.up == "y" else mesh.vertices
        return attrs.evolve(mesh, vertices=vertices * self.source.unit)

    def lowest(self, frame: int) -> float:
        """Give z of the lowest point as filmed."""
        return float(self._placed(frame).vertices[:, 2].min())


def open_footage(media: Media, source: FootageSource, results: tuple[Any, ...]) -> Footage:
    """Open a sequence; ``results`` are those of ``needs_of``."""
    if source.media is None:
        aligned, animated = results
        if len(animated) != source.source_count:
            raise InputError(
                f"The character's motion has {len(animated)} frames now, the sequence was made of "
                f"{source.source_count}: remove the sequence and add it again."
            )
        assert source.mesh is not None
        return Footage(source, None, (aligned, animated, media.mesh(source.mesh).colors))
    frames = media.mesh_frames(source.media, source.animation)
    if len(frames) != source.source_count:
        raise InputError(
            f"{frames.name} is another sequence now: it has {len(frames)} frames, the project was made with "
            f"{source.source_count}; put the old files back."
        )
    return Footage(source, frames, None)


def _climb(footage: Footage) -> NDArray[np.float64]:
    """How far (n,) each frame stands above the first, as the lowest point rises and falls over half a second.

    The least over a window, then smoothed: a foot stands in nearly every such window, and a jump is no climb.
    """
    from scipy.ndimage import gaussian_filter1d, minimum_filter1d

    lows = np.array([footage.lowest(frame) for frame in range(len(footage))])
    width = max(1, round(CLIMB_SECONDS * footage.source.fps))
    ground = gaussian_filter1d(minimum_filter1d(lows, width, mode="nearest"), width / 2, mode="nearest")
    drop: NDArray[np.float64] = ground - ground[0]
    return drop
