"""Background work for the window: jobs of the session, heard in the window's own thread."""

from __future__ import annotations

import traceback
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.stages.job import Job
from app.stages.stage import Stage


class Ears(QObject):
    """A listener whose signals cross from worker threads to the window's thread."""

    progressed_ = Signal(object, float, str)
    partial_ = Signal(object, object, object)
    stage_ = Signal(object, object)
    finished_ = Signal(object)

    def progressed(self, job: Job, fraction: float, label: str) -> None:
        """Some more is done."""
        self.progressed_.emit(job, fraction, label)

    def partial(self, job: Job, stage: Stage, value: Any) -> None:
        """A part of a result is there."""
        self.partial_.emit(job, stage, value)

    def finished_stage(self, job: Job, stage: Stage) -> None:
        """A result is in the cache."""
        self.stage_.emit(job, stage)

    def finished(self, job: Job) -> None:
        """The job has ended."""
        self.finished_.emit(job)


def details(error: BaseException | None) -> str:
    """The trace of an error, for those who want to copy it."""
    return "" if error is None else "".join(traceback.format_exception(error))
