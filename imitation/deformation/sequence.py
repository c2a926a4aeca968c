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

MANY = 25
"""Steps in a frame that say that the slow directions have changed."""
PATIENCE = 8
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

    A frame begins at the straight continuation of the two before it, so that all frames lag alike and little. The
    slow directions are shared by frames with the same handles.
    """
    previous: ArrayLike | Pose | None = start
    earlier: Pose | None = None
    modes: Modes | None = None
    handles: bytes | None = None
    age = 0
    for asked in frames:
        rows = build_rows(deformer.mesh, asked)
        begin = previous
        if isinstance(previous, Pose) and earlier is not None and iterations is None:
            begin = _continued(deformer, rows, earlier, previous)
        same = rows.handles.tobytes() + rows.owner.tobytes()
        if same != handles:
            modes, handles, age = None, same, 0
        if not len(rows.handles) or deformer.method == "paper":
            pose = deformer.solve_pose(asked, start=begin, iterations=iterations, tolerance=tolerance, most=most)
        else:
            first = deformer.begin(rows, begin)
            if modes is None and iterations is None:
                modes = deformer.slow_modes(rows, first[0])
            pose = deformer.solve_rows(rows, first, iterations, tolerance, most, modes)
        age += 1
        if pose.iterations > MANY and age > PATIENCE:
            modes, age = None, 0
        earlier = previous if isinstance(previous, Pose) else None
        previous = pose
        yield pose


def _continued(deformer: Deformer, rows: Rows, earlier: Pose, previous: Pose) -> Pose:
    """The straight continuation of two poses, or the later one where that is nearer to what is asked (noise)."""
    place = deformer.system.place[rows.handles]
    ahead = 2 * previous.inner - earlier.inner
    far = [float(np.square(residuals(rows, inner[place])).sum()) for inner in (ahead, previous.inner)]
    return attrs.evolve(previous, inner=ahead) if far[0] < far[1] else previous
