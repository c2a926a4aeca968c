"""Whole sequences: each frame begins where the frames before it point to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.deformation.constraints import FrameConstraints, Rows, build_rows
from imitation.deformation.pose import Pose
from imitation.deformation.start import residuals

if TYPE_CHECKING:
    from imitation.deformation.deformer import Deformer
    from imitation.deformation.modes import Modes

LONG = 30
"""Frames from which on more slow directions are worth their price."""
MANY = 45
"""Steps in a frame that say that the slow directions have changed: those of rays do as the body turns."""
PATIENCE = 24
"""Frames that pass at least before they are found anew."""


def run(
    deformer: Deformer,
    frames: Sequence[FrameConstraints],
    start: ArrayLike | Pose | None,
    tolerance: float,
    most: int,
    iterations: int | None,
) -> Iterator[Pose]:
    """Solve the frames in order, each to the tolerance.

    A frame begins at the continuation of those before it, so that all frames lag alike and little. The
    slow directions are shared by frames with the same handles.
    """
    previous: ArrayLike | Pose | None = start
    before: list[Pose] = []
    modes: Modes | None = None
    handles: bytes | None = None
    age = 0
    for asked in frames:
        rows = build_rows(deformer.mesh, asked)
        begin = previous
        if before and iterations is None and len(rows.handles):
            begin = _continued(deformer, rows, before)
        same = rows.handles.tobytes() + rows.owner.tobytes()
        if same != handles:
            modes, handles, age = None, same, 0
        if not len(rows.handles) or deformer.method == "paper":
            pose = deformer.solve_pose(asked, start=begin, iterations=iterations, tolerance=tolerance, most=most)
        else:
            first = deformer.begin(rows, begin)
            if modes is None and iterations is None:
                modes = deformer.slow_modes(rows, first[0], many=len(frames) >= LONG)
            pose = deformer.solve_rows(rows, first, iterations, tolerance, most, modes)
        age += 1
        if not rows.pinned.all() and pose.converged and pose.iterations > MANY and age > PATIENCE:
            modes, age = None, 0
        previous = pose
        before = [*before[-2:], pose]
        yield pose


def _continued(deformer: Deformer, rows: Rows, before: list[Pose]) -> Pose:
    """The last pose, or its straight or parabolic continuation, whichever is nearest to what is asked.

    Noise makes the continuations worse than the last pose, smooth motion makes them much better.
    """
    place = deformer.system.place[rows.handles]
    last = before[-1].inner
    guesses = [last]
    if len(before) > 1:
        guesses.append(2 * last - before[-2].inner)
    if len(before) > 2:
        guesses.append(3 * (last - before[-2].inner) + before[-3].inner)
    far = [float(np.square(residuals(rows, guess[place])).sum()) for guess in guesses]
    return attrs.evolve(before[-1], inner=guesses[int(np.argmin(far))])
