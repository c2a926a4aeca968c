"""Mouse gestures as state machines without widgets: press, move, release, cancel; each may give an event.

Places are picture coordinates. A gesture that ends says so by its event, never by touching anything itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

Place = tuple[float, float]


@dataclass(frozen=True)
class Placed:
    """A new thing is wanted at a place."""

    place: Place


@dataclass(frozen=True)
class Moving:
    """A thing is being dragged; nothing is decided yet."""

    owner: str
    place: Place
    start: Place


@dataclass(frozen=True)
class Moved:
    """A drag has ended at a place: one entry of the history."""

    owner: str
    place: Place
    start: Place


@dataclass(frozen=True)
class Chosen:
    """A thing was clicked without being moved; an empty owner means nothing."""

    owner: str


@dataclass(frozen=True)
class Drawing:
    """A line is being drawn; it will take away where ``subtracting``."""

    points: tuple[Place, ...]
    subtracting: bool = False


@dataclass(frozen=True)
class Drawn:
    """A closed line was drawn; ``mode`` is new, add or subtract."""

    points: tuple[Place, ...]
    mode: str


@dataclass(frozen=True)
class Cancelled:
    """The gesture was given up; things are as they were."""

    owner: str = ""


Event = Placed | Moving | Moved | Chosen | Drawing | Drawn | Cancelled


class Gesture(Protocol):
    """What the canvas drives."""

    def press(self, place: Place) -> Event | None:
        """Begin at a place."""

    def move(self, place: Place) -> Event | None:
        """Go on to a place."""

    def release(self, place: Place) -> Event | None:
        """End at a place."""

    def cancel(self) -> Event | None:
        """Give up."""


@dataclass
class DragGesture:
    """Drag a thing from where it is. It keeps its distance to the mouse, so nothing jumps at the press.

    slack : the way, in picture pixels, that the mouse may go before a press becomes a drag.
    """

    owner: str
    origin: Place
    slack: float = 2.0
    _grab: Place = (0.0, 0.0)
    _dragging: bool = False

    def _placed(self, place: Place) -> Place:
        return self.origin[0] + place[0] - self._grab[0], self.origin[1] + place[1] - self._grab[1]

    def press(self, place: Place) -> Event | None:
        """Take hold of the thing."""
        self._grab, self._dragging = place, False
        return None

    def move(self, place: Place) -> Event | None:
        """Carry it along."""
        if not self._dragging and math.dist(place, self._grab) < self.slack:
            return None
        self._dragging = True
        return Moving(self.owner, self._placed(place), self.origin)

    def release(self, place: Place) -> Event | None:
        """Put it down, or choose it where it was never moved."""
        if not self._dragging:
            return Chosen(self.owner)
        self._dragging = False
        return Moved(self.owner, self._placed(place), self.origin)

    def cancel(self) -> Event | None:
        """Let it snap back."""
        was, self._dragging = self._dragging, False
        return Cancelled(self.owner) if was else None


@dataclass
class PlaceGesture:
    """Place a new thing where the mouse goes up; moving away by much gives it up."""

    slack: float = 6.0
    _start: Place = (0.0, 0.0)

    def press(self, place: Place) -> Event | None:
        """Remember where."""
        self._start = place
        return None

    def move(self, place: Place) -> Event | None:
        """Nothing is drawn while the button is down."""
        return None

    def release(self, place: Place) -> Event | None:
        """Ask for the thing."""
        return Placed(place) if math.dist(place, self._start) <= self.slack else Cancelled()

    def cancel(self) -> Event | None:
        """Nothing was placed."""
        return Cancelled()


@dataclass
class LassoGesture:
    """Press, draw around the subject, release: the line closes itself."""

    mode: str = "new"
    spacing: float = 3.0
    smallest: float = 30.0
    _points: list[Place] = field(default_factory=list)

    def press(self, place: Place) -> Event | None:
        """Begin the line."""
        self._points = [place]
        return Drawing(tuple(self._points), self.mode == "subtract")

    def move(self, place: Place) -> Event | None:
        """Add a corner where the mouse went far enough."""
        if not self._points or math.dist(place, self._points[-1]) < self.spacing:
            return None
        self._points.append(place)
        return Drawing(tuple(self._points), self.mode == "subtract")

    def release(self, place: Place) -> Event | None:
        """Close the line; a line around nothing is given up."""
        points, self._points = tuple(self._points), []
        if len(points) < 4 or abs(_area(points)) < self.smallest:
            return Cancelled()
        return Drawn(points, self.mode)

    def cancel(self) -> Event | None:
        """Forget the line."""
        self._points = []
        return Cancelled()


@dataclass
class PickGesture(LassoGesture):
    """Choose things: a click chooses one, a line drawn round them chooses all inside."""

    slack: float = 6.0
    _from: Place = (0.0, 0.0)

    def press(self, place: Place) -> Event | None:
        """Remember where; a line is seen once the mouse moves."""
        self._from, self._points = place, [place]
        return None

    def release(self, place: Place) -> Event | None:
        """A click where the mouse hardly moved, else the closed line."""
        if math.dist(place, self._from) <= self.slack and len(self._points) < 4:
            self._points = []
            return Placed(self._from)
        return super().release(place)


def _area(points: tuple[Place, ...]) -> float:
    following = (*points[1:], points[0])
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, following, strict=True))
