"""Moving in time: stepping, playing, marks, and the frames visited before."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject

from app.window.playback import Playback
from app.window.project import Project

LONGEST = 200


class Visited:
    """Frames visited by jumps, like the pages of a browser."""

    def __init__(self) -> None:
        self._frames: list[int] = [0]
        self._at = 0

    def jumped(self, from_frame: int, to_frame: int) -> None:
        """Remember a jump; what lay ahead is forgotten."""
        if self._frames[self._at] != from_frame:
            self._frames[self._at + 1 :] = [from_frame]
            self._at += 1
        self._frames[self._at + 1 :] = [to_frame]
        self._at += 1
        del self._frames[:-LONGEST]
        self._at = min(self._at, len(self._frames) - 1)

    def back(self) -> int | None:
        """The frame before, None at the beginning."""
        if self._at == 0:
            return None
        self._at -= 1
        return self._frames[self._at]

    def on(self) -> int | None:
        """The frame after, None at the end."""
        if self._at + 1 >= len(self._frames):
            return None
        self._at += 1
        return self._frames[self._at]


class Navigator(QObject):
    """Does the commands of time for the open project."""

    def __init__(self, project: Callable[[], Project | None], parent: QObject) -> None:
        super().__init__(parent)
        self._project = project
        self.visited = Visited()
        self.playback = Playback(self, lambda: self._frame())
        self.playback.due.connect(self._show)

    def _frame(self) -> int:
        project = self._project()
        return project.frame if project else 0

    def _show(self, frame: int) -> None:
        project = self._project()
        if project is not None:
            project.show_frame(frame)

    def go(self, frame: int) -> None:
        """Jump to a frame and remember where we came from."""
        before = self._frame()
        self._show(frame)
        if abs(self._frame() - before) > 1:
            self.visited.jumped(before, self._frame())

    def command(self, name: str) -> bool:
        """Do a command; says whether it was one."""
        project = self._project()
        if project is None or not project.frame_count:
            return False
        first, last = project.range
        frame = project.frame
        jumps: dict[str, Callable[[], int | None]] = {
            "previous": lambda: frame - 1,
            "next": lambda: frame + 1,
            "back_ten": lambda: frame - 10,
            "on_ten": lambda: frame + 10,
            "first": lambda: first,
            "last": lambda: last,
            "previous_mark": lambda: max((mark for mark in marked(project) if mark < frame), default=None),
            "next_mark": lambda: min((mark for mark in marked(project) if mark > frame), default=None),
        }
        if name in jumps:
            self.playback.stop()
            found = jumps[name]()
            if found is not None:
                self.go(found)
        elif name in ("visited_back", "visited_on"):
            found = self.visited.back() if name == "visited_back" else self.visited.on()
            if found is not None:
                self._show(found)
        elif name == "play":
            self.playback.stop() if self.playback.playing else self.playback.play(first, last, project.fps)
        elif name == "stop":
            self.playback.stop()
        elif name in ("forward", "backward"):
            sign = 1 if name == "forward" else -1
            speed = self.playback.speed
            faster = speed * 2 if speed * sign > 0 else sign
            self.playback.play(first, last, project.fps, max(min(faster, 8.0), -8.0))
        else:
            return False
        return True


def marked(project: Project) -> list[int]:
    """Frames with clicks of the selected track (of all where none is), edited poses and key masks, in order."""
    document = project.document
    tracks = [track for track in document.tracks if project.track_id in ("", track.id)]
    frames = {frame for track in tracks for frame in track.clicks}
    frames |= {frame for character in document.characters for frame in character.edits}
    if not project.track_id:
        frames |= set(document.masks)
    return sorted(frames)
