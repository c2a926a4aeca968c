"""Pairing by two clicks, on a point and on its vertex, in either order: as a state machine without widgets."""

from __future__ import annotations

from dataclasses import dataclass

POINT = "{} is chosen: click its place on the character to pair them. Esc ends pairing."
VERTEX = "{} is chosen: click its point in the video to pair them. Esc ends pairing."
START = "Click a point in the video or a vertex of the character, then its counterpart. Esc ends pairing."


@dataclass
class Pairing:
    """What was clicked so far; ``track`` and ``vertex`` wait for their counterpart."""

    on: bool = False
    track: str = ""
    vertex: int = -1

    def start(self, track: str) -> None:
        """Begin; a point that is chosen already counts as clicked."""
        self.on, self.track, self.vertex = True, track, -1

    def stop(self) -> None:
        """End."""
        self.on, self.track, self.vertex = False, "", -1

    def click_track(self, track: str) -> tuple[str, int] | None:
        """A point was clicked; gives the pair where its vertex waits."""
        if self.vertex >= 0 and track:
            return self._pair(track, self.vertex)
        self.track = track
        return None

    def click_vertex(self, vertex: int) -> tuple[str, int] | None:
        """A vertex was clicked; gives the pair where its point waits."""
        if self.track:
            return self._pair(self.track, vertex)
        self.vertex = vertex
        return None

    def _pair(self, track: str, vertex: int) -> tuple[str, int]:
        self.track, self.vertex = "", -1
        return track, vertex
