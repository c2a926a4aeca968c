"""Strands that go on beside each other: one bar, one end."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from app.actions.session import Session
from app.commands.together import Meter, Strand, together
from imitation.errors import Cancelled, InputError


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    """An empty project."""
    with closing(Session.new(tmp_path / "empty")) as opened:
        yield opened


def meter(total: float = 2.0) -> Meter:
    """A meter that nobody looks at."""
    return Meter(lambda fraction, label: None, total)


def busy(strand: Strand, label: str) -> None:
    """Work until told to stop."""
    progress = strand.step(label, 1.0)
    while True:
        progress(0.5)
        time.sleep(0.01)


def test_strands_run_at_once_and_give_their_answers(session: Session) -> None:
    """Two that wait for each other both come to their end."""
    meeting = threading.Barrier(2, timeout=30)

    def meet(answer: str) -> str:
        meeting.wait()
        return answer

    strands = {"left": lambda strand: meet("a"), "right": lambda strand: meet("b")}
    assert together(session, meter(), strands) == ["a", "b"]


def test_the_first_that_fails_stops_the_others(session: Session) -> None:
    """Its sentence is what is raised, not that the others were stopped."""

    def fail(strand: Strand) -> None:
        raise InputError("The disk is full.")

    with pytest.raises(InputError, match="disk is full"):
        together(session, meter(), {"busy": lambda strand: busy(strand, "left"), "failing": fail})
    assert not session.runner.jobs


def test_an_interrupt_stops_all(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl+C reaches the thread that waits; both strands end, and soon."""
    from app.stages.job import Job

    plain, calls = Job.wait, []

    def interrupted(job: Job, seconds: float | None = None) -> bool:
        calls.append(job)
        if len(calls) == 5:
            raise KeyboardInterrupt
        return plain(job, seconds)

    monkeypatch.setattr(Job, "wait", interrupted)
    with pytest.raises(KeyboardInterrupt):
        together(session, meter(), {"left": lambda strand: busy(strand, "left"), "right": lambda s: busy(s, "right")})
    assert not session.runner.jobs


def test_a_cancelled_strand_cancels_the_whole(session: Session) -> None:
    """One that was cancelled from elsewhere leaves no half answer."""

    def leave(strand: Strand) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        together(session, meter(), {"leaving": leave, "done": lambda strand: None})


def test_the_bar_never_falls_and_ends_full() -> None:
    """Steps of several strands add up, whatever order they report in."""
    shown: list[tuple[float, str]] = []
    whole = Meter(lambda fraction, label: shown.append((fraction, label)), 4.0)
    long, short = whole.step(3.0), whole.step(1.0)
    for step, fraction in ((long, 0.5), (short, 1.0), (long, 0.25), (short, 0.1), (long, 1.0)):
        step(fraction, "long" if step is long else "short")
    fractions = [fraction for fraction, _ in shown]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert {label for _, label in shown} == {"long", "short"}
