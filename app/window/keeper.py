"""Keeps results up to date while the user works: which stages are computed now, and what is given up for them."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from app.model.document import Document
from app.stages.job import Job
from app.stages.stage import Stage
from app.window import performing_keeper as performing
from app.window.project import Project

FOLLOWING, SCENE, MOVING = "Following points", "Solving the cameras", "Moving the character"
LINGER = 150
IDLE = 1500
"""Milliseconds after the last stroke of a mask before it is carried through the clip."""


class Keeper(QObject):
    """Follows the document: tracks are solved at once, motion where the user wants it so.

    A job whose stages are no longer wanted is given up a moment after the next one began, so that what both need is
    not begun twice.
    """

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self.automatic = True
        self.propagate_on_release = True
        self._asked: dict[str, frozenset[str]] = {}
        self._jobs: dict[str, Job] = {}
        self._old: list[Job] = []
        self._by_hand: set[str] = set()
        self._linger = QTimer(self)
        self._linger.setSingleShot(True)
        self._linger.setInterval(LINGER)
        self._linger.timeout.connect(self._give_up_old)
        self._idle = QTimer(self)
        self._idle.setSingleShot(True)
        self._idle.setInterval(IDLE)
        self._idle.timeout.connect(self._carry_masks)
        project.document_changed.connect(self._changed)
        project.stage_finished.connect(self._finished)

    def _changed(self, before: Document, after: Document) -> None:
        self.keep_up()
        if self.automatic and before.clip == after.clip and before.masks != after.masks:
            self._idle.start()

    def _carry_masks(self) -> None:
        """Carry drawn masks through the clip once nobody draws any more and nothing else is computed."""
        others = [job for job in self.project.progress if job is not self._jobs.get("masks")]
        if others:
            self._idle.start()
        elif self.automatic:
            stages = [self.project.session.stages.masks] if self.project.document.masks else []
            self._want("masks", "Carrying the masks", self._missing(stages))

    def _finished(self, stage: Stage) -> None:
        if stage.name.startswith("track/") or performing.leads_on(stage):
            self.keep_up()

    def keep_up(self) -> None:
        """Start what is missing and wanted automatically; what was asked for by hand goes on as it has to be now."""
        if not self.automatic:
            return
        tracks = self._missing(self._tracks())
        self._want("tracks", FOLLOWING, tracks)
        self._want("scene", SCENE, self._missing(self._cameras()) if self._going_on("scene") else [])
        motion = self._missing(self._motion())
        if self._going_on("motion"):
            asked = self._asked["motion"]
            self._want("motion", MOVING, [each for each in motion if self.propagate_on_release or each.key in asked])
        else:
            wanted = self.propagate_on_release and not tracks and self._moved_before()
            self._want("motion", MOVING, motion if wanted else [])
        self._keep_performance()

    def _keep_performance(self, *, all_: bool = False) -> None:
        """Sequences, the path through their motions, its clips and cuts: each once the one before is there."""
        for kind, label, stages in performing.wanted(self.project, all_=all_ or self._going_on("sequences")):
            self._want(kind, label, self._missing(stages))

    def run_performance(self) -> None:
        """Start what the performance needs, motions of characters included, and nothing else."""
        self._by_hand.add("sequences")
        self._keep_performance(all_=True)

    def _going_on(self, kind: str) -> bool:
        """Whether work that was asked for by hand is under way."""
        return kind in self._by_hand and self._alive(kind)

    def _alive(self, kind: str) -> bool:
        job = self._jobs.get(kind)
        return job is not None and job.state == "running" and not job.token.cancelled

    def _spread_from_here(self) -> None:
        """Let motion be solved outward from the frame in sight; the order changes no result."""
        memory = self.project.session.media.memory
        for character in self.project.document.characters:
            memory[("origin", character.id)] = self.project.frame

    def run_missing(self) -> bool:
        """Start everything that is missing, whatever is wanted automatically; says whether there was anything."""
        tracks, motion = self._missing(self._tracks()), self._missing(self._motion())
        scene = self._missing(self._cameras())
        self._by_hand = {"scene", "motion"}
        self._want("tracks", FOLLOWING, tracks)
        self._want("scene", SCENE, scene)
        self._want("motion", MOVING, motion)
        self.run_performance()
        return bool(tracks or scene or motion or self._alive("sequences") or self._alive("performance"))

    def _moved_before(self) -> bool:
        """Whether a motion was solved before: only what was there once is kept up without being asked for."""
        characters = [each for each in self.project.document.characters if each.visible]
        return any(self.project.motion_state(each.id) in ("stale", "running") for each in characters)

    def _tracks(self) -> list[Stage]:
        stages = self.project.session.stages
        tracks = sorted(self.project.document.tracks, key=lambda track: track.id != self.project.track_id)
        return [stages.track(track.id) for track in tracks]

    def _cameras(self) -> list[Stage]:
        stages = self.project.session.stages
        document = self.project.document
        if document.clip is None:
            return []
        return [stages.cameras, stages.world, *([stages.masks] if document.masks else [])]

    def _motion(self) -> list[Stage]:
        stages = self.project.session.stages
        return [stages.animation(each.id) for each in self.project.document.characters if each.visible]

    def _missing(self, stages: list[Stage]) -> list[Stage]:
        return [
            stage
            for stage in stages
            if self.project.state(stage) in ("missing", "stale", "running") and stage.why_blocked() is None
        ]

    def _want(self, kind: str, label: str, stages: list[Stage]) -> None:
        keys = frozenset(stage.key for stage in stages)
        running, alive = self._jobs.get(kind), self._alive(kind)
        if alive and (keys == self._asked.get(kind) or (keys and keys < self._asked.get(kind, frozenset()))):
            return
        if running is not None and alive:
            self._old.append(running)
            self._linger.start()
        self._asked[kind] = keys
        if stages:
            self._spread_from_here()
            self._jobs[kind] = self.project.start(label, *stages)
        else:
            self._jobs.pop(kind, None)
            self._by_hand.discard(kind)

    def _give_up_old(self) -> None:
        for job in self._old:
            job.cancel()
        self._old = []

    def close(self) -> None:
        """Stop following."""
        self._linger.stop()
        self._idle.stop()
        self.automatic = False
