"""Stages run once a key, stop when asked, and say why they failed."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from app.stages.cache import ResultCache
from app.stages.context import Context, Token
from app.stages.job import Job, Silent
from app.stages.media import Media
from app.stages.runner import Runner
from app.stages.stage import Stage
from app.storage.results import ResultStore
from imitation import InputError

CALLS: list[str] = []
GATE = threading.Event()


def add(context: Context, inputs: tuple[str, int], *needs: int) -> int:
    """Add a number to the results it needs."""
    CALLS.append(inputs[0])
    return inputs[1] + sum(needs)


def slow(context: Context, inputs: tuple[float], *needs: Any) -> str:
    """Take some seconds in small steps."""
    end = time.monotonic() + inputs[0]
    while time.monotonic() < end:
        context.progress(0.5)
        time.sleep(0.01)
    return "done"


def stream(context: Context, inputs: tuple[int]) -> int:
    """Hand out parts before the whole."""
    for part in range(inputs[0]):
        context.emit(part)
    return inputs[0]


def fail(context: Context, inputs: tuple[str]) -> None:
    """Refuse."""
    raise InputError(inputs[0])


def number(name: str, value: int, *needs: Stage) -> Stage:
    """A stage that adds."""
    return Stage(name, name, add, (name, value), needs)


@pytest.fixture
def runner(tmp_path: Path) -> Iterator[Runner]:
    """A runner on threads with a store."""
    CALLS.clear()
    made = Runner(ResultCache(ResultStore(tmp_path)), Media(lambda media: tmp_path))
    yield made
    made.close()


def test_needs_run_first_and_each_once(runner: Runner) -> None:
    """A diamond of stages computes each of them one time."""
    a = number("a", 1)
    b, c = number("b", 10, a), number("c", 100, a)
    assert runner.run("sum", (number("d", 1000, b, c),)) == [1112]
    assert sorted(CALLS) == ["a", "b", "c", "d"]


def test_only_what_changed_is_computed_again(runner: Runner) -> None:
    """Another input of one stage leaves the results beside it; going back finds the old result."""
    a, b = number("a", 1), number("b", 2)
    runner.run("first", (number("sum", 0, a, b),))
    CALLS.clear()
    runner.run("second", (number("sum", 0, a, number("b", 3)),))
    assert CALLS == ["b", "sum"]
    CALLS.clear()
    assert runner.run("back", (number("sum", 0, a, b),)) == [3]
    assert CALLS == []


def test_results_are_found_in_the_folder_later(tmp_path: Path) -> None:
    """A new session finds what an earlier one computed."""
    CALLS.clear()
    for _ in range(2):
        runner = Runner(ResultCache(ResultStore(tmp_path)), Media(lambda media: tmp_path))
        assert runner.run("a", (number("a", 5),)) == [5]
        runner.close()
    assert CALLS == ["a"]


def test_a_later_session_knows_what_is_stale(tmp_path: Path) -> None:
    """What an earlier session computed from other inputs is stale, what none computed is missing."""
    for value, state in ((5, "missing"), (6, "stale")):
        runner = Runner(ResultCache(ResultStore(tmp_path)), Media(lambda media: tmp_path))
        assert runner.state(number("a", value)) == state
        runner.run("a", (number("a", value),))
        assert runner.state(number("b", value)) == "missing"
        runner.close()


def test_states(runner: Runner) -> None:
    """Missing, fresh, stale after a change, failed with its reason, blocked with what is missing."""
    a = number("a", 1)
    assert runner.state(a) == "missing"
    runner.run("a", (a,))
    assert runner.state(a) == "fresh"
    assert runner.state(number("a", 2)) == "stale"
    bad = Stage("bad", "bad", fail, ("The video is broken.",))
    with pytest.raises(InputError, match="The video is broken"):
        runner.run("bad", (bad,))
    assert runner.state(bad) == "failed"
    assert runner.why_failed(bad) == "The video is broken."
    waiting = number("c", 1, Stage("v", "v", add, blocked="Add a video first."))
    assert runner.state(waiting) == "blocked"
    with pytest.raises(InputError, match="Add a video first"):
        runner.run("c", (waiting,))


def test_a_failed_stage_can_be_tried_again(runner: Runner) -> None:
    """A failure is not remembered as a result."""
    bad = Stage("bad", "bad", fail, ("no",))
    for _ in range(2):
        with pytest.raises(InputError):
            runner.run("bad", (bad,))


def test_cancel_is_quick_and_keeps_what_is_done(runner: Runner) -> None:
    """A cancelled job ends soon; its finished stages stay, and the rest can be started anew."""
    done = number("done", 1)
    long = Stage("long", "long", slow, (30.0,), (done,))
    job = runner.start("long", (long,))
    deadline = time.monotonic() + 10
    while runner.state(done) != "fresh" and time.monotonic() < deadline:
        time.sleep(0.005)
    job.cancel()
    assert job.wait(5)
    assert job.state == "cancelled"
    assert runner.state(done) == "fresh"
    assert runner.state(long) == "missing"


def test_a_cancel_wakes_the_job_at_once(runner: Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """It does not wait until the job looks round by itself; one that came before it waits is heard as well."""
    monkeypatch.setattr("app.stages.runner.LOOK", 60.0)
    job = runner.start("long", (Stage("long", "long", slow, (30.0,)),))
    while runner.state(job.targets[0]) != "running":
        time.sleep(0.005)
    job.cancel()
    assert job.wait(20)
    assert job.state == "cancelled"
    token, heard = Token(), []
    token.cancel()
    token.wakes(lambda: heard.append(1))
    assert heard


def test_two_jobs_share_a_stage_and_one_may_leave(runner: Runner) -> None:
    """Cancelling one of two jobs that wait for a stage does not take it from the other."""
    shared = Stage("shared", "shared", slow, (2.0,))
    first, second = runner.start("first", (shared,)), runner.start("second", (shared,))
    first.cancel()
    assert first.wait(10)
    assert first.state == "cancelled"
    assert second.wait(10)
    assert second.state == "done"


def gated(context: Context, inputs: tuple[float]) -> str:
    """Hold a worker until the gate opens."""
    assert GATE.wait(10)
    return "done"


def test_a_job_that_leaves_takes_nothing_off_the_queue_that_another_waits_for(tmp_path: Path) -> None:
    """A stage that has not begun is shared by two jobs; one is cancelled, the other gets its result."""
    GATE.clear()
    CALLS.clear()
    with ThreadPoolExecutor(1) as workers:
        runner = Runner(ResultCache(ResultStore(tmp_path)), Media(lambda media: tmp_path), workers)
        holding = runner.start("hold", (Stage("hold", "hold", gated, (1.0,), ()),))
        shared, alone = number("shared", 7), number("alone", 8)
        first, second = runner.start("first", (shared, alone)), runner.start("second", (shared,))
        end = time.monotonic() + 10
        while len(getattr(runner._running.get(shared.key), "jobs", ())) < 2 or runner.state(alone) != "running":
            assert time.monotonic() < end
            time.sleep(0.01)
        first.cancel()
        assert first.wait(5), "a job need not wait for what others go on with"
        assert first.state == "cancelled"
        assert runner.state(alone) == "missing", "nobody waits for it any more"
        GATE.set()
        assert second.wait(10)
        assert second.state == "done"
        assert holding.wait(10)
        assert runner.cache.get(shared) == 7
        assert CALLS == ["shared"]
        runner.close()


def test_a_job_that_waits_leaves_the_disk_alone(runner: Runner, monkeypatch: pytest.MonkeyPatch) -> None:
    """While nothing is put in, what forty stages wait for is not asked for twenty times a second."""
    asked: list[str] = []
    there = ResultStore.__contains__
    monkeypatch.setattr(ResultStore, "__contains__", lambda self, key: asked.append(key) or there(self, key))
    long = Stage("long", "Long", slow, (0.8,))
    job = runner.start("all", tuple(Stage(f"of {k}", "Of", after, (k,), (long,)) for k in range(40)))
    assert job.wait(20)
    assert job.state == "done"
    assert asked.count(long.key) < 4 * 40


def after(context: Context, inputs: tuple[int], *needs: Any) -> int:
    """Give a number, whatever is needed for it."""
    return inputs[0]


def test_a_result_that_another_process_put_into_the_folder_is_found(tmp_path: Path) -> None:
    """A stage begins when what it needs lies in the folder, though this process is still at work on that."""
    store = ResultStore(tmp_path / "results")
    GATE.clear()
    runner = Runner(ResultCache(store), Media(lambda ref: tmp_path), ThreadPoolExecutor(2))
    try:
        first = Stage("gated", "Gated", gated, (30.0,))
        second = Stage("after", "After", after, (7,), (first,))
        job = runner.start("both", (second,))
        time.sleep(0.3)
        ResultStore(tmp_path / "results").save(first.key, "elsewhere", first.name)
        end = time.monotonic() + 10
        while second not in runner.cache and time.monotonic() < end:
            time.sleep(0.02)
        assert second in runner.cache
        assert job.state == "running"
    finally:
        GATE.set()
        runner.close()


def test_partial_results_stream(runner: Runner) -> None:
    """Parts come in order before the whole, progress ends at 1."""
    heard: list[Any] = []

    class Ear(Silent):
        def partial(self, job: Job, stage: Stage, value: Any) -> None:
            heard.append(value)

        def finished(self, job: Job) -> None:
            heard.append((job.state, job.fraction))

    runner.run("stream", (Stage("s", "s", stream, (3,)),), Ear())
    assert heard == [0, 1, 2, ("done", 1.0)]


def test_stages_run_in_other_processes(tmp_path: Path) -> None:
    """Any executor with the standard interface will do."""
    with ProcessPoolExecutor(1) as pool:
        runner = Runner(ResultCache(ResultStore(tmp_path)), Media(lambda media: tmp_path), pool)
        assert runner.run("sum", (number("b", 10, number("a", 1)),)) == [11]
        with pytest.raises(InputError, match="not today"):
            runner.run("bad", (Stage("bad", "bad", fail, ("not today",)),))
        runner.close()


def test_a_full_disk_costs_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """When results cannot be stored they stay in memory, and the cache says why."""

    def full(self: ResultStore, key: str, value: Any, name: str = "") -> None:
        raise InputError("The disk is full.")

    monkeypatch.setattr(ResultStore, "save", full)
    cache = ResultCache(ResultStore(tmp_path))
    runner = Runner(cache, Media(lambda media: tmp_path))
    assert runner.run("a", (number("a", 5),)) == [5]
    assert cache.storing_failed == "The disk is full."
    runner.close()


def test_memory_stays_in_its_budget(tmp_path: Path) -> None:
    """Old results leave the memory and come back from the folder."""
    import numpy as np

    cache = ResultCache(ResultStore(tmp_path), budget=20_000)
    stages = [number(f"s{i}", i) for i in range(10)]
    for i, stage in enumerate(stages):
        cache.put(stage, np.full(1000, float(i)))
    assert cache._bytes <= 20_000
    assert [cache.get(stage)[0] for stage in stages] == list(range(10))


def test_a_call_is_a_job_with_progress_answer_and_cancel(runner: Runner) -> None:
    """What it returns is kept, its progress is told; cancelled it ends there; an error is the job's."""
    heard: list[float] = []

    class Ear(Silent):
        def progressed(self, job: Job, fraction: float, label: str) -> None:
            heard.append(fraction)

    def work(progress: Any) -> str:
        progress(0.5)
        return "written"

    done = runner.call("Writing", work, Ear())
    assert done.wait(5)
    assert (done.state, done.value, heard) == ("done", "written", [0.5])

    def endless(progress: Any) -> None:
        while True:
            progress(0.1)
            time.sleep(0.005)

    stopped = runner.call("Writing", endless)
    assert stopped in runner.jobs
    stopped.cancel()
    assert stopped.wait(5)
    assert stopped.state == "cancelled"

    def refuse(progress: Any) -> None:
        raise InputError("The disk is full.")

    failed = runner.call("Writing", refuse)
    assert failed.wait(5)
    assert (failed.state, failed.sentence) == ("failed", "The disk is full.")
    left = runner.call("Writing", endless)
    runner.close()
    assert left.state == "cancelled", "closing ends calls too"
