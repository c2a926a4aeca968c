"""Frames along x, as a value: what the ruler, the lanes and the mouse share."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

LABELS = 168
MARGIN = 10.0
CLOSEST = 48.0


@dataclass(frozen=True)
class Axis:
    """``x = left + (frame - first) * step``; ``first`` may be a fraction while scrolling.

    count : frames of the clip. width : pixels of the whole timeline, the label column included.
    step : pixels a frame, 0 for as many as make the clip fit.
    """

    count: int = 1
    width: int = 800
    first: float = 0.0
    step: float = 0.0

    @property
    def left(self) -> float:
        """Where frame ``first`` stands."""
        return LABELS + MARGIN

    @property
    def room(self) -> float:
        """Pixels between the first and the last frame shown."""
        return max(self.width - self.left - MARGIN - 8, 10.0)

    @property
    def fitted_step(self) -> float:
        """The pixels a frame at which the whole clip is seen."""
        return self.room / max(self.count - 1, 1)

    @property
    def pixels(self) -> float:
        """The pixels a frame in use."""
        return max(self.step, self.fitted_step) if self.step else self.fitted_step

    @property
    def last(self) -> float:
        """The last frame that is seen."""
        return min(self.first + self.room / self.pixels, float(self.count - 1))

    def x(self, frame: float) -> float:
        """Where a frame stands."""
        return self.left + (frame - self.first) * self.pixels

    def frame(self, x: float) -> int:
        """The frame nearest to an x, inside the clip."""
        return min(max(round(self.first + (x - self.left) / self.pixels), 0), max(self.count - 1, 0))

    def sized(self, width: int, count: int) -> Axis:
        """The same for another width or clip."""
        return replace(self, width=width, count=max(count, 1))._kept()

    def zoomed(self, factor: float, x: float) -> Axis:
        """Zoom so that the frame under x stays there."""
        at = self.first + (x - self.left) / self.pixels
        step = min(max(self.pixels * factor, self.fitted_step), max(CLOSEST, self.fitted_step))
        return replace(self, step=step, first=at - (x - self.left) / step)._kept()

    def scrolled(self, pixels: float) -> Axis:
        """Scroll by pixels."""
        return replace(self, first=self.first + pixels / self.pixels)._kept()

    def showing(self, frame: int) -> Axis:
        """Scroll so that a frame is seen."""
        if self.first <= frame <= self.last:
            return self
        return replace(self, first=frame - 0.5 * self.room / self.pixels)._kept()

    def whole(self) -> Axis:
        """Show the whole clip."""
        return replace(self, first=0.0, step=0.0)

    def _kept(self) -> Axis:
        latest = max(self.count - 1 - self.room / self.pixels, 0.0)
        return replace(self, first=min(max(self.first, 0.0), latest))

    def ticks(self) -> tuple[int, int]:
        """Frames between numbered ticks and between small ones, so that numbers stand at least 64 pixels apart."""
        wanted = 64.0 / self.pixels
        power = 10.0 ** math.floor(math.log10(max(wanted, 1.0)))
        large = next(int(factor * power) for factor in (1, 2, 5, 10) if factor * power >= wanted)
        return max(large, 1), max(large // (5 if large % 5 == 0 else 2), 1)
