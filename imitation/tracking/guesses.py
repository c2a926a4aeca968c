"""Clicks where the user says that the point is hidden: its place is a guess, its look is that of what hides it."""

from __future__ import annotations

import attrs
import numpy as np

from imitation.tracking.chain import UNLIKE, Array, Chain
from imitation.tracking.track import GUESS, Click, Span, SpanPlan

LOST = UNLIKE
ASTRAY = 0.3
"""Confidence of a chain just before a hidden click: it may have slipped onto what hides the point long before."""
FADE = 4.0
"""Frames after which a guess says little of the places beside it."""


def anchored(plan: SpanPlan) -> tuple[bool, bool]:
    """Whether the span's left and right ends are clicks on something seen."""
    left, right = ((end is not None and end[0] not in plan.guessed) for end in (plan.left, plan.right))
    return left, right


def give_way(chain: Chain) -> Chain:
    """The chain up to where it no longer looks like its first click, two frames on end; from there straight on.

    What comes in front of the point drags the flow, and with it the chain, away with it.
    """
    unlike = chain.match < LOST
    lost = np.flatnonzero(unlike[1:-2] & unlike[2:-1])
    if not len(lost):
        return chain
    last, stop = int(lost[0]), len(chain.positions) - 1
    rows = np.arange(last, stop + 1)
    positions = chain.positions.copy()
    for axis in (0, 1):
        positions[last:, axis] = np.interp(rows, (last, stop), chain.positions[[last, stop], axis])
    hidden = chain.hidden.copy()
    hidden[last + 1 :] = True
    return attrs.evolve(chain, positions=positions, hidden=hidden)


def toward_guess(confidence: Array) -> Array:
    """Confidence (m,) of a chain from a click on something seen in frame 0 to a guess in the last.

    When the point went into hiding is not known: as likely in any frame as in any other.
    """
    frames = len(confidence)
    i = np.arange(frames)
    t = i / (frames - 1)
    believed = (1 - t) * confidence + t * np.minimum(confidence, ASTRAY)
    return np.maximum(believed, GUESS * np.exp(-(frames - 1 - i) / FADE))


def guessed_span(plan: SpanPlan) -> Span:
    """The straight line between two guesses, or the place of one up to an open end: nothing is there to follow."""
    frames = np.arange(plan.first, plan.last + 1)
    clicks: list[Click] = [end for end in (plan.left, plan.right) if end is not None]
    at = [frame for frame, _, _ in clicks]
    positions = np.stack([np.interp(frames, at, [click[axis] for click in clicks]) for axis in (1, 2)], axis=1)
    gap = np.abs(frames[:, None] - np.array(at)).min(axis=1)
    state = np.full(len(frames), "occluded", dtype="<U8")
    return Span(plan, positions, GUESS * np.exp(-gap / FADE), state, np.zeros(len(frames)))
