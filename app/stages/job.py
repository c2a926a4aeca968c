"""Jobs: stages on their way, with progress, cancel, streaming and one sentence when they fail."""

from __future__ import annotations

import threading
from typing import Any, Literal, Protocol

from app.stages.context import Token
from app.stages.stage import Stage

JobState = Literal["running", "done", "failed", "cancelled"]


class Listener(Protocol):
    """Hears of a job from worker threads; a window hands it on to its own thread."""

    def progressed(self, job: Job, fraction: float, label: str) -> None:
        """Some more is done."""

    def partial(self, job: Job, stage: Stage, value: Any) -> None:
        """A part of a result is there."""

    def finished_stage(self, job: Job, stage: Stage) -> None:
        """A result is in the cache."""

    def finished(self, job: Job) -> None:
        """The job has ended, see its state."""


class Silent:
    """A listener that does nothing; a base for those that hear only some of it."""

    def progressed(self, job: Job, fraction: float, label: str) -> None:
        """Some more is done."""

    def partial(self, job: Job, stage: Stage, value: Any) -> None:
        """A part of a result is there."""

    def finished_stage(self, job: Job, stage: Stage) -> None:
        """A result is in the cache."""

    def finished(self, job: Job) -> None:
        """The job has ended."""


class Job:
    """A request for the results of some stages, or for one call, which leaves its answer in ``value``."""

    def __init__(self, label: str, targets: tuple[Stage, ...], listener: Listener) -> None:
        self.label, self.targets, self.listener = label, targets, listener
        self.token = Token()
        self.state: JobState = "running"
        self.error: BaseException | None = None
        self.value: Any = None
        self.fraction = 0.0
        self._ended = threading.Event()
        self._done: dict[str, float] = {}
        self._weights = {stage.key: stage.weight for target in targets for stage in target.closure()}
        self._lock = threading.Lock()

    def cancel(self) -> None:
        """Stop as soon as the running computation reports progress; finished stages stay."""
        self.token.cancel()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for the end; False when the time ran out first."""
        return self._ended.wait(seconds)

    @property
    def sentence(self) -> str:
        """What went wrong, in one sentence; empty when nothing did."""
        return "" if self.error is None else str(self.error)

    def report(self, stage: Stage, fraction: float) -> None:
        """Take a stage's own progress and tell the listener the job's."""
        with self._lock:
            self._done[stage.key] = max(self._done.get(stage.key, 0.0), fraction)
            total = sum(self._weights.values()) or 1.0
            self.fraction = sum(self._weights[key] * done for key, done in self._done.items()) / total
        self.listener.progressed(self, self.fraction, stage.label)

    def tell(self, fraction: float) -> None:
        """Take the progress of a job that is one call; raises ``Cancelled`` when it was cancelled."""
        self.token.check()
        self.fraction = fraction
        self.listener.progressed(self, fraction, self.label)

    def skip(self, stage: Stage) -> None:
        """Count a stage as done whose result is there already, or that nothing needs."""
        with self._lock:
            self._done[stage.key] = 1.0

    def end(self, state: JobState, error: BaseException | None = None) -> None:
        """Set the final state, once."""
        self.state, self.error = state, error
        self.listener.finished(self)
        self._ended.set()
