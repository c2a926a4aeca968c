"""Characters and their shadows on one transparent sheet, to be laid over a frame or written with its alpha."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.rendering.mesh import Rendering
from imitation.rendering.occlusion import visibility

Picture = NDArray[np.uint8]
SINK = 0.05
"""Share of a character's radius that it may sink into the background unhidden: feet stand in what depth says."""

_ROUND = 8
"""Pixels round a place that may decide how much of it is hidden: the median, then the Gaussian."""
Box = tuple[slice, slice]


@attrs.frozen(eq=False)
class Layer:
    """What is laid over a frame.

    Attributes
    ----------
    rendering : the character.
    shadow : (h, w) how much of the frame's light it takes, 0 to 1, or None.
    """

    rendering: Rendering
    shadow: NDArray[np.float32] | None = None


@attrs.frozen(eq=False)
class Matte:
    """Layers flattened into one.

    Attributes
    ----------
    light : float32 (h, w, 3) sRGB levels multiplied by what covers; shadows are black.
    alpha : float32 (h, w) what is taken from the frame, by characters and shadows.
    cover : float32 (h, w) what is taken by characters alone.
    """

    light: NDArray[np.float32]
    alpha: NDArray[np.float32]
    cover: NDArray[np.float32]

    def over(self, frame: Picture) -> Picture:
        """Lay the sheet over a frame (h, w, 3)."""
        done: Picture = frame.copy()
        box = _box(self.alpha > 0)
        out = self.light[box] + (1 - self.alpha[box])[..., None] * frame[box]
        done[box] = np.clip(np.rint(out), 0, 255).astype(np.uint8)
        return done

    def rgba(self) -> Picture:
        """The sheet as uint8 (h, w, 4), colours not multiplied by alpha; a shadow is black that is partly clear."""
        made = np.zeros((*self.alpha.shape, 4), np.uint8)
        there = self.alpha > 1e-6
        made[there, :3] = np.clip(np.rint(self.light[there] / self.alpha[there, None]), 0, 255)
        made[..., 3] = np.clip(np.rint(255 * self.alpha), 0, 255)
        return made

    def linear(self) -> NDArray[np.float32]:
        """The sheet in linear light (h, w, 4), colours multiplied by alpha, for programs that composite so."""
        from imitation.rendering.mesh import linear

        there = self.alpha > 1e-6
        made = np.zeros((*self.alpha.shape, 4), np.float32)
        straight = np.clip(self.light[there] / self.alpha[there, None], 0, 255)
        made[there, :3] = linear(straight) * self.alpha[there, None]
        made[..., 3] = self.alpha
        return made


def flattened(
    layers: Sequence[Layer],
    shape: tuple[int, ...],
    *,
    background: NDArray[np.floating] | None = None,
    tolerance: float = 0.0,
    soft: bool = False,
) -> Matte:
    """Flatten layers, the nearer over the farther, less what the background hides; see ``composite``.

    Parameters
    ----------
    shape : (h, w) of the frame.
    """
    whole = Matte(*(np.zeros(size, np.float32) for size in ((*shape, 3), shape, shape)))
    touched = np.zeros(shape, bool)
    for layer in layers:
        touched |= layer.rendering.rgba[..., 3] > 0
        if layer.shadow is not None:
            touched |= layer.shadow > 0
    box = _box(touched)
    if not whole.alpha[box].size:
        return whole
    # Nothing happens elsewhere.
    cut = [_cut(each, box) for each in layers]
    shown: list[NDArray[np.float32] | None] = [None] * len(layers)
    if background is not None:
        wide, inner = _widened(box, shape)
        shown = [
            visibility(each.rendering.depth[wide], background[wide], tolerance, soft=soft)[inner] for each in layers
        ]
    part = _flattened(cut, shown)
    whole.light[box], whole.alpha[box], whole.cover[box] = part.light, part.alpha, part.cover
    return whole


def _box(wanted: NDArray[np.bool_]) -> Box:
    """The rows and columns that hold what is wanted."""
    rows, columns = np.flatnonzero(wanted.any(axis=1)), np.flatnonzero(wanted.any(axis=0))
    if not len(rows):
        return slice(0, 0), slice(0, 0)
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def _widened(box: Box, shape: tuple[int, ...]) -> tuple[Box, Box]:
    """A box with as much round it as smoothing reaches, and where the box lies in it."""
    starts = [max(0, side.start - _ROUND) for side in box]
    ends = [min(size, side.stop + _ROUND) for side, size in zip(box, shape, strict=True)]
    inner = [slice(side.start - start, side.stop - start) for side, start in zip(box, starts, strict=True)]
    return (slice(starts[0], ends[0]), slice(starts[1], ends[1])), (inner[0], inner[1])


def _cut(layer: Layer, box: Box) -> Layer:
    rendering = Rendering(layer.rendering.rgba[box], layer.rendering.depth[box])
    return Layer(rendering, None if layer.shadow is None else layer.shadow[box])


def _flattened(layers: Sequence[Layer], shown: Sequence[NDArray[np.float32] | None]) -> Matte:
    shape = layers[0].rendering.depth.shape
    light = np.zeros((*shape, 3), np.float32)
    open_share, bare = np.ones(shape, np.float32), np.ones(shape, np.float32)
    for layer in layers:
        if layer.shadow is not None:
            open_share *= 1 - layer.shadow
    # Farthest first, decided pixel by pixel.
    depths = np.stack([layer.rendering.depth for layer in layers])
    for place in np.argsort(-depths, axis=0, kind="stable") if len(layers) > 1 else np.zeros((len(layers), 1, 1), int):
        for index, layer in enumerate(layers):
            alpha = layer.rendering.rgba[..., 3].astype(np.float32) / 255
            if len(layers) > 1:
                alpha = np.where(place == index, alpha, np.float32(0))
            seen = shown[index]
            if seen is not None:
                alpha = alpha * seen
            light += alpha[..., None] * (layer.rendering.rgba[..., :3] - light)
            open_share *= 1 - alpha
            bare *= 1 - alpha
    return Matte(light, 1 - open_share, 1 - bare)


def grained(matte: Matte, sigma: float, seed: int) -> Matte:
    """The same sheet with noise of ``sigma`` grey levels where characters cover; seeded a frame as ``add_grain``."""
    noise = np.random.default_rng(seed).standard_normal(matte.light.shape, dtype=np.float32)
    return attrs.evolve(matte, light=matte.light + np.float32(sigma) * noise * matte.cover[..., None])
