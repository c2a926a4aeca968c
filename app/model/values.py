"""Small values that several parts of the document use."""

from __future__ import annotations

from typing import Any, TypeAlias

import attrs

from app.model.frozen import FrozenMap

Point2: TypeAlias = tuple[float, float]
"""Pixels, x right and y down, (0, 0) the centre of the top-left pixel."""
Point3: TypeAlias = tuple[float, float, float]
"""World coordinates, metres where the scale is known."""
Unknown: TypeAlias = FrozenMap[str, Any]
"""Fields of a file written by a newer program: kept as they were."""


class ModelError(ValueError):
    """An edit that the document cannot take. The message is one sentence: what is wrong, where, what to do."""


@attrs.frozen(order=True)
class Interval:
    """Frames from ``first`` to ``last``, both included."""

    first: int
    last: int

    def __attrs_post_init__(self) -> None:
        if not 0 <= self.first <= self.last:
            raise ModelError(
                f"Frames {self.first} to {self.last} are no interval: start at 0 or later, end not before."
            )

    def __contains__(self, frame: int) -> bool:
        return self.first <= frame <= self.last

    def overlaps(self, other: Interval) -> bool:
        """Whether the two share a frame."""
        return self.first <= other.last and other.first <= self.last


@attrs.frozen
class MediaRef:
    """A file from outside that the project uses.

    Attributes
    ----------
    path : relative to the project folder when the file was copied into it, absolute when it is linked.
    fingerprint : of the content, so that a moved or changed file is noticed.
    linked : whether the file lies outside the project folder.
    """

    # Keys of results are made of what ``repr`` shows: a moved file gives the same results, so its place is not shown.
    path: str = attrs.field(repr=False)
    fingerprint: str
    linked: bool = attrs.field(default=True, repr=False)
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class Clip:
    """The filmed video: a file or a folder of images."""

    media: MediaRef
    width: int
    height: int
    frame_count: int
    fps: float
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class Lasso:
    """A rough outline of the subject, added to or taken from the mask of its frame."""

    points: tuple[Point2, ...]
    subtract: bool = False

    def __attrs_post_init__(self) -> None:
        if len(self.points) < 3:
            raise ModelError(f"A lasso needs at least 3 points, but has {len(self.points)}.")


@attrs.frozen
class KeyMask:
    """The lassos that the user drew in one frame, in drawing order."""

    lassos: tuple[Lasso, ...] = ()
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)
