"""Runs stages on an executor: needs first, each key once, results into the cache."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Executor, Future, InvalidStateError, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any, Literal

import attrs

from app.model.values import MediaRef
from app.stages.cache import ResultCache
from app.stages.context import Context, Token
from app.stages.job import Job, JobState, Listener, Silent
from app.stages.media import Media
from app.stages.stage import Stage
from imitation.errors import Cancelled, InputError
from imitation.progress import Progress

LOOK = 0.05
"""Seconds after which a job asks whether others have put results there; a cancel wakes it at once."""
PATIENCE = 1.0
"""Seconds after which it looks for them all the same: another process may have put them into the folder."""
StageState = Literal["fresh", "stale", "running", "failed", "blocked", "missing"]


class Runner:
    """Owns the workers of one open project.

    Parameters
    ----------
    cache : where results are found and put.
    media : opens what the document refers to.
    executor : anything with the interface of ``concurrent.futures.Executor``; None makes threads. Stages that run
        in other processes report no progress within a stage and stop only between stages.

    Attributes
    ----------
    turns : grows whenever a stage begins, ends or is given up: while it stands, so do the states.
    """

    def __init__(self, cache: ResultCache, media: Media, executor: Executor | None = None) -> None:
        self.cache, self.media = cache, media
        self._owned = executor is None
        self._executor = executor or ThreadPoolExecutor(max(2, (os.cpu_count() or 2) - 1), "stage")
        self._local = isinstance(self._executor, ThreadPoolExecutor)
        self._running: dict[str, _Running] = {}
        self._failed: dict[str, BaseException] = {}
        self._latest: dict[str, str] = {}
        self._jobs: set[Job] = set()
        self._lock = threading.RLock()
        self.turns = 0

    def state(self, stage: Stage) -> StageState:
        """Say how a stage stands."""
        if stage in self.cache:
            return "fresh"
        with self._lock:
            if stage.key in self._running:
                return "running"
            if stage.key in self._failed:
                return "failed"
            if stage.why_blocked() is not None:
                return "blocked"
            known = stage.name in self._latest or self.cache.knows(stage)
            return "stale" if known else "missing"

    def failure(self, stage: Stage) -> BaseException | None:
        """Give what this stage raised, None when it has not failed."""
        return self._failed.get(stage.key)

    def why_failed(self, stage: Stage) -> str | None:
        """Give the sentence of the failure of this stage, None when it has not failed."""
        error = self._failed.get(stage.key)
        return None if error is None else str(error)

    def try_again(self) -> None:
        """Forget what failed: what it failed for is there now."""
        with self._lock:
            self._failed.clear()
            self.turns += 1

    def start(self, label: str, targets: tuple[Stage, ...], listener: Listener | None = None) -> Job:
        """Compute what is missing for these stages in the background."""
        return self._begin(Job(label, targets, listener or Silent()), self._compute_all)

    def call(self, label: str, work: Callable[[Progress], Any], listener: Listener | None = None) -> Job:
        """Do something that leaves no result to keep, such as writing a file, as a job of its own.

        ``work`` gets a progress callback that raises ``Cancelled``; what it returns becomes the job's ``value``.
        """

        def carry(job: Job) -> None:
            job.value = work(job.tell)

        return self._begin(Job(label, (), listener or Silent()), carry)

    def _begin(self, job: Job, work: Callable[[Job], None]) -> Job:
        with self._lock:
            self._jobs.add(job)
        threading.Thread(target=self._carry, args=(job, work), name=f"job {job.label}", daemon=True).start()
        return job

    def run(self, label: str, targets: tuple[Stage, ...], listener: Listener | None = None) -> list[Any]:
        """Compute and give the results; an error is raised as it came."""
        job = self.start(label, targets, listener)
        try:
            job.wait()
        except KeyboardInterrupt:
            job.cancel()
            job.wait()
            raise Cancelled from None
        if job.error is not None:
            raise job.error
        if job.state == "cancelled":
            raise Cancelled
        return [self.cache.get(stage) for stage in targets]

    @property
    def jobs(self) -> tuple[Job, ...]:
        """Jobs that have not ended."""
        with self._lock:
            return tuple(self._jobs)

    def close(self) -> None:
        """Cancel all jobs, wait for their end and stop the own workers."""
        for job in self.jobs:
            job.cancel()
        for job in self.jobs:
            job.wait()
        if self._owned:
            self._executor.shutdown(wait=True, cancel_futures=True)

    def _carry(self, job: Job, work: Callable[[Job], None]) -> None:
        state: JobState = "done"
        error: BaseException | None = None
        try:
            work(job)
        except Cancelled:
            state = "cancelled"
        except Exception as failure:  # noqa: BLE001 - whatever a stage raises belongs to the job, not to this thread
            state, error = "failed", failure
        with self._lock:
            self._jobs.discard(job)
        job.end(state, error)

    def _compute_all(self, job: Job) -> None:
        order: list[Stage] = []
        for target in job.targets:
            order += [stage for stage in target.closure() if stage.key not in {s.key for s in order}]
        wanted = self._missing(job, order)
        pending: dict[Future[Any], Stage] = {}
        stop: Future[None] = Future()
        job.token.wakes(lambda: _settled(stop))
        seen, looked = -1, 0.0
        try:
            while wanted or pending:
                job.token.check()
                ready: list[Stage] = []
                if seen != self.cache.turns or time.monotonic() - looked >= PATIENCE:
                    # Each look asks the disk for all that the waiting stages need. Counted first: what is put in
                    # meanwhile is looked for again.
                    seen, looked = self.cache.turns, time.monotonic()
                    ready = [stage for stage in wanted if all(need in self.cache for need in stage.needs)]
                for stage in ready:
                    wanted.remove(stage)
                    pending[self._submit(job, stage)] = stage
                done, _ = wait([*pending, stop], timeout=LOOK, return_when=FIRST_COMPLETED)
                for future in done - {stop}:
                    stage = pending.pop(future)
                    future.result()
                    job.report(stage, 1.0)
                    job.listener.finished_stage(job, stage)
        finally:
            left = [future for future, stage in pending.items() if self._leave(job, stage)]
            if self._local:
                wait(left)

    def _missing(self, job: Job, order: list[Stage]) -> list[Stage]:
        """Give the stages to compute: those whose results some missing stage needs, not the whole past."""
        needed = {target.key for target in job.targets}
        for stage in reversed(order):
            if stage.key in needed and stage not in self.cache:
                needed |= {need.key for need in stage.needs}
        missing = []
        for stage in order:
            if stage.key not in needed or stage in self.cache:
                job.skip(stage)
                continue
            if stage.blocked is not None:
                raise InputError(stage.blocked)
            missing.append(stage)
        return missing

    def _submit(self, job: Job, stage: Stage) -> Future[Any]:
        with self._lock:
            running = self._running.get(stage.key)
            if running is not None and not running.token.cancelled:
                running.jobs.add(job)
                return running.future
            self._failed.pop(stage.key, None)
            token = Token()
            running = _Running(token, {job})
            self._running[stage.key] = running
            self.turns += 1
            if self._local:
                running.future = self._executor.submit(self._compute_here, stage, running)
            else:
                results = [self.cache.get(need) for need in stage.needs]
                found = {media: self.media.locate(media) for media in _media_in(stage.inputs)}
                there = self._executor.submit(_compute_there, stage.compute, stage.inputs, results, found)
                running.future = _then(there, lambda future: self._settle(stage, running, future))
            return running.future

    def _compute_here(self, stage: Stage, running: _Running) -> None:
        def progress(fraction: float) -> None:
            for job in tuple(running.jobs):
                job.report(stage, fraction)

        def emit(value: Any) -> None:
            for job in tuple(running.jobs):
                job.listener.partial(job, stage, value)

        context = Context(self.media, progress, emit, running.token)
        future: Future[Any] = Future()
        try:
            running.token.check()
            results = [self.cache.get(need) for need in stage.needs]
            future.set_result(stage.compute(context, stage.inputs, *results))
        except BaseException as error:  # noqa: BLE001 - handed on to whoever waits
            future.set_exception(error)
        self._settle(stage, running, future)

    def _settle(self, stage: Stage, running: _Running, future: Future[Any]) -> None:
        """Put a result into the cache, or remember why there is none."""
        error = future.exception()
        if error is None:
            self.cache.put(stage, future.result())
        with self._lock:
            self.turns += 1
            if self._running.get(stage.key) is running:
                del self._running[stage.key]
            if error is None:
                self._latest[stage.name] = stage.key
            elif not isinstance(error, Cancelled):
                self._failed[stage.key] = error
        if error is not None:
            raise error

    def _leave(self, job: Job, stage: Stage) -> bool:
        """A job no longer waits for a stage; the last one to leave stops it. Says whether it has to be waited for.

        What other jobs wait for goes on. What has not begun is taken off the queue: no worker will ever settle it.
        """
        with self._lock:
            running = self._running.get(stage.key)
            if running is None:
                return False
            running.jobs.discard(job)
            if running.jobs:
                return False
            running.token.cancel()
            if self._local and running.future.cancel():
                del self._running[stage.key]
                self.turns += 1
                return False
            return True


class _Running:
    future: Future[Any]

    def __init__(self, token: Token, jobs: set[Job]) -> None:
        self.token, self.jobs = token, jobs


def _settled(future: Future[None]) -> None:
    """Settle a future that only wakes whoever waits for it."""
    with contextlib.suppress(InvalidStateError):
        future.set_result(None)


def _compute_there(compute: Any, inputs: tuple[Any, ...], results: list[Any], found: dict[MediaRef, Path]) -> Any:
    media = Media(found.__getitem__)
    try:
        return compute(Context(media), inputs, *results)
    finally:
        media.close()


def _media_in(inputs: Any) -> set[MediaRef]:
    if isinstance(inputs, MediaRef):
        return {inputs}
    if isinstance(inputs, tuple):
        return set().union(*map(_media_in, inputs))
    if attrs.has(type(inputs)):
        return set().union(*(_media_in(getattr(inputs, field.name)) for field in attrs.fields(type(inputs))))
    return set()


def _then(future: Future[Any], settle: Any) -> Future[Any]:
    after: Future[Any] = Future()

    def done(inner: Future[Any]) -> None:
        try:
            settle(inner)
            after.set_result(None)
        except BaseException as error:  # noqa: BLE001 - handed on to whoever waits
            after.set_exception(error)

    future.add_done_callback(done)
    return after
