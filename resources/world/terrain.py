"""The ground that the bodies walk on: flat, or a flight of stairs along +x."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import ArrayLike

from resources.world.skeleton import Array


@attrs.frozen
class Stairs:
    """A flight of stairs whose first riser stands at ``start`` (x, metres) on the ground z = 0.

    The treads run along y without end here; the scene gives them their width. ``count`` 0 is flat ground.
    """

    start: float = 0.0
    tread: float = 0.32
    rise: float = 0.12
    count: int = 7

    def step(self, x: ArrayLike) -> Array:
        """Number of the tread (...) under x (...); 0 is the ground, ``count`` the landing."""
        inside = np.floor((np.asarray(x, np.float64) - self.start) / self.tread) + 1
        step: Array = np.clip(inside, 0, self.count)
        return step

    def height(self, x: ArrayLike) -> Array:
        """Height (...) of the ground at x (...), metres."""
        return self.rise * self.step(x)

    def slope_height(self, x: ArrayLike, soft: float = 0.18) -> Array:
        """Height (...) of the line through the middles of the treads, its bends rounded over ``soft`` metres."""
        x = np.asarray(x, np.float64)
        if not self.count:
            return np.zeros_like(x)
        foot = self.start - self.tread / 2
        top = foot + self.count * self.tread
        slope = self.rise / self.tread
        height: Array = slope * soft * (np.logaddexp(0, (x - foot) / soft) - np.logaddexp(0, (x - top) / soft))
        return height

    def middle(self, x: ArrayLike) -> Array:
        """The middle of the tread nearest to x (...), as if the treads ran on over the ground and the landing."""
        if not self.count:
            return np.asarray(x, np.float64)
        index = np.round((np.asarray(x, np.float64) - self.start) / self.tread - 0.5)
        return self.start + (index + 0.5) * self.tread


FLAT = Stairs(count=0)
STAIRS = Stairs()
