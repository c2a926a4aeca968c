"""Lanes in one line each, for windows with little height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from app.window.timeline.lanes import Bar, Curve, Lane, Row

LINE = 16


def summaries(lanes: Sequence[Lane]) -> list[Lane]:
    """Give every lane as one line of 16 pixels: what all its rows hold over each other, nothing that can be dragged.

    Thumbnails are left out; of a curve remains where it is too high.
    """
    return [_summary(lane) for lane in lanes]


def _summary(lane: Lane) -> Lane:
    bars = [_neutral(bar) for row in lane.rows for bar in row.bars]
    marks = {mark.frame: mark for row in lane.rows for mark in row.diamonds}
    if lane.curve is not None:
        bars += _too_high(lane.curve)
    # What asks for a look lies above what is well.
    bars.sort(key=lambda bar: ("line", "dim", "solid", "hatch").index(bar.style))
    row = Row(next((row.id for row in lane.rows if row.selected), ""), tuple(bars), tuple(marks.values()))
    line = replace(lane, rows=(row,), row_height=LINE, shown_rows=1, padding=0, compact=True)
    return replace(line, thumbnails=False, curve=None, edits=())


def _neutral(bar: Bar) -> Bar:
    """Take a row's own colour away: where rows lie over each other it would say that one of them is meant."""
    return replace(bar, colour="text3") if bar.colour.startswith("#") else bar


def _too_high(curve: Curve) -> list[Bar]:
    known = np.isfinite(curve.values)
    return [
        *(Bar(first, last, "accent", "line") for first, last in _runs(known)),
        *(Bar(first, last, "err") for first, last in _runs(known & (curve.values > curve.limit))),
    ]


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8)))
    return [(int(first), int(end) - 1) for first, end in edges.reshape(-1, 2)]
