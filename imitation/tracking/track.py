"""What tracking gives: a track of a clip, and the spans between clicks that it is made of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]
States = NDArray[np.str_]
State = Literal["visible", "occluded", "outside"]
Click = tuple[int, float, float]
Interval = tuple[int, int]
GUESS = 0.6
"""Confidence of a click where the point is hidden."""


@attrs.frozen
class SpanPlan:
    """A run of frames that is solved on its own: between two clicks, or from one click to an open end.

    Attributes
    ----------
    left, right : (frame, x, y) of the click at that end, or None where the end is open.
    first, last : frames of the span, both included (the clicks' own frames belong to it).
    guessed : frames of those of its clicks where the user says that the point is hidden.
    """

    left: Click | None
    right: Click | None
    first: int
    last: int
    guessed: tuple[int, ...] = ()


@attrs.frozen(eq=False)
class Span:
    """A solved span of m frames.

    Attributes
    ----------
    plan : what was solved.
    positions : (m, 2) pixels, NaN where the point is out of the picture in an open span.
    confidence : (m,) in [0, 1], 1 at clicks.
    state : (m,) "visible", "occluded" or "outside".
    cost : (m,) cost of the step into each frame, in the mode's own unit (0 in the first).
    """

    plan: SpanPlan
    positions: Array
    confidence: Array
    state: States
    cost: Array


@attrs.frozen(eq=False)
class Track:
    """A point followed through a clip of n frames.

    Attributes
    ----------
    positions : (n, 2) pixels (x right, y down, pixel centres at integers), NaN where the track is absent.
    confidence : (n,) in [0, 1]: the expected share of frames like this one within 8 px of a person's click
        (854 x 480); 1 at clicks (0.6 where hidden), 0 where absent.
    state : (n,) "visible"; "occluded" (nothing there looks like the clicks, and the flow does not lead there);
        "outside" (left the picture, or ended by the user).
    cost : (n,) cost of the step into each frame; its sum over a span ranks spans and tracks.
    clicks : frames of the user's clicks, ascending.
    absent : intervals (first, last) where the user said that the track does not exist.
    """

    positions: Array
    confidence: Array
    state: States
    cost: Array
    clicks: tuple[int, ...]
    absent: tuple[Interval, ...] = ()

    def __len__(self) -> int:
        return len(self.positions)


def check_clicks(clicks: Mapping[int, tuple[float, float]], count: int, height: int, width: int) -> list[Click]:
    """Clicks in order of their frames; refuses those outside the clip or the picture."""
    if not clicks:
        raise InputError("A track needs at least one click; click the point in one frame.")
    found = []
    for frame, place in clicks.items():
        values = np.asarray(place, dtype=np.float64).ravel()
        if int(frame) != frame or not 0 <= frame < count:
            raise InputError(f"A click lies in frame {frame}, but the clip has frames 0 to {count - 1}; remove it.")
        if len(values) != 2 or not np.isfinite(values).all():
            raise InputError(f"The click in frame {frame} must be two finite numbers (x, y), but is {place}.")
        x, y = float(values[0]), float(values[1])
        if not (-0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5):
            raise InputError(
                f"The click in frame {frame} at ({x:g}, {y:g}) lies outside the picture of {width} x {height}; move it."
            )
        found.append((int(frame), x, y))
    return sorted(found)


def check_absent(absent: Iterable[Interval], count: int) -> tuple[Interval, ...]:
    """Intervals clipped to the clip, in order, overlaps joined."""
    joined: list[Interval] = []
    for first, last in sorted((int(a), int(b)) for a, b in absent):
        if last < first:
            raise InputError(f"A track cannot be absent from frame {first} to {last}; the first comes after the last.")
        first, last = max(first, 0), min(last, count - 1)
        if first > last:
            continue
        if joined and first <= joined[-1][1] + 1:
            joined[-1] = joined[-1][0], max(joined[-1][1], last)
        else:
            joined.append((first, last))
    return tuple(joined)


def plan_spans(
    clicks: Sequence[Click], count: int, absent: Sequence[Interval] = (), hidden: Iterable[int] = ()
) -> tuple[SpanPlan, ...]:
    """Cut a clip of ``count`` frames into spans: a span never passes a click nor an absent interval.

    A change of one click changes only the plans beside it, so results kept by plan stay valid elsewhere. ``hidden``
    are frames where the point cannot be seen: a click in one of them is a guess.
    """
    clicks, absent, unseen = sorted(clicks), check_absent(absent, count), set(hidden)
    for frame, _, _ in clicks:
        for first, last in absent:
            if first <= frame <= last:
                raise InputError(
                    f"A click lies in frame {frame}, where the track is said to be absent ({first} to {last}); "
                    "remove one of the two."
                )
    edges = [-1, *(frame for interval in absent for frame in interval), count]
    plans: list[SpanPlan] = []
    for before, after in zip(edges[::2], edges[1::2], strict=True):
        inside = [click for click in clicks if before < click[0] < after]
        if not inside:
            continue
        ends: list[Click | None] = [None, *inside, None]
        for left, right in pairwise(ends):
            first = before + 1 if left is None else left[0]
            last = after - 1 if right is None else right[0]
            if first < last:
                guessed = tuple(end[0] for end in (left, right) if end is not None and end[0] in unseen)
                plans.append(SpanPlan(left, right, first, last, guessed))
    return tuple(plans)


def assemble_track(
    count: int,
    clicks: Sequence[Click],
    spans: Iterable[Span],
    absent: Sequence[Interval] = (),
    hidden: Iterable[int] = (),
) -> Track:
    """Put solved spans together; frames that no span and no click reaches are absent (NaN, "outside").

    Clicks in ``hidden`` frames are guesses of the place: occluded, and of low confidence.
    """
    unseen = set(hidden)
    positions, confidence = np.full((count, 2), np.nan), np.zeros(count)
    state, cost = np.full(count, "outside", dtype="<U8"), np.zeros(count)
    for span in spans:
        here = slice(span.plan.first, span.plan.last + 1)
        # The first frame of a span is the last of the one before: its own cost is that of the step into it.
        tail = slice(span.plan.first + 1, span.plan.last + 1)
        positions[here], confidence[here], state[here] = span.positions, span.confidence, span.state
        cost[tail] = span.cost[1:]
    for frame, x, y in clicks:
        guess = frame in unseen
        positions[frame] = x, y
        confidence[frame], state[frame] = (GUESS, "occluded") if guess else (1.0, "visible")
    for array in (positions, confidence, state, cost):
        array.setflags(write=False)
    return Track(positions, confidence, state, cost, tuple(frame for frame, _, _ in clicks), tuple(absent))
