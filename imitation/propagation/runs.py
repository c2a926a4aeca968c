"""Frames solved one after the other, away from an edited frame: what an edit changes differs little between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

import attrs
import numpy as np

from imitation.motion.banded import Array
from imitation.propagation.base import Base
from imitation.propagation.edits import typical_modes

if TYPE_CHECKING:
    from imitation.deformation import Deformer, FrameConstraints
    from imitation.deformation.pose import Pose

Places = dict[int, Array]


class Pass:
    """One pass over some frames in a fixed order: the same handles, each frame begun at what the last ones point to.

    What is carried on is not the pose, which moves as the subject does, but how far it lies from a reference of the
    same frame: the base solution in the first pass, the first pass in the second. References and poses are (m, 3) in
    the solver's order and units.
    """

    def __init__(self, base: Base, deformer: Deformer, controls: Sequence[int], pose: Pose, reference: Array) -> None:
        self.base, self.deformer = base, deformer
        # The same for all frames, so they are asked for once.
        self._modes = typical_modes(base, deformer, list(controls))
        self._away, self._last = [pose.inner - reference], pose

    def solve(self, frame: int, targets: Array, places: Mapping[int, Array], reference: Array) -> Pose:
        """Solve a frame for key points at targets (k, 3) and control vertices at their places, world."""
        from imitation.deformation.constraints import build_rows
        from imitation.deformation.start import residuals

        deformer = self.deformer
        rows = build_rows(deformer.mesh, frame_constraints(self.base, frame, targets, places))
        guesses = [reference + self._away[-1]]
        if len(self._away) > 1:
            guesses.append(reference + 2 * self._away[-1] - self._away[-2])
        handles = deformer.system.place[rows.handles]
        far = [float(np.square(residuals(rows, guess[handles])).sum()) for guess in guesses]
        begin = attrs.evolve(self._last, inner=guesses[int(np.argmin(far))])
        pose = deformer.solve_rows(rows, deformer.begin(rows, begin), modes=self._modes)
        self._away, self._last = [*self._away[-1:], pose.inner - reference], pose
        return pose


class Goals(Protocol):
    """What a span asks of its frames."""

    base: Base
    deformer: Deformer
    controls: list[int]

    @property
    def passive(self) -> bool:
        """Whether the motion gradient of a control vertex has to be found by a first pass."""

    def key_targets(self, frame: int) -> Array:
        """Places (k, 3) of the key points in a frame."""

    def control_targets(self, frame: int, first_pass: Array | None) -> Places:
        """Places of the control vertices in a frame, given the first pass (v, 3) where one is needed."""

    def given(self, end: int) -> Pose:
        """The pose given at an end of the span."""

    def first_at(self, end: int) -> Pose:
        """The first pass at an end of the span."""


class Run:
    """Frames in the order in which they are solved, and the edited end that they lead away from."""

    def __init__(self, goals: Goals, end: int, frames: range) -> None:
        self.goals, self.end, self.frames = goals, end, frames
        self._waiting: dict[int, Array] = {}
        self._next = 0
        self._first: Pass | None = None
        self._second: Pass | None = None

    def solve(self, frame: int) -> Array:
        """Vertices (v, 3) of a frame; those before it are solved on the way and kept until they are asked for."""
        while frame not in self._waiting:
            now = self.frames[self._next]
            self._waiting[now] = self._solve(now)
            self._next += 1
        return self._waiting.pop(frame)

    def _solve(self, frame: int) -> Array:
        goals = self.goals
        targets = goals.key_targets(frame)
        reference = goals.deformer.inward(goals.base.vertices[frame])
        found: Array | None = None
        if goals.passive or not goals.controls:
            first = self._begin_first().solve(frame, targets, {}, reference)
            found, reference = first.vertices, first.inner
            if not goals.controls:
                return found
        places = goals.control_targets(frame, found)
        return self._begin_second().solve(frame, targets, places, reference).vertices

    def _begin_first(self) -> Pass:
        if self._first is None:
            goals = self.goals
            self._first = Pass(goals.base, goals.deformer, [], goals.first_at(self.end), self._of_base())
        return self._first

    def _begin_second(self) -> Pass:
        if self._second is None:
            goals = self.goals
            reference = goals.first_at(self.end).inner if goals.passive else self._of_base()
            self._second = Pass(goals.base, goals.deformer, goals.controls, goals.given(self.end), reference)
        return self._second

    def _of_base(self) -> Array:
        base, deformer = self.goals.base, self.goals.deformer
        if self.end:
            return deformer.inward(base.vertices[self.end])
        # Frame 0 is not solved but given, so how far its solution lies from it says nothing about frame 1.
        asked = frame_constraints(base, 0, base.lifted[0], {})
        return deformer.solve_pose(asked, start=base.vertices[0], modes=typical_modes(base, deformer, [])).inner


def frame_constraints(base: Base, frame: int, targets: Array, places: Mapping[int, Array]) -> FrameConstraints:
    """Constraints of a frame: key points as hard as their tracks are trusted, control vertices hard."""
    from imitation.deformation import FrameConstraints

    keys = base.keys.vertices.tolist()
    points = dict(zip(keys, targets, strict=True)) | dict(places)
    softness = dict(zip(keys, base.softness[frame].tolist(), strict=True))
    return FrameConstraints(points=points, softness=softness)
