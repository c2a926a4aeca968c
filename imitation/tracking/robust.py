"""Robust mode: many guesses of the path, joined by the chain that agrees best with flow and appearance."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.progress import Progress, part
from imitation.tracking.chain import Array, Chain, Place, hidden_frames
from imitation.tracking.clip import PreparedClip

KIN_WINDOW = 15  # small, so that little of the background is in it
BESIDE = 8  # frames beside hidden ones that may have been dragged along


@attrs.frozen
class RobustOptions:
    """Settings of the robust mode; the defaults were found on real clips and are what ``track_point`` uses.

    Attributes
    ----------
    window : side of the template, pixels (odd).
    tolerance : disagreement with the flow that is cheap, pixels a frame.
    look_alikes : peaks of window correlation taken per template and search centre; 0 leaves the search out.
    reach : greatest radius of that search, pixels; it is 10 + 3 * (frames to the nearer click) below.
    local_window : side of the window of local motion, pixels (odd).
    settle : how far a point beside hidden frames is drawn to a place that looks like the clicks; 0 leaves that out.
    likeness : least correlation with a click for that.
    """

    window: int = 31
    tolerance: float = 6.0
    look_alikes: int = 5
    reach: float = 50.0
    local_window: int = 21
    settle: float = 6.0
    likeness: float = 0.8


SUBJECT = RobustOptions(window=21, local_window=15, tolerance=5.0)
"""Where masks cut the subject out: smaller windows hold a thin limb, and its flow is to be trusted more."""


def _follow_local(clip: PreparedClip, order: Sequence[int], start: Place, half: int, report: Progress) -> Array:
    from imitation.tracking.kernels import local_motion

    path = np.empty((len(order), 2))
    path[0] = start
    for i in range(1, len(order)):
        first, second = clip.look_greys(order[i - 1]), clip.look_greys(order[i])
        path[i] = local_motion(first, second, path[i - 1, 0], path[i - 1, 1], half, 20)
        report(i / len(order))
    return path


def _follow_flow(
    clip: PreparedClip, order: Sequence[int], start: Place, report: Progress, plain: bool = False
) -> Array:
    from imitation.tracking.kernels import HALF_TO_FLOAT, flow_at

    path = np.empty((len(order), 2))
    path[0] = start
    for i in range(1, len(order)):
        x, y = path[i - 1]
        bits = clip.flow(order[i - 1], order[i]) if plain else clip.subject_flow(order[i - 1], order[i])
        scale = clip.scale if plain else clip.subject_scale
        u, v = flow_at(bits, HALF_TO_FLOAT, scale, x, y, clip.mask(order[i - 1]))
        path[i] = x + u, y + v
        report(i / len(order))
    return path


def _guesses(
    clip: PreparedClip, order: Sequence[int], start: Place, stop: Place | None, half: int, report: Progress, guess: bool
) -> tuple[Array, Array]:
    """Guessed paths (m, p, 2) from the clicks, and the centres (m, c, 2) around which look-alikes are sought."""
    t = np.linspace(0, 1, len(order))[:, None]
    backwards = order[::-1]
    sources = [part(report, a / 4, (a + 1) / 4) for a in range(4)]
    ahead = [_follow_local(clip, order, start, half, sources[0])]
    if not clip.preview:
        ahead.append(_follow_flow(clip, order, start, sources[1]))
        if clip.masks is not None:
            ahead.append(_follow_flow(clip, order, start, sources[1], True))  # masks may be wrong
    if stop is None:
        return np.stack(ahead, axis=1), np.stack(ahead, axis=1)
    line = (1 - t) * np.array(start) + t * np.array(stop)
    if guess:
        # Nothing is followed back from there: what is seen is in front of the point.
        bent = [forward + t * (np.array(stop) - forward[-1]) for forward in ahead]
        return np.stack([*ahead, line, *bent], axis=1), np.stack([line, ahead[0]], axis=1)
    back = [_follow_local(clip, backwards, stop, half, sources[2])[::-1]]
    if not clip.preview:
        back.append(_follow_flow(clip, backwards, stop, sources[3])[::-1])
        if clip.masks is not None:
            back.append(_follow_flow(clip, backwards, stop, sources[3], True)[::-1])
    paths = []
    for forward, backward in zip(ahead, back, strict=True):
        paths += [forward, backward, (1 - t) * forward + t * backward]
    centres = [line, paths[2]]
    paths.append(line)
    for forward, backward in zip(ahead, back, strict=True):
        # A drift that grows evenly is the share of the miss at the other click.
        paths += [forward + t * (np.array(stop) - forward[-1]), backward + (1 - t) * (np.array(start) - backward[0])]
    return np.stack(paths, axis=1), np.stack(centres, axis=1)


@attrs.frozen(eq=False)
class _Appearance:
    """Templates of the clicks (one or two) at full size and at a quarter of it, with their norms."""

    fine: NDArray[np.float32]
    norms: Array
    coarse: NDArray[np.float32]
    coarse_norms: Array

    @classmethod
    def of(cls, clip: PreparedClip, clicks: Sequence[tuple[int, Place]], half: int) -> _Appearance:
        from imitation.tracking.robust_kernels import make_template

        fine = [make_template(clip.looks(frame)[0], x, y, half) for frame, (x, y) in clicks]
        small = max(2, round(half / 4))
        coarse = [make_template(clip.looks(frame)[2], x / 4, y / 4, small) for frame, (x, y) in clicks]
        stacks = [np.stack([part[i] for part in found]) for found in (fine, coarse) for i in (0, 1)]
        return cls(*stacks)


def solve_robust(
    clip: PreparedClip,
    order: Sequence[int],
    start: Place,
    stop: Place | None,
    options: RobustOptions,
    progress: Progress | None,
    guess: bool = False,
) -> Chain:
    """Solve one run of neighbouring frames, ``order``, from a click in its first to a click in its last (or open).

    Candidates of a frame are the guessed paths and the look-alikes of the clicks; dynamic programming picks the
    chain of least cost: appearance against both clicks, and disagreement of each step with the flow both ways.
    Where the last click is a ``guess`` of a hidden place, the chain ends there but only the first says how it looks.
    """
    from imitation.tracking.kernels import HALF_TO_FLOAT
    from imitation.tracking.robust_kernels import cheapest_chain, describe, flows_at, kinship, search

    half = options.window // 2
    paths, centres = _guesses(clip, order, start, stop, options.local_window // 2, part(progress, 0.0, 0.4), guess)
    frames, guesses = paths.shape[:2]
    one = stop is None or guess
    clicks = [(order[0], start)] if stop is None or guess else [(order[0], start), (order[-1], stop)]
    looks = _Appearance.of(clip, clicks, half)
    searching = options.look_alikes > 0 and not clip.preview
    most = guesses + (options.look_alikes * len(clicks) * centres.shape[1] if searching else 0)
    places, counts = np.zeros((frames, most, 2)), np.ones(frames, np.int64)
    facts, ahead, back = np.zeros((frames, most, 3)), np.zeros((frames, most, 2)), np.zeros((frames, most, 2))
    report = part(progress, 0.4, 1.0)
    for i, frame in enumerate(order):
        levels, mask = clip.looks(frame), clip.mask(frame)
        if i == 0 or (i == frames - 1 and stop is not None):
            places[i, 0] = start if i == 0 or stop is None else stop
        else:
            places[i, :guesses] = paths[i]
            count, gap = guesses, i if one else min(i, frames - 1 - i)
            if searching:
                radius = min(10.0 + 3 * gap, options.reach)
                for x, y in centres[i]:
                    count = search(
                        levels[0], levels[2], 4, x, y, radius, looks.fine, looks.norms, looks.coarse,
                        looks.coarse_norms, options.look_alikes, places[i], count,
                    )  # fmt: skip
            counts[i] = count
        weight = 1.0 if one else (frames - 1 - i) / (frames - 1)
        describe(levels[0], places[i], counts[i], looks.fine, looks.norms, weight, mask, facts[i])
        for other, out in ((i + 1, ahead), (i - 1, back)):
            if 0 <= other < frames and not clip.preview:
                bits = clip.subject_flow(frame, order[other])
                flows_at(bits, HALF_TO_FLOAT, clip.subject_scale, places[i], counts[i], mask, out[i])
            elif 0 <= other < frames:
                _local_flows(clip, frame, order[other], places[i], counts[i], options, out[i])
        report((i + 1) / frames)
    data = np.ascontiguousarray(facts[:, :, 0])
    data[0] = 0
    chain, steps, margin = cheapest_chain(places, counts, data, ahead, back, options.tolerance**2)
    rows = np.arange(frames)
    chosen, turned = facts[rows, chain], back[rows, chain]
    positions = places[rows, chain]
    gap_of = np.zeros(frames)
    gap_of[1:] = np.hypot(*(ahead[rows[:-1], chain[:-1]] + turned[1:]).T)
    match = np.maximum(chosen[:, 1], chosen[:, 2])
    kin = np.ones(frames)
    for i in range(1, frames):
        pictures = clip.looks(order[i - 1])[0], clip.looks(order[i])[0]
        kin[i] = kinship(pictures[0], *positions[i - 1], pictures[1], *positions[i], KIN_WINDOW // 2)
    hidden = hidden_frames(match, kin)
    if options.settle > 0 and hidden.any():
        _settle(clip, order, positions, match, hidden, looks, stop is not None, options, guess)
    return Chain(positions, steps, match, gap_of, margin, hidden)


def _settle(
    clip: PreparedClip,
    order: Sequence[int],
    positions: Array,
    match: Array,
    hidden: NDArray[np.bool_],
    looks: _Appearance,
    closed: bool,
    options: RobustOptions,
    guess: bool,
) -> None:
    """Draw the path beside hidden frames onto places that look like the clicks; frames between two such move along.

    What passes in front drags the flow beside it, and with it the path.
    """
    from imitation.tracking.robust_kernels import settle

    frames = len(order)
    shift = np.zeros((frames, 2))
    near = np.zeros(frames, bool)
    for at in np.flatnonzero(hidden):
        near[max(at - BESIDE, 0) : at + BESIDE + 1] = True
    sure = ~near
    for i in np.flatnonzero(near[: -1 if closed else frames]).tolist():
        weight = (frames - 1 - i) / (frames - 1) if closed and not guess else 1.0
        x, y, found = settle(
            clip.looks(order[i])[0], *positions[i], looks.fine, looks.norms, weight, options.settle, options.likeness
        )  # fmt: skip
        if found >= options.likeness:
            shift[i], sure[i], match[i] = positions[i] - (x, y), True, found
    sure[0], sure[-1] = True, sure[-1] or closed
    shift[0] = 0
    rows = np.flatnonzero(sure)
    for axis in (0, 1):
        positions[:, axis] -= np.interp(np.arange(frames), rows, shift[rows, axis])


def _local_flows(
    clip: PreparedClip, frame: int, other: int, places: Array, count: int, options: RobustOptions, out: Array
) -> None:
    from imitation.tracking.kernels import local_motion

    first, second, half = clip.look_greys(frame), clip.look_greys(other), options.local_window // 2
    for k in range(count):
        x, y = places[k]
        tx, ty = local_motion(first, second, x, y, half, 10)
        out[k] = tx - x, ty - y
