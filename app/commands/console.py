"""What a person or a machine sees of a running command."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from app.actions.session import Session
from app.stages.job import Job, Silent
from app.stages.stage import Stage


class Console:
    """Prints answers and progress: a bar on a terminal, plain lines elsewhere, JSON for machines."""

    def __init__(self, *, as_json: bool = False, quiet: bool = False) -> None:
        self.as_json, self.quiet = as_json, quiet

    def say(self, sentence: str) -> None:
        """Print a sentence for people."""
        if not self.quiet and not self.as_json:
            print(sentence, flush=True)

    def warn(self, sentence: str) -> None:
        """Print a sentence that should not be overlooked, beside the answer."""
        if not self.quiet:
            print(sentence, file=sys.stderr, flush=True)

    def answer(self, values: dict[str, Any], lines: list[str] | None = None) -> None:
        """Give the answer: as JSON, or as the lines for people."""
        if self.as_json:
            print(json.dumps(values, indent=1, default=_plain), flush=True)
            return
        for line in lines if lines is not None else [f"{key}: {value}" for key, value in values.items()]:
            self.say(line)

    def compute(self, session: Session, label: str, targets: tuple[Stage, ...]) -> list[Any]:
        """Compute stages and show how far they are."""
        if self.quiet or self.as_json:
            return session.runner.run(label, targets)
        with self.progress(label) as bar:
            return session.runner.run(label, targets, _Bar(bar))

    @contextmanager
    def progress(self, label: str) -> Iterator[Any]:
        """Give a function ``(fraction, label)`` that shows progress."""
        if self.quiet or self.as_json:
            yield lambda fraction, label="": None
        elif sys.stderr.isatty():
            with _terminal_bar(label) as bar:
                yield bar
        else:
            yield _PlainBar(label)


class _Bar(Silent):
    def __init__(self, show: Any) -> None:
        self._show = show

    def progressed(self, job: Job, fraction: float, label: str) -> None:
        self._show(fraction, label)


class _PlainBar:
    """A line when a step begins, one a second at most, and one every ten seconds while nothing new begins."""

    def __init__(self, label: str) -> None:
        self._label, self._time = label, 0.0
        self._said: set[str] = set()
        self._lock = threading.Lock()

    def __call__(self, fraction: float, label: str = "") -> None:
        label = label or self._label
        with self._lock:
            now = time.monotonic()
            if now - self._time < (10 if label in self._said else 1):
                return
            self._said.add(label)
            self._time = now
            print(f"{label} ... {100 * fraction:.0f} %", file=sys.stderr, flush=True)


@contextmanager
def _terminal_bar(label: str) -> Iterator[Any]:
    from rich.console import Console as RichConsole
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=RichConsole(stderr=True), transient=True) as bars:
        task = bars.add_task(label, total=1.0)
        yield lambda fraction, label_=label: bars.update(task, completed=fraction, description=label_ or label)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)
