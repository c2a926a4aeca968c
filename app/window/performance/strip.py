"""The structure of a sequence as values on an axis of frames, what lies under the mouse, and the drag of a boundary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.window.performance.strip_colours import kind_colour
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER

if TYPE_CHECKING:
    from app.window.performance.state import PerformanceState

TEXTONS, CURVE = 58, 50
"""Heights of the lanes."""
BAR, BOX = (6, 16), (26, 26)
"""Top and height of the motions' bars and of the textons, in their lane."""
GRAB = 5.0
HEIGHT = RULER + TEXTONS + CURVE
Span = tuple[int, int]


@dataclass(frozen=True)
class StripMotion:
    """A motion of the sequence: frames (both included), its repeats, which of them is kept, and why it is one."""

    first: int
    last: int
    name: str
    colour: str
    cyclic: bool
    textons: tuple[Span, ...]
    kept: int = -1
    reason: str = ""
    forbidden: bool = False

    def texton_at(self, frame: int) -> int:
        """The number of the texton that holds a frame, -1 for none."""
        return next((k for k, (first, last) in enumerate(self.textons) if first <= frame <= last), -1)


@dataclass(frozen=True, eq=False)
class Strip:
    """All of it. curve : (n,) atom distance to the start of each frame's texton. threshold : of the method."""

    count: int = 0
    motions: tuple[StripMotion, ...] = ()
    curve: NDArray[np.float64] | None = None
    threshold: float = 0.0
    reason: str = ""

    @property
    def boundaries(self) -> tuple[int, ...]:
        """First frames of the motions but the first."""
        return tuple(motion.first for motion in self.motions[1:])

    def motion_at(self, frame: int) -> int:
        """The number of the motion that a frame belongs to, -1 for none."""
        return next((k for k, motion in enumerate(self.motions) if motion.first <= frame <= motion.last), -1)


@dataclass(frozen=True)
class StripHit:
    """What lies under the mouse: kind, frame, motion and texton by number (-1 for none)."""

    kind: Literal["ruler", "boundary", "texton", "motion", "curve", "label"]
    frame: int
    motion: int = -1
    texton: int = -1


def strip_of(state: PerformanceState, sequence_id: str, structure: Any) -> Strip:
    """The strip of a sequence; what is kept comes from the graph where it is there."""
    sequence = state.document.sequence(sequence_id)
    kept, barred = _kept(state, sequence_id), state.document.performance.forbidden
    motions = []
    for number, cluster in enumerate(structure.clusters):
        textons = tuple((int(first), int(last)) for first, last in cluster.textons)
        chosen = next((k for k, span in enumerate(textons) if span in kept), -1)
        motions.append(
            StripMotion(
                first=int(cluster.first),
                last=int(cluster.last),
                name=f"{sequence.name}/{number + 1}",
                colour=kind_colour(state, sequence_id, cluster.kind),
                cyclic=bool(cluster.cyclic),
                textons=textons,
                kept=chosen,
                reason=cluster.reason,
                forbidden=any(
                    each.sequence == sequence_id and cluster.first <= each.frame <= cluster.last for each in barred
                ),
            )
        )
    curve = np.asarray(structure.curve, np.float64)
    return Strip(sequence.frame_count, tuple(motions), curve, float(structure.threshold), structure.reason)


def _kept(state: PerformanceState, sequence_id: str) -> set[Span]:
    """The textons of a sequence that the graph plays."""
    return {tuple(motion.texton) for motion in state.motions if motion.sequence == sequence_id}


def found_at(strip: Strip, axis: Axis, x: float, y: float) -> StripHit:
    """What lies at a place; a boundary is found within reach in both lanes, before what lies beside it."""
    cell = min(max(int(axis.first + (x - axis.left) / axis.pixels), 0), max(strip.count - 1, 0))
    if x < LABELS:
        return StripHit("label", cell)
    if y < RULER:
        return StripHit("ruler", cell)
    near = min(strip.boundaries, key=lambda frame: abs(axis.x(frame) - x), default=None)
    if near is not None and abs(axis.x(near) - x) <= GRAB:
        return StripHit("boundary", near, strip.motion_at(near))
    motion = strip.motion_at(cell)
    texton = strip.motions[motion].texton_at(cell) if motion >= 0 else -1
    if y >= RULER + TEXTONS:
        return StripHit("curve", cell, motion, texton)
    if y >= RULER + BOX[0] - 2 and texton >= 0:
        return StripHit("texton", cell, motion, texton)
    return StripHit("motion", cell, motion, texton)


@dataclass(frozen=True)
class BoundaryDrag:
    """A boundary that is held: it stays between its neighbours, which keep a frame at least."""

    old: int
    low: int
    high: int
    new: int

    def to(self, frame: int) -> BoundaryDrag:
        """The same at another frame."""
        return BoundaryDrag(self.old, self.low, self.high, min(max(frame, self.low), self.high))


def drag_of(strip: Strip, boundary: int) -> BoundaryDrag:
    """Take hold of a boundary."""
    order = (0, *strip.boundaries, strip.count)
    place = order.index(boundary)
    return BoundaryDrag(boundary, order[place - 1] + 1, order[place + 1] - 1, boundary)


def boundary_frame(axis: Axis, x: float) -> int:
    """The frame before which a line at x stands."""
    return round(axis.first + (x - axis.left) / axis.pixels)
