"""What lies round a character, and how long it serves while the character moves on."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
DRIFT, GROWTH = 0.25, 1.2
"""Share of the radius by which the middle may move, and the factor by which the radius may change."""


@attrs.frozen(eq=False)
class Surroundings:
    """Points (p, 3), camera centres (n, 3) and height of the ground as laid out round a ``middle`` (3,).

    ``near`` are the points within four times the ``radius``. All are in the world's units.
    """

    points: Array
    centres: Array
    ground: float
    middle: Array
    radius: float
    near: Array

    def serves(self, points: Array, centres: Array, ground: float, middle: Array, radius: float) -> bool:
        """Whether it can stay for a character that stands elsewhere now: laying it anew costs half a frame's time."""
        return (
            ground == self.ground
            and float(np.linalg.norm(middle - self.middle)) <= DRIFT * self.radius
            and self.radius <= GROWTH * radius <= GROWTH**2 * self.radius
            and (points is self.points or np.array_equal(points, self.points))
            and (centres is self.centres or np.array_equal(centres, self.centres))
        )
