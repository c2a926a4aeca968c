"""Keeps the check of the motion up to date, and goes from one problem to the next."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.actions.checking import Check, Problem, check_motion
from app.window.background_call import BackgroundCalls
from app.window.moment import Moment
from app.window.project import Project


class OutdatedError(Exception):
    """The motion that is being measured is no longer wanted."""


class Checks(QObject):
    """Measures the motion outside the window's thread whenever it is up to date; ``changed`` says that it is done."""

    changed = Signal()

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self.check: Check | None = None
        self.at: Problem | None = None
        self._calls = BackgroundCalls(self)
        self._key = self._wanted = ""
        self._closed = False
        self._asked = ""
        self._seen: tuple[Moment, str] | None = None
        self._now = ""

    @property
    def measuring(self) -> bool:
        """Whether the motion is being measured."""
        return bool(self._wanted) and self._wanted != self._key

    def keep_up(self) -> None:
        """Measure the motion that is shown, once it is up to date and nothing else runs."""
        project = self.project
        if not project.character_id:
            self.check = None
            return
        stage = project.session.stages.animation(project.character_id)
        if not self._wanted.startswith(stage.key):
            self._wanted = ""
        if project.progress or project.state(stage) != "fresh":
            return
        key = self._key_now()
        if key != self._wanted:
            self._wanted = ""
        if key in (self._key, self._wanted):
            return
        self._wanted = key
        session, character = project.session, project.character_id

        def heard() -> None:
            if self._closed or self._wanted != key:
                raise OutdatedError

        self._calls.run(
            lambda: check_motion(session, character, heard=heard),
            lambda check: self._take(key, check),
            lambda _: self._give_up(key),
        )

    def _take(self, key: str, check: Check) -> None:
        if key == self._wanted:
            self._key, self.check = key, check
            self.changed.emit()

    def _give_up(self, key: str) -> None:
        if key == self._wanted:
            self._key, self.check = key, None
            self.changed.emit()

    @property
    def fresh(self) -> bool:
        """Whether what was measured is the motion wanted now."""
        project = self.project
        # Whether the background is known is asked last: naming the stages of its depth takes longer than all the rest.
        return (
            bool(project.character_id)
            and self._key.startswith(project.session.stages.animation(project.character_id).key)
            and self._key_now() == self._key
        )

    def _key_now(self) -> str:
        """The key of the motion, marked where a check knows where the character meets the measured background."""
        project = self.project
        now = (Moment.of(project.session), project.character_id)
        if now != self._seen:
            stages = project.session.stages
            met = " met" if stages.penetration(project.character_id) in project.session.cache else ""
            self._seen, self._now = now, stages.animation(project.character_id).key + met
        return self._now

    def meet_background(self) -> None:
        """Compute where the character meets the measured background, where there is one."""
        project = self.project
        if not project.character_id or project.progress:
            return
        stages = project.session.stages
        stage = stages.penetration(project.character_id)
        known = all(need in project.session.cache for need in stage.needs)
        if known and project.state(stage) in ("missing", "stale") and stage.key != self._asked:
            self._asked = stage.key
            project.start(stage.label, stage)

    def find(self, which: str) -> Problem | None:
        """The "worst" problem, or the "next" or the "previous" one in the order of the frames; None without any."""
        problems = self.check.problems if self.check is not None else ()
        if not problems:
            return None
        if which == "worst":
            self.at = self.at if self.at in problems and self.at is not problems[0] else problems[0]
            return self.at
        order = sorted(problems, key=lambda each: (each.worst, each.first, each.text))
        if self.at in order and self.at is not None and self.at.worst == self.project.frame:
            step = 1 if which == "next" else -1
            self.at = order[(order.index(self.at) + step) % len(order)]
        elif which == "next":
            self.at = next((each for each in order if each.worst >= self.project.frame), order[0])
        else:
            self.at = next((each for each in reversed(order) if each.worst <= self.project.frame), order[-1])
        return self.at

    def close(self) -> None:
        """Stop measuring."""
        self._closed = True
        self._calls.close()
