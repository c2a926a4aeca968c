"""Interactive point tracking: the track of a point from a few clicks (paper A, Appendix)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, part, silent
from imitation.tracking.chain import Chain
from imitation.tracking.clip import PreparedClip, prepare_clip
from imitation.tracking.flow import FlowField, Picture
from imitation.tracking.guesses import anchored, give_way, guessed_span
from imitation.tracking.judge import judge
from imitation.tracking.paper import PaperOptions, solve_paper
from imitation.tracking.robust import SUBJECT, RobustOptions, solve_robust
from imitation.tracking.track import (
    Click,
    Interval,
    Span,
    SpanPlan,
    Track,
    assemble_track,
    check_absent,
    check_clicks,
    plan_spans,
)

Mode = Literal["robust", "paper"]
Options = RobustOptions | PaperOptions
Masks = Sequence[NDArray[np.bool_]]


def _options(mode: str, options: Options | None, masked: bool) -> Options:
    if mode not in ("robust", "paper"):
        raise InputError(f'The tracking mode must be "robust" or "paper", but got "{mode}".')
    wanted = RobustOptions if mode == "robust" else PaperOptions
    if options is None:
        return SUBJECT if masked and mode == "robust" else wanted()
    if not isinstance(options, wanted):
        raise InputError(f'The mode "{mode}" takes {wanted.__name__}, but got {type(options).__name__}.')
    return options


def _solve(clip: PreparedClip, plan: SpanPlan, options: Options, progress: Progress | None) -> Span:
    frames = range(plan.first, plan.last + 1)
    left, right = plan.left, plan.right
    robust, seen = isinstance(options, RobustOptions), anchored(plan)
    if robust and plan.guessed and not any(seen):
        return guessed_span(plan)
    backwards = left is None or (robust and seen == (False, True))
    order = list(reversed(frames)) if backwards else list(frames)
    start, stop = (right, left) if backwards else (left, right)
    if start is None:
        raise InputError(f"The span of frames {plan.first} to {plan.last} has no click at either end; click in one.")
    end = None if stop is None else stop[1:]
    chain: Chain
    if isinstance(options, PaperOptions):
        chain = solve_paper(clip, order, start[1:], end, options, progress)
    else:
        chain = solve_robust(clip, order, start[1:], end, options, progress, guess=bool(plan.guessed))
        chain = give_way(chain) if plan.guessed and end is not None else chain
    masked = clip.masks is not None
    return judge(plan, chain, (clip.height, clip.width), robust, masked)


def track_span(
    frames: Sequence[Picture] | PreparedClip,
    left: Click | None,
    right: Click | None,
    *,
    until: int | None = None,
    mode: Mode = "robust",
    options: Options | None = None,
    mask: Masks | None = None,
    hidden: Iterable[int] = (),
    flow: FlowField | Literal["lk"] | None = None,
    progress: Progress | None = None,
) -> Span:
    """Follow a point between two clicks, or from one click to an open end: the unit a program keeps.

    A pure function of its arguments (and of the frames between): a click elsewhere cannot change it.

    Parameters
    ----------
    left, right : (frame, x, y) of the clicks at the ends; None for an open end.
    until : frame where an open span ends, included; the first or last frame of the clip where omitted.
    frames, mode, options, mask, hidden, flow, progress : as for ``track_point``.

    Raises
    ------
    InputError : no click, clicks in the wrong order or outside, wrong mode.
    """
    clip = prepare_clip(frames, flow=flow, masks=mask)
    chosen = _options(mode, options, clip.masks is not None)
    given = [click for click in (left, right) if click is not None]
    check_clicks({frame: (x, y) for frame, x, y in given}, clip.count, clip.height, clip.width)
    first, last = given[0][0], given[-1][0]
    if left is None:
        first = 0 if until is None else until
    elif right is None:
        last = clip.count - 1 if until is None else until
    if not 0 <= first < last < clip.count:
        raise InputError(f"A span must run forward inside the clip, but this one goes from frame {first} to {last}.")
    guessed = tuple(click[0] for click in given if click[0] in set(hidden))
    return _solve(clip, SpanPlan(left, right, first, last, guessed), chosen, progress)


def track_point(
    frames: Sequence[Picture] | PreparedClip,
    clicks: Mapping[int, tuple[float, float]],
    *,
    mode: Mode = "robust",
    mask: Masks | None = None,
    absent: Iterable[Interval] = (),
    hidden: Iterable[int] = (),
    flow: FlowField | Literal["lk"] | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
) -> Track:
    """Follow a point through a clip from the user's clicks (paper A, Appendix).

    Between two clicks both of them guide the path; before the first and after the last the nearest one does.
    A click changes the two spans beside it and nothing else.

    Parameters
    ----------
    frames : sequence of uint8 RGB pictures (h, w, 3), or a ``PreparedClip`` shared by many points.
    clicks : frame -> (x, y), pixels of the full picture, pixel centres at integers. The path passes through them.
    mode : "robust", or "paper": eq. 13-14 and Algorithm 1 as printed.
    mask : one (h, w) bool array a frame, the subject: all else is painted over, so that thin limbs keep apart from what
        is behind them, and places off it are dear. Not used by the mode "paper". A ``PreparedClip`` has its
        own masks, and these are not looked at.
    absent : intervals (first, last), frames included, where the track does not exist: it ends before them and
        starts anew after them, where a click is.
    hidden : frames where something is in front of the point. A click in one of them says where the user guesses the
        point: the path passes through it, but what is seen there is not what is followed, and confidence is low.
        The mode "paper" follows it all the same.
    flow : dense flow from ``compute_flow``; None computes what is missing; "lk" gives a quick preview without it.
    options : settings of the mode.
    progress : gets the share done, several times a second; may raise ``Cancelled``.

    Returns
    -------
    Track : positions (n, 2), confidence (n,), state (n,), cost (n,).

    Raises
    ------
    InputError : no frames, no clicks, clicks outside the clip or the picture or not finite, masks or flow of
        another size, a click where the track is absent.
    """
    clip = prepare_clip(frames, flow=flow, masks=mask)
    chosen = _options(mode, options, clip.masks is not None)
    marks = check_clicks(clicks, clip.count, clip.height, clip.width)
    gaps = check_absent(absent, clip.count)
    unseen = tuple(hidden)
    plans = plan_spans(marks, clip.count, gaps, unseen)
    (progress or silent)(0.0)
    total, done, spans = sum(plan.last - plan.first for plan in plans), 0, []
    for plan in plans:
        length = plan.last - plan.first
        spans.append(_solve(clip, plan, chosen, part(progress, done / total, (done + length) / total)))
        done += length
    (progress or silent)(1.0)
    return assemble_track(clip.count, marks, spans, gaps, unseen)
