"""Dragging in the lanes, without widgets: what a press takes hold of, and which change it means while it moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from app.window.timeline.lanes import Bar, Placed, TimelineHit

Kind = Literal["retime", "paint", "trim", "range"]


@dataclass(frozen=True)
class LaneEdit:
    """A change that is wanted.

    kind : "retime" moves a diamond from frame ``at`` to ``last``; "paint" makes a run from ``first`` to ``last``;
        "trim" gives the run that holds ``at`` these ends; "range" sets the in and out frames.
    """

    kind: Kind
    lane: str
    row: str
    at: int
    first: int
    last: int


@dataclass(frozen=True)
class LaneDrag:
    """A drag under way: the thing held, its frames, and where the press was."""

    kind: Kind
    lane: str
    row: str
    start: int
    bar: tuple[int, int] = (0, 0)
    end: Literal["first", "last"] = "last"

    def edit(self, frame: int) -> LaneEdit | None:
        """The change if the mouse were let go at a frame; None for nothing to change."""
        if frame == self.start:
            return None
        if self.kind == "retime":
            return LaneEdit("retime", self.lane, self.row, self.start, min(self.start, frame), frame)
        if self.kind == "paint":
            return LaneEdit("paint", self.lane, self.row, self.start, min(self.start, frame), max(self.start, frame))
        first, last = self.bar
        if self.end == "first":
            return LaneEdit(self.kind, self.lane, self.row, last, min(frame, last), last)
        return LaneEdit(self.kind, self.lane, self.row, first, first, max(frame, first))


def drag_from(found: TimelineHit, placed: Sequence[Placed], range_: tuple[int, int]) -> LaneDrag | None:
    """What a press on something takes hold of; None where it only seeks."""
    if found.kind in ("in", "out"):
        end: Literal["first", "last"] = "first" if found.kind == "in" else "last"
        return LaneDrag("range", "", "", range_[0 if end == "first" else 1], range_, end)
    lane = next((each.lane for each in placed if each.lane.id == found.lane), None)
    row = next((each for each in lane.rows if each.id == found.row), None) if lane is not None else None
    if lane is None or row is None:
        return None
    if found.kind == "diamond" and "retime" in lane.edits:
        return LaneDrag("retime", lane.id, row.id, found.frame)
    if found.kind in ("first", "last") and "trim" in lane.edits:
        bar = next((bar for bar in row.bars if found.frame == getattr(bar, found.kind)), None)
        if bar is not None:
            return LaneDrag("trim", lane.id, row.id, found.frame, (bar.first, bar.last), found.kind)
    if found.kind == "row" and "paint" in lane.edits:
        return LaneDrag("paint", lane.id, row.id, found.frame)
    return None


def editable(bar: Bar) -> bool:
    """Whether a bar's ends can be taken hold of; proposals are hatched and cannot."""
    return bar.style == "solid"
