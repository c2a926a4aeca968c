"""Performances: captured sequences, and what shall be composed of their motions."""

from __future__ import annotations

from typing import Literal

import attrs

from app.model.frozen import FrozenMap
from app.model.values import MediaRef, Unknown

SequenceUp = Literal["y", "z"]
FeatureMethod = Literal["robust", "paper"]
StructureMethod = Literal["optimal", "paper"]
Fact = Literal["fps", "up", "unit"]


@attrs.frozen
class StructureChoice:
    """How a sequence is cut into motions.

    Attributes
    ----------
    method : "optimal" cuts the whole sequence at once, "paper" follows Fig. 3 with eq. 7 and 8.
    beta : threshold of eq. 8, only "paper"; None derives it.
    longest_period : seconds a repeat may take.
    sensitivity : 1 as measured; less gives fewer motions.
    force_cyclic : every stretch that is long enough counts as repeating.
    boundaries : first frames of the motions but the first, as corrected by hand; None finds them.
    """

    method: StructureMethod = "optimal"
    beta: float | None = None
    longest_period: float = 5.0
    sensitivity: float = 1.0
    force_cyclic: bool = False
    boundaries: tuple[int, ...] | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class CapturedSequence:
    """Meshes over time, each with faces of its own: files from outside, or a character of this project as animated.

    Frames are counted as they are played: where ``fps`` is not the rate of the files, the nearest file is shown.

    Attributes
    ----------
    media : the file or folder; None for a character's motion.
    character : id of the character whose motion it is; None for files.
    frame_count, fps : as played. source_count, source_fps : of the files.
    up : axis of the files that points up. unit : metres in one unit of the files.
    guessed : which of fps, up and unit the program guessed and the user has not said.
    front : where the performer faces in frame 0, degrees from +x towards +y; None finds it.
    level : take out what the performer climbs, so that a walk up some stairs joins one on level ground.
    animation : which one of a file that holds several; None is the only one, or the first.
    representatives : frames whose texton stands for its cluster; the others are chosen by eq. 9.
    """

    id: str
    name: str
    media: MediaRef | None
    character: str | None
    frame_count: int
    fps: float
    source_count: int
    source_fps: float
    up: SequenceUp = "z"
    unit: float = 1.0
    guessed: tuple[Fact, ...] = ()
    front: float | None = None
    level: bool = False
    structure: StructureChoice = attrs.field(factory=StructureChoice)
    representatives: tuple[int, ...] = ()
    visible: bool = True
    animation: str | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)

    def source_frame(self, frame: int) -> int:
        """Give the file shown at a frame."""
        return min(self.source_count - 1, round(frame * self.source_fps / self.fps))


@attrs.frozen
class Motion:
    """A motion of the database: the one that a frame of a sequence belongs to."""

    sequence: str
    frame: int


@attrs.frozen
class KeyMotion:
    """A motion that the performance must show, and how often it is played at least."""

    motion: Motion
    repeats: int = 1


@attrs.frozen
class HardCut:
    """A cut that shall not be blended: the last frame before it, and the first after it."""

    leave: Motion
    enter: Motion


@attrs.frozen
class PerformanceChoice:
    """What shall be composed, and how.

    Attributes
    ----------
    features : "robust", or "paper" (eq. 1 to 5 as printed), for all sequences.
    height : body height of the performer, metres; None measures it in the first sequence.
    graph : "robust" transitions and pruning, or "paper" (eq. 9 to 14).
    mu : size of the motion graph: more keeps more transitions.
    keys : the key motions in order.
    forbidden : motions that must not be played.
    length : wanted number of frames; None takes the best path as long as it is.
    loop : the end leads back to the start.
    alternative : which of the next best paths is taken; 0 is the best.
    align : place every clip where the one before it ends.
    blend : make in-betweens at cuts. blend_seconds : how long.
    hard_cuts : cuts that stay as they are.
    """

    features: FeatureMethod = "robust"
    height: float | None = None
    graph: FeatureMethod = "robust"
    mu: float = 0.9
    keys: tuple[KeyMotion, ...] = ()
    forbidden: tuple[Motion, ...] = ()
    length: int | None = None
    loop: bool = False
    alternative: int = 0
    align: bool = True
    blend: bool = True
    blend_seconds: float = 0.3
    hard_cuts: tuple[HardCut, ...] = ()
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)
