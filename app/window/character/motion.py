"""Which vertices are shown in a frame: the newest that is known, wherever it comes from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
    """

    character_id: str = ""
    key: str = ""
    streamed: dict[int, Array] = field(default_factory=dict)
    last: Array | None = None
    held: dict[int, Array] = field(default_factory=dict)
    placed: Any = None
    taken: bool = False

    def read(self, project: Project) -> None:
        """Take what is finished."""
        if project.character_id != self.character_id:
            self.character_id, self.key, self.taken = project.character_id, "", False
            self.streamed, self.held, self.last, self.placed = {}, {}, None, None
        if not self.character_id:
            return
        stages = project.session.stages
        stage = stages.animation(self.character_id)
        if stage.key != self.key:
            self.key, self.streamed, self.taken = stage.key, {}, False
        found = None if self.taken else project.result(stage)
        if found is not None:
            self.last, self.streamed, self.held, self.taken = found.vertices, {}, {}, True
        placed = project.result(stages.alignment(self.character_id))
        if placed is not None:
            self.placed = placed

    def take(self, stage: Stage, value: Any) -> int | None:
        """Take a frame that streams in; gives its number where it belongs to what is wanted now."""
        ours = stage.name == f"animation/{self.character_id}" and stage.key == self.key
        first = stage.name == f"base/{self.character_id}" and self.last is None
        if not (ours or first):
            return None
        frame, vertices = value
        self.streamed[int(frame)] = vertices
        self.held.pop(int(frame), None)
        return int(frame)

    def vertices(self, frame: int) -> Array | None:
        """The vertices (v, 3) of a frame, None where the character has not even been placed."""
        if frame in self.held:
            return self.held[frame]
        if frame in self.streamed:
            return self.streamed[frame]
        if self.last is not None and frame < len(self.last):
            pose: Array = self.last[frame]
            return pose
        return None if self.placed is None else self.placed.vertices

    def solved(self, count: int) -> NDArray[np.bool_]:
        """Which frames have streamed in (n,)."""
        mask = np.zeros(count, bool)
        mask[[frame for frame in self.streamed if frame < count]] = True
        return mask
