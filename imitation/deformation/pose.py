"""A solved pose with what a warm start and a report need."""

from __future__ import annotations

import attrs

from imitation.geometry.projection import Array


@attrs.frozen(eq=False)
class Pose:
    """One solved frame.

    Attributes
    ----------
    vertices : (n, 3) in the caller's order and units.
    inner : (m, 3) welded vertices in the solver's order and units. turns : (m, 4) their rotations as quaternions.
    iterations : steps made. step : last root mean square step over the diagonal. converged : whether that is within
        the tolerance.
    warnings : one sentence each about what the constraints leave open or cannot have.
    """

    vertices: Array
    inner: Array
    turns: Array
    iterations: int = 0
    step: float = 0.0
    converged: bool = True
    warnings: tuple[str, ...] = ()
