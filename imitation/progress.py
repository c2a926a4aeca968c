"""Progress callbacks: a callable that gets a fraction in [0, 1] and may raise ``Cancelled``."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

Progress = Callable[[float], None]
T = TypeVar("T")


def silent(fraction: float) -> None:
    """Take a fraction and do nothing."""


def part(progress: Progress | None, first: float, last: float) -> Progress:
    """Map a sub-task's fractions [0, 1] to [first, last] of the whole."""
    if progress is None:
        return silent
    report = progress

    def inner(fraction: float) -> None:
        report(first + (last - first) * fraction)

    return inner


def steps(items: Sequence[T], progress: Progress | None) -> Iterator[T]:
    """Yield the items and report after each how much of them is done."""
    report = progress or silent
    report(0.0)
    for done, item in enumerate(items, start=1):
        yield item
        report(done / len(items))
