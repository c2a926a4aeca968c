"""Strands of work that go on beside each other, on one progress bar."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from app.actions.session import Session
from app.stages.job import Job, Silent
from app.stages.stage import Stage
from imitation.errors import Cancelled
from imitation.progress import Progress

LOOK = 0.05
"""Seconds between looks at whether a strand has ended."""


class Meter:
    """How far all strands are together, as one number that never falls.

    Parameters
    ----------
    show : takes a fraction in [0, 1] and what is being done.
    total : the sum of the weights of all steps, in expected seconds of work.
    """

    def __init__(self, show: Callable[[float, str], None], total: float) -> None:
        self._show, self._total = show, total
        self._done: list[float] = []
        self._lock = threading.Lock()

    def step(self, weight: float) -> Callable[[float, str], None]:
        """Begin a step; gives what takes its own fraction and what is being done in it."""
        with self._lock:
            place = len(self._done)
            self._done.append(0.0)

        def progress(fraction: float, label: str) -> None:
            with self._lock:
                self._done[place] = max(self._done[place], weight * fraction)
                done = min(1.0, sum(self._done) / self._total)
            self._show(done, label)

        return progress


class Strand:
    """One of several: its steps follow each other, and each ends as soon as the strand shall stop.

    Parameters
    ----------
    check : progress of the job that the strand is; raises ``Cancelled``.
    """

    def __init__(self, session: Session, meter: Meter, check: Progress) -> None:
        self.session, self._meter, self._check = session, meter, check

    def step(self, label: str, weight: float) -> Progress:
        """Begin a step of so many expected seconds."""
        show = self._meter.step(weight)

        def progress(fraction: float) -> None:
            self._check(fraction)
            show(fraction, label)

        progress(0.0)
        return progress

    def compute(self, label: str, weight: float, *targets: Stage) -> None:
        """Compute stages as one step; those that another strand computes, too, are computed once."""
        self._check(0.0)
        show = self._meter.step(weight)
        self.session.runner.run(label, targets, _Shown(show))
        show(1.0, label)


class _Shown(Silent):
    def __init__(self, show: Callable[[float, str], None]) -> None:
        self._show = show

    def progressed(self, job: Job, fraction: float, label: str) -> None:
        self._show(fraction, label)


def together(session: Session, meter: Meter, strands: dict[str, Callable[[Strand], Any]]) -> list[Any]:
    """Do all strands at once and give what they return; ends with the first that fails, and stops the others.

    No two may edit the document.
    """
    jobs = [_begun(session, meter, label, work) for label, work in strands.items()]
    try:
        waiting = list(jobs)
        while waiting:
            # An interrupt reaches this thread, and it looks at all strands: none is waited for alone.
            waiting[0].wait(LOOK)
            for job in jobs:
                if job.error is not None:
                    raise job.error
            waiting = [job for job in waiting if not job.wait(0)]
    except BaseException:
        # A strand may just be beginning its next step, whose job is not there yet: asked until all have ended.
        while not all(job.wait(LOOK) for job in jobs):
            for running in session.runner.jobs:
                running.cancel()
        raise
    if any(job.state == "cancelled" for job in jobs):
        raise Cancelled
    return [job.value for job in jobs]


def _begun(session: Session, meter: Meter, label: str, work: Callable[[Strand], Any]) -> Job:
    def carry(check: Progress) -> Any:
        return work(Strand(session, meter, check))

    return session.runner.call(label, carry)
