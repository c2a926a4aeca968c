"""The printed mode: eq. 13-14 and Algorithm 1 of paper A's Appendix, four passes from coarse to fine."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.progress import Progress, part
from imitation.tracking.chain import Array, Chain, Place
from imitation.tracking.clip import LEVELS, PreparedClip

BLOCK = 8


@attrs.frozen
class PaperOptions:
    """Settings of the printed mode; the defaults are the printed numbers where the paper gives one.

    Attributes
    ----------
    window : side of the window W, pixels of each level (odd; Fig. 18 shows about 11).
    appearance_weight : lambda_1 of eq. 14.
    motion_weight : lambda_2 of eq. 14, for colours 0..255 and positions in full-size pixels. At 10 the mode scores
        better on real clips: the printed 0.1 is nearly without effect.
    radii, spacings : r and d of Algorithm 1 in each pass, pixels of that pass's level; the paper prints the first.
    between_pixels : whether the last pass ends with a parabola step, which the paper does not have.
    """

    window: int = 11
    appearance_weight: float = 1.0
    motion_weight: float = 0.1
    radii: tuple[float, ...] = (10.0, 7.0, 5.0, 3.0)
    spacings: tuple[float, ...] = (3.0, 2.5, 2.0, 1.5)
    between_pixels: bool = True


def _template(clip: PreparedClip, frame: int, place: Place, level: int, half: int) -> NDArray[np.float32]:
    from imitation.tracking.kernels import read_colours

    rows = np.empty((2 * half + 1, 3 * (2 * half + 1)), np.float32)
    read_colours(clip.colours(frame)[level], place[0] / 2**level, place[1] / 2**level, half, rows)
    return rows


@attrs.frozen(eq=False)
class _Ends:
    """Clicks of a run at one pyramid level: places and windows; an open run uses the left one twice."""

    left: NDArray[np.float32]
    right: NDArray[np.float32]
    closed: bool


def _one_pass(
    clip: PreparedClip,
    order: Sequence[int],
    path: Array,
    ends: _Ends,
    options: PaperOptions,
    step: int,
    report: Progress,
) -> tuple[Array, Array]:
    """One pass over the frames of ``order`` (its first is given): new path (m, 2) and chain cost per frame (m,)."""
    from imitation.tracking.kernels import read_colours
    from imitation.tracking.paper_kernels import MOST, advance, place_between_pixels, prune

    level = LEVELS - 1 - step
    scale, frames = float(2**level), len(order)
    size = options.window * options.window * 3
    places = np.zeros((frames, MOST, 2))
    costs, come = np.zeros((frames, MOST)), np.zeros((frames, MOST), np.int64)
    counts = np.ones(frames, np.int64)
    windows = np.zeros((2, MOST, size), np.float32)
    first = np.empty(ends.left.shape, np.float32)
    read_colours(clip.colours(order[0])[level], path[0, 0] / scale, path[0, 1] / scale, options.window // 2, first)
    windows[0, 0], places[0, 0] = first.ravel(), path[0] / scale
    for i in range(1, frames):
        now = windows[i % 2]
        weight = (frames - 1 - i) / (frames - 1) if ends.closed else 1.0
        if ends.closed and i == frames - 1:
            places[i, 0], now[0] = path[i] / scale, ends.right.ravel()
        else:
            x, y = path[i] / scale
            image = clip.colours(order[i])[level]
            counts[i] = prune(
                image, x, y, options.radii[step], options.spacings[step], ends.left, ends.right, weight,
                places[i], now, costs[i],
            )  # fmt: skip
        advance(
            places[i - 1], windows[(i - 1) % 2], costs[i - 1], counts[i - 1], places[i], now, costs[i], counts[i],
            float(options.window**2), options.appearance_weight, options.motion_weight, scale, come[i],
        )  # fmt: skip
        report(i / frames)
    chosen = int(np.argmin(costs[-1, : counts[-1]]))
    out, total = np.empty((frames, 2)), np.zeros(frames)
    for i in range(frames - 1, -1, -1):
        out[i], total[i] = places[i, chosen] * scale, costs[i, chosen]
        chosen = int(come[i, chosen])
    out[0] = path[0]
    if ends.closed:
        out[-1] = path[-1]
    if level == 0 and options.between_pixels:
        for i in range(1, frames - 1 if ends.closed else frames):
            weight = (frames - 1 - i) / (frames - 1) if ends.closed else 1.0
            image = clip.colours(order[i])[0]
            out[i] = place_between_pixels(image, out[i, 0], out[i, 1], ends.left, ends.right, weight)
    return out, total


def _solve_run(
    clip: PreparedClip,
    order: Sequence[int],
    path: Array,
    templates: tuple[tuple[int, Place], tuple[int, Place]],
    closed: bool,
    options: PaperOptions,
    progress: Progress,
) -> tuple[Array, Array]:
    half, total = options.window // 2, np.zeros(len(order))
    for step in range(LEVELS):
        level = LEVELS - 1 - step
        left, right = (_template(clip, frame, place, level, half) for frame, place in templates)
        report = part(progress, step / LEVELS, (step + 1) / LEVELS)
        path, total = _one_pass(clip, order, path, _Ends(left, right, closed), options, step, report)
    return path, total


def solve_paper(
    clip: PreparedClip,
    order: Sequence[int],
    start: Place,
    stop: Place | None,
    options: PaperOptions,
    progress: Progress | None,
) -> Chain:
    """Solve one run of neighbouring frames from a click in its first to one in its last (eq. 13-14, Algorithm 1).

    The paper starts from the straight line between two clicks. Where the far end is open there is no line: blocks
    of eight frames are solved one after another, each started where the one before ended, w(t) = 1.
    """
    frames = len(order)
    if stop is not None:
        t = np.linspace(0, 1, frames)[:, None]
        line = (1 - t) * np.array(start) + t * np.array(stop)
        templates = ((order[0], start), (order[-1], stop))
        positions, total = _solve_run(clip, order, line, templates, True, options, part(progress, 0.0, 1.0))
        steps = np.diff(total, prepend=0.0)
    else:
        positions, steps = np.empty((frames, 2)), np.zeros(frames)
        positions[0] = start
        templates = ((order[0], start), (order[0], start))
        for first in range(0, frames - 1, BLOCK):
            block = order[first : first + BLOCK + 1]
            report = part(progress, first / frames, min(first + BLOCK, frames) / frames)
            still = np.repeat(positions[first : first + 1], len(block), axis=0)
            path, total = _solve_run(clip, block, still, templates, False, options, report)
            positions[first + 1 : first + len(block)] = path[1:]
            steps[first + 1 : first + len(block)] = np.diff(total)
    steps[0] = 0
    nothing = np.full(frames, np.nan)
    return Chain(positions, steps, nothing, nothing, nothing, np.zeros(frames, bool))
