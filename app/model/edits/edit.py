"""What an edit gives back, and the checks that several edits share."""

from __future__ import annotations

import math
from collections.abc import Iterable

import attrs

from app.model.document import Document
from app.model.values import Clip, Interval, ModelError, Point2, Point3


@attrs.frozen
class Edit:
    """The next document, what the person did, and the frame where it shows."""

    document: Document
    label: str
    frame: int | None = None


def clip_of(document: Document) -> Clip:
    """Give the clip, or say that there is none."""
    if document.clip is None:
        raise ModelError("This project has no clip yet: add a video first.")
    return document.clip


def checked_frame(document: Document, frame: int) -> int:
    """Give the frame if the clip has it."""
    count = clip_of(document).frame_count
    if not 0 <= frame < count:
        raise ModelError(f"Frame {frame} is outside the clip: it has frames 0 to {count - 1}.")
    return int(frame)


def checked_interval(document: Document, first: int, last: int) -> Interval:
    """Give the interval if the clip has its frames; the ends may come in either order."""
    return Interval(checked_frame(document, min(first, last)), checked_frame(document, max(first, last)))


def checked_pixel(document: Document, point: Iterable[float]) -> Point2:
    """Give the pixel if it lies in the picture; up to one picture size outside is allowed for hidden points."""
    clip = clip_of(document)
    x, y = (float(value) for value in point)
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ModelError(f"A click must be two finite numbers, but got ({x}, {y}).")
    if not (-0.5 <= x <= clip.width - 0.5 and -0.5 <= y <= clip.height - 0.5):
        raise ModelError(
            f"The click ({x:.1f}, {y:.1f}) is outside the picture of {clip.width} x {clip.height} pixels: click inside."
        )
    return (x, y)


def checked_place(place: Iterable[float]) -> Point3:
    """Give the place if its three numbers are finite."""
    x, y, z = (float(value) for value in place)
    if not all(map(math.isfinite, (x, y, z))):
        raise ModelError(f"A place must be three finite numbers, but got ({x}, {y}, {z}).")
    return (x, y, z)


def checked_name(name: str) -> str:
    """Give the name without surrounding space; an empty one is refused."""
    if not name.strip():
        raise ModelError("A name must not be empty: type at least one letter.")
    return name.strip()


def merged(intervals: Iterable[Interval]) -> tuple[Interval, ...]:
    """Sort intervals and join those that touch or overlap."""
    joined: list[Interval] = []
    for interval in sorted(intervals):
        if joined and interval.first <= joined[-1].last + 1:
            joined[-1] = Interval(joined[-1].first, max(joined[-1].last, interval.last))
        else:
            joined.append(interval)
    return tuple(joined)


def cut(intervals: Iterable[Interval], gone: Interval) -> tuple[Interval, ...]:
    """Take an interval away from others."""
    kept: list[Interval] = []
    for interval in intervals:
        if interval.first < gone.first:
            kept.append(Interval(interval.first, min(interval.last, gone.first - 1)))
        if interval.last > gone.last:
            kept.append(Interval(max(interval.first, gone.last + 1), interval.last))
    return tuple(sorted(set(kept)))
