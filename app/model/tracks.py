"""Tracks: points that the user clicked, to be followed through the clip."""

from __future__ import annotations

import itertools
from typing import Literal

import attrs

from app.model.frozen import FrozenMap
from app.model.values import Interval, Point2, Point3, Unknown

TrackMode = Literal["robust", "paper"]


@attrs.frozen
class Contact:
    """Frames in which the point touches the ground and stands still.

    Attributes
    ----------
    span : first and last frame, both included.
    place : where it touches, world; None takes the place from the ground.
    accepted : the program proposed it and the user accepted.
    """

    span: Interval
    place: Point3 | None = None
    accepted: bool = False
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class Track:
    """One followed point.

    Attributes
    ----------
    clicks : frame -> pixel, as the user gave them (corrections are clicks too).
    masked : whether the subject's masks rule out places beside the subject.
    absent : frames in which the track has ended, until it restarts.
    occluded : frames in which the user says that the point is hidden.
    contacts : planted intervals, in order, not overlapping.
    mirror : id of the track on the other side of the body, whose motion a hidden limb follows.
    mirror_lag : frames by which this point moves later than its mirror; None finds it from both tracks.
    colour : index into the cycle of track colours.
    visible : whether the window draws it.
    """

    id: str
    name: str
    clicks: FrozenMap[int, Point2]
    colour: int = 0
    mode: TrackMode = "robust"
    masked: bool = False
    absent: tuple[Interval, ...] = ()
    occluded: tuple[Interval, ...] = ()
    contacts: tuple[Contact, ...] = ()
    mirror: str | None = None
    mirror_lag: int | None = None
    visible: bool = True
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)

    @property
    def spans(self) -> tuple[tuple[int, int], ...]:
        """Neighbouring clicks (left, right) in order; before the first and after the last lies no span."""
        frames = tuple(self.clicks)
        return tuple(itertools.pairwise(frames))
