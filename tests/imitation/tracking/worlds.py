"""Small clips with exact truth: smooth random texture that moves, darkens, or passes behind a bar."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Frames = list[NDArray[np.uint8]]


class Texture:
    """A smooth random colour picture, defined at any place, repeated after ``period`` pixels."""

    def __init__(self, seed: int, period: int = 240, waves: int = 60) -> None:
        rng = np.random.default_rng(seed)
        self.k = 2 * np.pi / period * rng.integers(-14, 15, (waves, 2))
        self.phase = rng.uniform(0, 2 * np.pi, waves)
        self.colour = rng.normal(0, 1, (waves, 3)) * 110 / np.sqrt(waves)

    def __call__(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        """Colours (h, w, 3) at the grid of columns x (w,) and rows y (h,)."""
        # cos(a + b) = cos a cos b - sin a sin b turns the sum over waves into two matrix products.
        a, b = np.outer(y, self.k[:, 1]), np.outer(x, self.k[:, 0]) + self.phase
        return 128 + (
            np.einsum("hk,kc,wk->hwc", np.cos(a), self.colour, np.cos(b), optimize=True)
            - np.einsum("hk,kc,wk->hwc", np.sin(a), self.colour, np.sin(b), optimize=True)
        )


def picture(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Round to 8 bits."""
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def moving(
    frames: int = 21,
    size: tuple[int, int] = (200, 320),
    speed: float = 7.3,
    wave: float = 20.0,
    seed: int = 0,
    dimming: float = 0.0,
    bar: tuple[int, int] | None = None,
    bar_width: int = 60,
    bar_speed: float = 0.0,
) -> tuple[Frames, NDArray[np.float64]]:
    """A texture that moves sideways and in a sine; optionally darker and darker, or a grey bar over the point.

    Returns the frames and the true path (n, 2) of one point. ``bar`` = first and last frame of the bar,
    which is over the point in all of them and stands still or moves by ``bar_speed`` pixels a frame.
    """
    texture = Texture(seed)
    t = np.arange(frames)
    shift = np.stack([speed * t, wave * np.sin(2 * np.pi * t / max(frames - 1, 1))], axis=1)
    start = np.array([(size[1] - speed * (frames - 1)) / 2 + 0.3, size[0] / 2 + 0.4])
    path, pictures = start + shift, []
    rows, columns = np.arange(size[0], dtype=float), np.arange(size[1], dtype=float)
    for i in range(frames):
        colours = texture(columns - shift[i, 0], rows - shift[i, 1])
        shown = picture(colours * (1 - dimming * i / max(frames - 1, 1)))
        if bar is not None and bar[0] <= i <= bar[1]:
            middle = path[bar[0] : bar[1] + 1, 0].mean() + bar_speed * (i - (bar[0] + bar[1]) / 2)
            left = int(middle - bar_width / 2)
            shown[:, max(left, 0) : left + bar_width] = 128
        pictures.append(shown)
    return pictures, path
