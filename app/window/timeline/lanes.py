"""What lanes show, as plain values, and where they stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from app.window.timeline.axis import LABELS, Axis

RULER = 26
LOW, TALLER = 14, 5
FEWEST = 3
"""Rows that a lane keeps, however little room there is for it: fewer could not be compared."""
HANDLE, TRIM = 9, 4
"""Pixels within which a handle of the range and the end of a bar are taken hold of."""
Style = Literal["solid", "dim", "hatch", "line"]


@dataclass(frozen=True)
class Bar:
    """Frames first to last in one colour (a token or a literal)."""

    first: int
    last: int
    colour: str
    style: Style = "solid"
    text: str = ""


@dataclass(frozen=True)
class Diamond:
    """A mark in one frame: a click, a key mask, an edited pose."""

    frame: int
    colour: str = "text"
    filled: bool = True


@dataclass(frozen=True)
class Row:
    """One line of a lane."""

    id: str
    bars: tuple[Bar, ...] = ()
    diamonds: tuple[Diamond, ...] = ()
    selected: bool = False


@dataclass(frozen=True, eq=False)
class Curve:
    """A value a frame with a limit; NaN breaks the line."""

    values: NDArray[np.float64]
    limit: float
    unit: str = "px"


@dataclass(frozen=True)
class Lane:
    """A titled group of rows, a row of thumbnails, or a curve.

    counted : whether the title says how many of its rows are shown, where that is not all of them.
    edits : what the mouse may change in it: "retime" its diamonds, "paint" runs, "trim" their ends.
    compact : it is one line, no higher than its row.
    """

    id: str
    title: str
    icon: str
    rows: tuple[Row, ...] = ()
    row_height: int = 10
    shown_rows: int = 8
    thumbnails: bool = False
    curve: Curve | None = None
    padding: int = 6
    edits: tuple[str, ...] = ()
    compact: bool = False
    counted: bool = False

    @property
    def words(self) -> str:
        """The title, and how many rows there are."""
        if not self.counted:
            return self.title
        many = len(self.rows)
        return f"{self.title}, {self.shown_rows} of {many}" if many > self.shown_rows else f"{self.title}, {many}"


@dataclass(frozen=True)
class Placed:
    """A lane with the place of its rows: (row, top, height) in widget pixels."""

    lane: Lane
    top: int
    height: int
    rows: tuple[tuple[Row, int, int], ...] = ()


@dataclass(frozen=True)
class TimelineHit:
    """What lies under the mouse, with the lane, the row and the frame.

    kind : ruler, diamond, bar, row, lane or label; "first" and "last" are the ends of a bar that can be trimmed, "in"
        and "out" the handles of the range.
    """

    kind: Literal["ruler", "diamond", "bar", "row", "lane", "label", "first", "last", "in", "out"]
    lane: str
    row: str
    frame: int


def layout(lanes: Sequence[Lane], scrolled: dict[str, int] | None = None) -> tuple[Placed, ...]:
    """Stack the lanes under the ruler; a selected row is taller, so that it is easy to hit.

    Its lane has room for it even while no row is selected, so that nothing moves when one is.
    """
    placed, top = [], RULER
    for lane in lanes:
        rows, y = [], top + lane.padding
        first = min((scrolled or {}).get(lane.id, 0), max(len(lane.rows) - lane.shown_rows, 0))
        shown = lane.rows[first : first + lane.shown_rows]
        for row in shown:
            height = lane.row_height + (TALLER if row.selected and lane.row_height < LOW else 0)
            rows.append((row, y, height))
            y += height
        if lane.thumbnails:
            y += 38
        elif lane.curve is not None:
            y += 34
        elif not shown:
            y += lane.row_height
        if shown and lane.row_height < LOW and not lane.thumbnails and not any(row.selected for row in shown):
            y += TALLER
        bottom = max(y + lane.padding, top + (lane.row_height + 2 if lane.compact else 26))
        if shown and not lane.thumbnails:
            last = rows[-1][1] + rows[-1][2]
            spare = (bottom - lane.padding - last) // 2
            rows = [(row, at + spare, height) for row, at, height in rows]
        placed.append(Placed(lane, top, bottom - top, tuple(rows)))
        top = bottom
    return tuple(placed)


def fitted(lanes: Sequence[Lane], room: int) -> tuple[Lane, ...]:
    """Show fewer rows, of the lane with most of them first, until ruler and lanes need no more than ``room`` pixels.

    The rows left out are scrolled to; a lane that stood cut by the lower edge would not be seen to be there at all.
    """
    fit = list(lanes)
    while total_height(layout(fit)) > room:
        seen = [min(len(lane.rows), lane.shown_rows) for lane in fit]
        number = max(range(len(fit)), key=seen.__getitem__, default=-1)
        if number < 0 or seen[number] <= FEWEST:
            break
        fit[number] = replace(fit[number], shown_rows=seen[number] - 1)
    return tuple(fit)


def total_height(placed: Sequence[Placed]) -> int:
    """Pixels that ruler and lanes need."""
    return placed[-1].top + placed[-1].height + 2 if placed else RULER + 2


def hit(
    placed: Sequence[Placed],
    axis: Axis,
    x: float,
    y: float,
    reach: float = 7.0,
    range_: tuple[int, int] | None = None,
) -> TimelineHit | None:
    """What lies at a widget place; a diamond is found within reach pixels, before the bar under it.

    ``range_`` are the in and out frames, whose handles stand in the lower part of the ruler.
    """
    frame = axis.frame(x)
    if range_ is not None and RULER - HANDLE <= y < RULER and x >= LABELS:
        ends: tuple[tuple[Literal["in", "out"], int], ...] = (("in", range_[0]), ("out", range_[1]))
        for kind, at in ends:
            way = x - axis.x(at)
            if (-HANDLE <= way <= 2) if kind == "in" else (-2 <= way <= HANDLE):
                return TimelineHit(kind, "", "", at)
    if y < RULER:
        return TimelineHit("ruler", "", "", frame) if x >= LABELS else None
    for each in placed:
        if not each.top <= y < each.top + each.height:
            continue
        lane = each.lane.id
        if x < LABELS:
            row = next((row.id for row, top, height in each.rows if top <= y < top + height), "")
            return TimelineHit("label", lane, row, frame)
        for row, top, height in each.rows:
            slack = 0 if len(each.rows) > 1 else 6
            if not top - slack <= y < top + height + slack:
                continue
            near = min(row.diamonds, key=lambda mark: abs(axis.x(mark.frame) - x), default=None)
            if near is not None and abs(axis.x(near.frame) - x) <= reach:
                return TimelineHit("diamond", lane, row.id, near.frame)
            if "trim" in each.lane.edits:
                for bar in row.bars:
                    for end, at in (("last", bar.last), ("first", bar.first)):
                        if bar.style == "solid" and abs(axis.x(at) - x) <= TRIM:
                            return TimelineHit(end, lane, row.id, at)  # type: ignore[arg-type]
            if any(axis.x(bar.first) - 2 <= x <= axis.x(bar.last) + 2 for bar in row.bars):
                return TimelineHit("bar", lane, row.id, frame)
            return TimelineHit("row", lane, row.id, frame)
        return TimelineHit("lane", lane, "", frame)
    return None
