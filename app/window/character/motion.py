"""Which vertices are shown in a frame: the newest that is known, wherever it comes from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.model.character import Character
from app.stages.stage import Stage
from app.window.project import Project

Array = NDArray[np.float64]


@dataclass
class Motion:
    """The moving character as far as it is known.

    streamed : frame -> vertices that came in for the stage ``key`` while it is computed.
    last : the newest whole result, shown where nothing newer is known.
    held : frame -> the pose that is dragged or was just released there, until the result says otherwise.
    placed : the character on the subject in the first frame. taken : whether ``last`` is the result wanted now.
    unedited : the motion before any edit, where it is known.
    """

    character_id: str = ""
    key: str = ""
    streamed: dict[int, Array] = field(default_factory=dict)
    last: Array | None = None
    held: dict[int, Array] = field(default_factory=dict)
    placed: Any = None
    unedited: Array | None = None
    taken: bool = False
    _meant: dict[int, object] = field(default_factory=dict)
    _placed_last: Any = None

    def read(self, project: Project) -> None:
        """Take what is finished."""
        if project.character_id != self.character_id:
            self.character_id, self.key, self.taken = project.character_id, "", False
            self.streamed, self.held, self.last, self.placed = {}, {}, None, None
            self._meant, self._placed_last = {}, None
        if not self.character_id:
            return
        self._forget_what_is_no_more(project.document.character(self.character_id))
        stages = project.session.stages
        stage = stages.animation(self.character_id)
        if stage.key != self.key:
            self.key, self.streamed, self.taken = stage.key, {}, False
        placed = project.result(stages.alignment(self.character_id))
        if placed is not None:
            self.placed = placed
        solved = project.result(stages.base(self.character_id))
        self.unedited = solved.vertices if solved is not None else None
        found = None if self.taken else project.result(stage)
        if found is not None:
            # A plain view: what indexes a mapped file as such makes an object of it each time.
            self.last, self.streamed, self.held, self.taken = np.asarray(found.vertices), {}, {}, True
            self._meant, self._placed_last = {}, self.placed

    def take(self, stage: Stage, value: Any) -> int | None:
        """Take a frame that streams in; gives its number where it belongs to what is wanted now."""
        ours = stage.name == f"animation/{self.character_id}" and stage.key == self.key
        first = stage.name == f"base/{self.character_id}" and self.last is None
        if not (ours or first):
            return None
        frame, vertices = value
        self.streamed[int(frame)] = vertices
        self.drop(int(frame))
        return int(frame)

    def vertices(self, frame: int) -> Array | None:
        """The vertices (v, 3) of a frame, None where the character has not even been placed."""
        if frame in self.held:
            return self.held[frame]
        if frame in self.streamed:
            return self.streamed[frame]
        replaced = frame == 0 and not self.taken and self.placed is not None and self.placed is not self._placed_last
        if self.last is not None and frame < len(self.last) and not replaced:
            pose: Array = self.last[frame]
            return pose
        return None if self.placed is None else self.placed.vertices

    def before_edits(self, frame: int) -> Array | None:
        """The vertices (v, 3) of a frame without its pose edits, None where that is not known."""
        if frame == 0 and self.placed is not None:
            placed: Array = self.placed.vertices
            return placed
        return self.unedited[frame] if self.unedited is not None and frame < len(self.unedited) else None

    def ways(self, first: int, last: int, chosen: Sequence[int]) -> Array:
        """Places (last - first + 1, k, 3) of chosen vertices in frames first to last, NaN where they are not known."""
        made = np.full((last - first + 1, len(chosen), 3), np.nan)
        farthest, alike = max(chosen, default=-1), 0
        if self.last is not None and farthest < self.last.shape[1]:
            found = self.last[first : last + 1, chosen]
            alike = len(found)
            made[:alike] = found
        for frame in range(first, last + 1):
            if frame == 0 or frame - first >= alike or frame in self.held or frame in self.streamed:
                pose = self.vertices(frame)
                known = pose is not None and farthest < len(pose)
                made[frame - first] = pose[chosen] if known and pose is not None else np.nan
        return made

    # what a hand holds -------------------------------------------------------------------------------------------

    def hold(self, frame: int, vertices: Array) -> None:
        """Show a pose that is on its way: nothing is decided yet."""
        self.held[frame] = vertices
        self._meant.pop(frame, None)

    def settle(self, frame: int, character: Character | None) -> None:
        """What is held in a frame is what the document says now; when it says something else, it is dropped."""
        if frame in self.held and character is not None:
            self._meant[frame] = _meaning(character, frame)

    def settle_open(self, frame: int, character: Character | None) -> None:
        """The same where what is held stands for nothing yet."""
        if frame not in self._meant:
            self.settle(frame, character)

    def drop(self, frame: int) -> None:
        """Hold nothing in a frame."""
        self.held.pop(frame, None)
        self._meant.pop(frame, None)

    def _forget_what_is_no_more(self, character: Character) -> None:
        for frame, meant in tuple(self._meant.items()):
            if meant != _meaning(character, frame):
                self.drop(frame)

    def solved(self, count: int) -> NDArray[np.bool_]:
        """Which frames have streamed in (n,)."""
        mask = np.zeros(count, bool)
        mask[[frame for frame in self.streamed if frame < count]] = True
        return mask


def _meaning(character: Character, frame: int) -> object:
    """What of the document a pose held in a frame stands for."""
    return character.edits.get(frame), character.alignment if frame == 0 else None
