"""Where a picture lies in its widget: zoom and offset, as a value.

Picture coordinates are pixels with centres at integers, so a picture of w x h covers [-0.5, w - 0.5] x [-0.5, h - 0.5].
Widget coordinates are logical pixels from the top-left corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

SMALLEST, LARGEST = 0.05, 64.0


@dataclass(frozen=True)
class View:
    """``widget = offset + scale * (picture + 0.5)``."""

    scale: float = 1.0
    x: float = 0.0
    y: float = 0.0

    def to_widget(self, points: ArrayLike) -> NDArray[np.float64]:
        """Widget places (..., 2) of picture points (..., 2)."""
        placed: NDArray[np.float64] = (np.asarray(points, np.float64) + 0.5) * self.scale + (self.x, self.y)
        return placed

    def to_picture(self, points: ArrayLike) -> NDArray[np.float64]:
        """Picture points (..., 2) of widget places (..., 2)."""
        found: NDArray[np.float64] = (np.asarray(points, np.float64) - (self.x, self.y)) / self.scale - 0.5
        return found

    def point(self, x: float, y: float) -> tuple[float, float]:
        """The widget place of one picture point, without an array."""
        return (x + 0.5) * self.scale + self.x, (y + 0.5) * self.scale + self.y

    def zoomed(self, factor: float, x: float, y: float) -> View:
        """Zoom so that the picture point under the widget place (x, y) stays there."""
        scale = min(max(self.scale * factor, SMALLEST), LARGEST)
        ratio = scale / self.scale
        return View(scale, x - (x - self.x) * ratio, y - (y - self.y) * ratio)

    def panned(self, dx: float, dy: float) -> View:
        """Move the picture by widget pixels."""
        return View(self.scale, self.x + dx, self.y + dy)


def fitted(picture: tuple[int, int], widget: tuple[int, int], margin: float = 0.0) -> View:
    """The view that shows a whole picture (w, h), centred in a widget (w, h)."""
    width, height = max(picture[0], 1), max(picture[1], 1)
    scale = min((widget[0] - 2 * margin) / width, (widget[1] - 2 * margin) / height)
    scale = min(max(scale, SMALLEST), LARGEST)
    return View(scale, (widget[0] - scale * width) / 2, (widget[1] - scale * height) / 2)
