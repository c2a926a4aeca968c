"""The open project as the window sees it: the session's document, results and jobs, and what is selected.

What is selected and which frame is shown are no part of the document and are never undone.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal

from app.actions.session import Session
from app.model.document import Document
from app.model.edits import Edit
from app.model.values import ModelError
from app.stages.job import Job
from app.stages.stage import Stage
from app.window.work import Ears, details
from imitation.errors import InputError, NoSolution
from imitation.progress import Progress

SPOKEN = 50
"""Milliseconds between two words on the progress of work: it reports far more often, and each repaints the bar."""
SEARCHING = "Searching the best path"
"""Work whose failure is no accident: where there is no path the timeline of the performance says so, and what helps."""


class Project(QObject):
    """Reads the session, calls it, and says what has changed."""

    document_changed = Signal(object, object)
    frame_changed = Signal(int)
    selection_changed = Signal()
    stage_finished = Signal(object)
    partial = Signal(object, object)
    work_changed = Signal()
    work_progressed = Signal()
    job_ended = Signal(object)
    closing = Signal()
    failed = Signal(str, str)
    saved_changed = Signal()
    shown_at = Signal(int, str)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.frame = 0
        self.track_id = ""
        self.character_id = session.document.characters[0].id if session.document.characters else ""
        self.vertex = -1
        self.progress: dict[Job, tuple[float, str]] = {}
        self._afterwards: Callable[[], object] | None = None
        self._progress = QTimer(self)
        self._progress.setSingleShot(True)
        self._progress.setInterval(SPOKEN)
        self._progress.timeout.connect(self.work_progressed)
        self._ears = Ears(self)
        self._ears.progressed_.connect(self._progressed)
        self._ears.partial_.connect(self._partial)
        self._ears.stage_.connect(self._stage)
        self._ears.finished_.connect(self._finished)
        self._forget: Callable[[], None] = session.subscribe(self._changed)

    # document ----------------------------------------------------------------------------------------------------

    @property
    def document(self) -> Document:
        """The document as it is."""
        return self.session.document

    @property
    def frame_count(self) -> int:
        """Frames of the clip, 0 without one."""
        return self.document.clip.frame_count if self.document.clip else 0

    @property
    def fps(self) -> float:
        """Frames per second of the clip."""
        return self.document.clip.fps if self.document.clip else 25.0

    @property
    def range(self) -> tuple[int, int]:
        """The frames that are played and worked on."""
        range_ = self.document.range
        return (range_.first, range_.last) if range_ else (0, max(self.frame_count - 1, 0))

    def edit(self, make: Callable[..., Edit], *values: Any, gesture: str | None = None, **options: Any) -> bool:
        """Do an edit of the document; one that cannot be done is told in its own words."""
        try:
            self.session.apply(make(self.document, *values, **options), gesture=gesture)
        except (ModelError, InputError) as error:
            self.failed.emit(str(error), "")
            return False
        return True

    def undo(self) -> None:
        """Take the last edit back; where it shows elsewhere, say where."""
        if self.session.history.undo_label is not None:
            version = self.session.undo()
            self._point_to(version.frame, f"Undone: {version.label}")

    def redo(self) -> None:
        """Do it again."""
        if self.session.history.redo_label is not None:
            version = self.session.redo()
            self._point_to(version.frame, f"Done again: {version.label}")

    def jump(self, index: int) -> None:
        """Go to a version of the history; where its edit shows elsewhere, say where."""
        history = self.session.history
        if index != history.present:
            self.session.jump(index)
            version = history.versions[index]
            self._point_to(version.frame, f"Gone to: {version.label}")

    def _point_to(self, frame: int | None, sentence: str) -> None:
        self.shown_at.emit(self.frame if frame is None else frame, sentence)

    def close_gesture(self) -> None:
        """End the gesture under way, so that the next edit is an entry of its own."""
        self.session.history.close_gesture()

    def save(self, path: Path | None = None) -> bool:
        """Save where the project lies, or at a new place."""
        try:
            if path is None:
                self.session.save()
            else:
                self.session.save_as(path)
        except (InputError, OSError) as error:
            self.failed.emit(str(error), details(error))
            return False
        self.saved_changed.emit()
        return True

    def _changed(self, before: Document, after: Document) -> None:
        ids = {track.id for track in after.tracks}
        if self.track_id not in ids:
            self.track_id = ""
        characters = {character.id for character in after.characters}
        if self.character_id not in characters:
            self.character_id = after.characters[0].id if after.characters else ""
            self.vertex = -1
        self.document_changed.emit(before, after)
        self.saved_changed.emit()

    # view --------------------------------------------------------------------------------------------------------

    def show_frame(self, frame: int) -> None:
        """Go to a frame."""
        frame = min(max(frame, 0), max(self.frame_count - 1, 0))
        if frame != self.frame:
            self.frame = frame
            self.frame_changed.emit(frame)

    def select_track(self, track_id: str) -> None:
        """Choose a track, or none."""
        if track_id != self.track_id:
            self.track_id = track_id
            self.selection_changed.emit()

    def select_next_track(self) -> None:
        """Choose the track after the chosen one."""
        ids = [track.id for track in self.document.tracks]
        if ids:
            number = ids.index(self.track_id) + 1 if self.track_id in ids else 0
            self.select_track(ids[number % len(ids)])

    def select_vertex(self, vertex: int) -> None:
        """Choose a vertex of the character, or none (-1)."""
        if vertex != self.vertex:
            self.vertex = vertex
            self.selection_changed.emit()

    def select_character(self, character_id: str) -> None:
        """Choose a character."""
        if character_id != self.character_id:
            self.character_id, self.vertex = character_id, -1
            self.selection_changed.emit()

    # results -----------------------------------------------------------------------------------------------------

    def result(self, stage: Stage) -> Any:
        """A stage's result if it is there, else None; nothing is computed."""
        return self.session.ready(stage)

    def state(self, stage: Stage) -> str:
        """How a stage stands."""
        return self.session.runner.state(stage)

    def motion_state(self, character_id: str) -> str:
        """How a character's motion stands; what was moved before and lacks only its edits is stale."""
        stages = self.session.stages
        state = self.state(stages.animation(character_id))
        return "stale" if state == "missing" and stages.base(character_id) in self.session.cache else state

    def start(self, label: str, *stages: Stage) -> Job:
        """Compute stages in the background."""
        job = self.session.start(label, stages, self._ears)
        self.progress[job] = (0.0, label)
        self.work_changed.emit()
        return job

    def call(self, label: str, work: Callable[[Progress], Any]) -> Job:
        """Do something in the background, such as writing a file, as a job; see ``Runner.call``."""
        job = self.session.runner.call(label, work, self._ears)
        self.progress[job] = (0.0, label)
        self.work_changed.emit()
        return job

    def writing(self) -> tuple[Job, ...]:
        """Jobs that write files or read them in: stopped, they begin anew, while results go on where they were."""
        return tuple(job for job in self.progress if not job.targets)

    def when_written(self, call: Callable[[], object]) -> None:
        """Call as soon as nothing is written any more; a later wish takes the place of this one."""
        self._afterwards = call
        self._written()

    def stop_writing(self, call: Callable[[], object]) -> None:
        """Cancel what is written, then call."""
        for job in self.writing():
            job.cancel()
        self.when_written(call)

    def _written(self) -> None:
        if self._afterwards is not None and not self.writing():
            call, self._afterwards = self._afterwards, None
            QTimer.singleShot(0, self, call)

    def cancel_work(self) -> None:
        """Stop all jobs; what is finished stays."""
        for job in tuple(self.progress):
            job.cancel()

    def _progressed(self, job: Job, fraction: float, label: str) -> None:
        if job in self.progress:
            self.progress[job] = (fraction, label)
            if not self._progress.isActive():
                self._progress.start()

    def _partial(self, job: Job, stage: Stage, value: Any) -> None:
        if job in self.progress and not job.token.cancelled:
            self.partial.emit(stage, value)

    def _stage(self, job: Job, stage: Stage) -> None:
        self.stage_finished.emit(stage)

    def _finished(self, job: Job) -> None:
        self.progress.pop(job, None)
        self._progress.stop()
        known = isinstance(job.error, InputError | ModelError | NoSolution)
        if job.state == "failed" and not (known and job.label == SEARCHING):
            sentence = job.sentence if known else f"{job.label} stopped by an error of the program."
            self.failed.emit(sentence, details(job.error))
        self.job_ended.emit(job)
        self.work_changed.emit()
        self._written()

    def close(self) -> None:
        """Stop all work and close the session; whoever asked has saved, or chosen to throw away, what was unsaved."""
        self.closing.emit()
        self._progress.stop()
        self._forget()
        self.progress.clear()
        with contextlib.suppress(InputError):
            self.session.forget_autosave()
        self.session.close()
