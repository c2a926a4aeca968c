"""How far a solved chain is to be believed: confidence and state of each frame."""

from __future__ import annotations

import numpy as np

from imitation.tracking.chain import Array, Chain
from imitation.tracking.guesses import anchored, toward_guess
from imitation.tracking.track import GUESS, Span, SpanPlan, States

# Share of frames within 8 px of a person's click by the motion cost of their span, measured on real clips;
# the last knot on rendered animals.
COST_KNOTS = (2.0, 15.0, 70.0, 250.0, 800.0)
SHARE_KNOTS = (0.93, 0.78, 0.48, 0.33, 0.1)
# The same by the correlation with the clicks where masks cut the subject out, measured on rendered animals.
MATCH_KNOTS = (0.25, 0.45, 0.58, 0.68, 0.77, 0.88)
MATCH_SHARES = (0.4, 0.68, 0.84, 0.91, 0.96, 1.0)


def judge(plan: SpanPlan, chain: Chain, size: tuple[int, int], robust: bool, masked: bool = False) -> Span:
    """Turn a chain into a span: natural order, confidence, state, and NaN where an open end leaves the picture."""
    height, width = size
    backwards = plan.left is None or (robust and anchored(plan) == (False, True))
    turn = slice(None, None, -1 if backwards else 1)
    frames = len(chain.positions)
    x, y = chain.positions.T
    out = (x < -0.5) | (y < -0.5) | (x > width - 0.5) | (y > height - 0.5)
    positions = chain.positions.copy()
    state: States = np.full(frames, "visible", dtype="<U8")
    closed = plan.left is not None and plan.right is not None
    guessed = closed and robust and len(plan.guessed) > 0
    confidence = _confidence(chain, closed and not guessed, masked) if robust else np.full(frames, 0.5)
    if guessed:
        confidence = toward_guess(confidence)
    if robust:
        state[chain.hidden] = "occluded"
        confidence[chain.hidden] *= 0.5
    if closed:
        state[out] = "outside"
    elif out.any():
        gone = int(np.argmax(out))
        state[gone:], positions[gone:], confidence[gone:] = "outside", np.nan, 0.0
    state[0], confidence[0] = "visible", 1.0
    if closed:
        state[-1], confidence[-1] = ("occluded", GUESS) if guessed else ("visible", 1.0)
    steps = chain.steps
    cost = np.concatenate([[0.0], steps[1:][::-1]]) if backwards else steps.copy()
    return Span(plan, positions[turn].copy(), confidence[turn].copy(), state[turn].copy(), cost)


def _confidence(chain: Chain, closed: bool, masked: bool) -> Array:
    frames = len(chain.positions)
    i = np.arange(frames)
    # An open end knows only what lies before it; between clicks the whole span's cost tells best.
    spent = np.full(frames, chain.steps.sum()) if closed else np.cumsum(chain.steps)
    share = np.interp(np.log(np.maximum(spent, 1e-3)), np.log(COST_KNOTS), SHARE_KNOTS)
    if masked:
        # Without the background in its windows, the look itself tells a point from what slipped in front of it.
        share = np.sqrt(share) * np.interp(chain.match, MATCH_KNOTS, MATCH_SHARES)
    gap = np.minimum(i, frames - 1 - i) if closed else i
    near = np.exp(-gap / 3.0)
    confidence: Array = share + (1.0 - share) * near
    return confidence
