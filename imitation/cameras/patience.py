"""Asking for progress while a call that cannot be interrupted is at work."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

ASK = 0.1  # seconds


class _Task(Generic[T]):
    """A call in a thread of its own, with its result or error."""

    def __init__(self, work: Callable[[], T]) -> None:
        self.work = work
        self.result: list[T] = []
        self.error: BaseException | None = None

    def __call__(self) -> None:
        try:
            self.result.append(self.work())
        except BaseException as error:  # noqa: BLE001 - raised again in the caller's thread
            self.error = error


def patiently(work: Callable[[], T], ask: Callable[[], None]) -> T:
    """Give what ``work`` gives, and call ``ask`` every tenth of a second meanwhile.

    When ``ask`` raises, its exception leaves at once; the work, which must change nothing of the caller's, ends by
    itself unseen.
    """
    task = _Task(work)
    thread = threading.Thread(target=task, name="camera step", daemon=True)
    thread.start()
    thread.join(ASK)
    while thread.is_alive():
        ask()
        thread.join(ASK)
    if task.error is not None:
        raise task.error
    return task.result[0]
