"""The results that are shown beside each other: ours before the edits, and the paper's other ways."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject

from app.stages.stage import Stage
from app.window.character.mesh_header import BEFORE, title_of
from app.window.project import Project

Array = NDArray[np.float64]


class Comparing(QObject):
    """Computes the comparisons chosen and gives their poses."""

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self.chosen: list[str] = []
        self._last: dict[str, tuple[str, Array]] = {}
        self._asked: set[str] = set()

    def choose(self, variants: list[str]) -> None:
        """Compare with these from now on; those not known yet are computed."""
        fresh = [each for each in variants if each not in self.chosen]
        self.chosen = list(variants)
        self.run(fresh)

    def run(self, variants: list[str] | None = None) -> None:
        """Compute what is missing of the comparisons chosen, or of some."""
        project = self.project
        for variant in self.chosen if variants is None else variants:
            stage = self._stage(variant)
            if stage is None or stage.why_blocked() is not None:
                continue
            if project.state(stage) in ("missing", "stale", "failed") and stage.key not in self._asked:
                self._asked.add(stage.key)
                project.start(stage.label, stage)

    def again(self) -> None:
        """Ask anew also for what was asked for before and did not come."""
        self._asked.clear()
        self.run()

    def _stage(self, variant: str) -> Stage | None:
        project = self.project
        if not project.character_id:
            return None
        stages = project.session.stages
        return (
            stages.base(project.character_id) if variant == BEFORE else stages.comparison(project.character_id, variant)
        )

    def pose(self, variant: str, frame: int) -> tuple[Array | None, str, str]:
        """The pose (v, 3) of a comparison in a frame, what to call it, and the token of its colour."""
        stage, title = self._stage(variant), title_of(variant)
        if stage is None:
            return None, title, "text3"
        result: Any = self.project.result(stage)
        state = self.project.state(stage)
        if result is not None:
            motion = result.vertices if variant == BEFORE else result
            self._last[variant] = (self.project.character_id, motion)
            word, token = "", "text"
        else:
            words = {
                "running": ("being solved", "accent"),
                "failed": ("not possible", "err"),
                "blocked": ("not yet", "text3"),
            }
            word, token = words.get(state, ("waiting, Ctrl+Return", "warn"))
        owner, motion = self._last.get(variant, ("", None))
        known = motion is not None and owner == self.project.character_id and frame < len(motion)
        text = f"{title}  ·  {word}" if word else title
        return (motion[frame] if known else None), text, token
