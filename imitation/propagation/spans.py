"""Spans between edited frames, and the frames of one span after an edit (paper A, 3.6; eq. 5-6)."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.motion.transfer import span_share, swing_clock
from imitation.propagation.base import Base
from imitation.propagation.edits import typical_modes
from imitation.propagation.runs import Places, Run, frame_constraints

if TYPE_CHECKING:
    from imitation.deformation import Deformer
    from imitation.deformation.pose import Pose


@attrs.frozen(eq=False)
class Knot:
    """A frame whose pose is given: frame 0, an edited frame, or the end of an edit's reach (the base's own pose)."""

    frame: int
    committed: Places | None


@attrs.frozen(eq=False)
class Span:
    """The frames between two knots; ``last`` is None where the correction of ``first`` is held to the end."""

    first: Knot
    last: Knot | None
    stop: int

    @property
    def frames(self) -> range:
        """The frames to be deformed: those strictly inside."""
        return range(self.first.frame + 1, self.stop)

    @property
    def touched(self) -> bool:
        """Whether anything here differs from the base solution."""
        return self.first.committed is not None or (self.last is not None and self.last.committed is not None)

    def runs(self) -> list[tuple[int, range]]:
        """Edited ends, each with the frames that are solved away from it: from both to the middle, or from the one."""
        first, stop, last = self.first.frame + 1, self.stop, self.last
        if last is None or last.committed is None:
            return [(self.first.frame, range(first, stop))]
        if self.first.committed is None:
            return [(last.frame, range(stop - 1, first - 1, -1))]
        middle = (first + stop) // 2
        return [(self.first.frame, range(first, middle)), (last.frame, range(stop - 1, middle - 1, -1))]

    def controls(self, keys: frozenset[int]) -> list[int]:
        """Control vertices that were dragged at one of the two ends."""
        ends = [knot.committed or {} for knot in (self.first, self.last) if knot is not None]
        return sorted({vertex for places in ends for vertex in places} - keys)


def cut_spans(
    count: int, edits: Mapping[int, Places], reach: Mapping[int, tuple[int | None, int | None]]
) -> list[Span]:
    """Cut a clip at its edited frames and at the ends of their reach.

    ``reach`` gives, for an edited frame, the frames (in, out) outside which it changes
    nothing; None leaves an end open.
    """
    knots: dict[int, Places | None] = {0: None}
    ordered = sorted(edits)
    for place, frame in enumerate(ordered):
        before = ordered[place - 1] if place else 0
        after = ordered[place + 1] if place + 1 < len(ordered) else count
        first, last = reach.get(frame, (None, None))
        for end, allowed in ((first, before <= (first or 0) <= frame), (last, frame <= (last or 0) < after)):
            if end is not None and not 0 <= end < count:
                raise InputError(f"The reach of the edit in frame {frame} ends in frame {end}, outside the clip.")
            if end is not None and allowed and end not in edits:
                knots[end] = None
    knots.update(edits)
    frames = sorted(knots)
    cut = [Knot(frame, knots[frame]) for frame in frames]
    spans = [Span(first, last, last.frame) for first, last in pairwise(cut)]
    return [*spans, Span(cut[-1], None, count)]


class SpanSolver:
    """Deforms the frames of one span; each frame depends on the base solution and the span's two ends alone.

    From an edited end the frames are solved one after the other, away from it, to the middle where both ends are
    edited: what an edit changes differs little from frame to frame, so each begins with what the one before it found.
    """

    def __init__(
        self,
        base: Base,
        span: Span,
        poses: Array,
        deformer: Deformer,
        *,
        smooth: bool,
        follow: Mapping[int, int],
        two_pass: bool = True,
        firsts: dict[int, Pose] | None = None,
    ) -> None:
        self.base, self.span, self.deformer, self.smooth = base, span, deformer, smooth
        self.keys = base.keys.vertices.tolist()
        self.controls = span.controls(frozenset(self.keys)) if two_pass else []
        self.follow = {vertex: follow[vertex] for vertex in self.controls if vertex in follow}
        knots = [knot for knot in (span.first, span.last) if knot is not None]
        self.ends = [knot.frame for knot in knots]
        self._poses = [poses[frame] for frame in self.ends]
        targets = [_key_places(base, knot) for knot in knots]
        self._corrections = [target - base.lifted[frame] for target, frame in zip(targets, self.ends, strict=True)]
        self._clocks = [swing_clock(base.keys.planted[:, key]) for key in range(len(self.keys))]
        self._shares = [self._share(clock) for clock in self._clocks]
        self._runs = [Run(self, end, frames) for end, frames in span.runs()]
        # The spans on both sides of an edited frame ask the same of it.
        self._firsts = {} if firsts is None else firsts
        self._given: dict[int, Pose] = {}
        self._offsets: dict[int, tuple[list[Array], Array]] = {}

    def order(self, origin: int) -> list[tuple[int, int]]:
        """The frames of the span as (rank, frame); lower ranks are solved first, outward from a frame where possible.

        A frame between two edits that lies beyond their middle has to wait for those next to the farther edit.
        """
        ranked: list[tuple[int, int]] = []
        for run in self._runs:
            nearest = min((abs(each - origin) for each in run.frames), default=0)
            ranked += [(nearest + position, frame) for position, frame in enumerate(run.frames)]
        return ranked

    def key_targets(self, frame: int) -> Array:
        """Corrected places (k, 3) of all key points (eq. 5-6 in space)."""
        return np.stack([
            self.base.lifted[frame, key]
            + self._blend([corrections[key] for corrections in self._corrections], self._shares[key], frame)
            for key in range(len(self.keys))
        ])  # fmt: skip

    def frame(self, frame: int) -> Array:
        """Vertices (v, 3) of a frame: one pass where every motion gradient is known, else two."""
        return next(run for run in self._runs if frame in run.frames).solve(frame)

    def control_targets(self, frame: int, first_pass: Array | None) -> Places:
        """Places of the control vertices in a frame, given the first pass (v, 3) where one is needed."""
        if self.controls and not self._offsets:
            self._offsets = {vertex: self._control_offsets(vertex) for vertex in self.controls}
        points: Places = {}
        for vertex in self.controls:
            offsets, share = self._offsets[vertex]
            points[vertex] = self._gradient(vertex, frame, first_pass) + self._blend(offsets, share, frame)
        return points

    @property
    def passive(self) -> bool:
        """Whether some control vertex has no track, so that a first pass has to find its motion gradient."""
        return len(self.follow) < len(self.controls)

    def given(self, end: int) -> Pose:
        """The pose given at an end."""
        if end not in self._given:
            self._given[end] = self.deformer.pose_of(self._poses[self.ends.index(end)])
        return self._given[end]

    def first_at(self, end: int) -> Pose:
        """The first pass at an end: what the key points alone make of the base solution there.

        It must not remember where a control vertex was dragged; where there is none, it is nearly the pose itself.
        """
        if end not in self._firsts:
            knot = self.span.first if end == self.span.first.frame else self.span.last
            assert knot is not None, "a span has the ends that it was made with"
            alone = knot.committed is not None and knot.committed.keys() <= set(self.keys)
            asked = frame_constraints(self.base, end, self.key_targets(end), {})
            modes = typical_modes(self.base, self.deformer, [])
            start = self.given(end) if alone else self.base.vertices[end]
            self._firsts[end] = self.deformer.solve_pose(asked, start=start, modes=modes)
        return self._firsts[end]

    def signature(self) -> bytes:
        """Digest of everything the span's frames depend on besides the base solution."""
        digest = hashlib.sha256(f"{self.ends} {self.span.stop} {self.smooth} {self.controls} {self.follow}".encode())
        for pose, corrections in zip(self._poses, self._corrections, strict=True):
            digest.update(np.ascontiguousarray(corrections).tobytes())
            digest.update(np.ascontiguousarray(pose[self.controls]).tobytes())
        return digest.digest()

    def _share(self, clock: Array | None) -> Array:
        if self.span.last is None:
            return np.zeros(self.span.stop - self.span.first.frame)
        return span_share(self.span.first.frame, self.span.last.frame, smooth=self.smooth, clock=clock)

    def _blend(self, values: list[Array], share: Array, frame: int) -> Array:
        if len(values) == 1:
            return values[0]
        weight = float(share[frame - self.span.first.frame])
        mixed: Array = (1 - weight) * values[0] + weight * values[1]
        return mixed

    def _gradient(self, vertex: int, frame: int, first_pass: Array | None) -> Array:
        """The track that a control vertex follows: that of a key point, or its own in the first pass."""
        if vertex in self.follow:
            track: Array = self.base.lifted[frame, self.follow[vertex]]
            return track
        assert first_pass is not None, "a vertex without a track needs a first pass"
        place: Array = first_pass[vertex]
        return place

    def _control_offsets(self, vertex: int) -> tuple[list[Array], Array]:
        """Boundary values of a control vertex: its place in both poses, also where it was not dragged."""
        firsts = [self.first_at(end).vertices if self.passive else None for end in self.ends]
        offsets = [
            pose[vertex] - self._gradient(vertex, end, first)
            for pose, end, first in zip(self._poses, self.ends, firsts, strict=True)
        ]
        nearest = self.follow.get(vertex)
        if nearest is None:
            nearest = int(np.argmin(((self.base.rest[self.keys] - self.base.rest[vertex]) ** 2).sum(axis=1)))
        return offsets, self._shares[nearest]


def _key_places(base: Base, knot: Knot) -> Array:
    places: Array = base.lifted[knot.frame].copy()
    for key, vertex in enumerate(base.keys.vertices.tolist()):
        if knot.committed is not None and vertex in knot.committed:
            places[key] = knot.committed[vertex]
    return places


def sorted_outward(frames: NDArray[np.int64], origin: int) -> list[int]:
    """Frames in the order of their distance from the edited one, later before earlier: t + 1, t - 1, t + 2, ..."""
    return sorted((int(frame) for frame in frames), key=lambda frame: (abs(frame - origin), frame < origin))
