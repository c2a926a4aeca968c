"""Results by key: in memory up to a budget, and in the project folder."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import Any

import attrs
import numpy as np

from app.stages.stage import Stage
from app.storage.results import ResultStore
from imitation.errors import InputError

BUDGET = 1 << 30
LARGE = 1 << 26


class ResultCache:
    """Finds results that were computed before, whatever was edited in between.

    ``turns`` grows with every result that is put in: while it stands, what was not there is not there.
    """

    def __init__(self, store: ResultStore | None = None, budget: int = BUDGET) -> None:
        self.store = store
        self.budget = budget
        self._held: OrderedDict[str, tuple[Any, int]] = OrderedDict()
        self._bytes = 0
        self._lock = threading.Lock()
        self.storing_failed: str | None = None
        self.turns = 0

    def __contains__(self, stage: Stage) -> bool:
        return stage.key in self._held or (self.store is not None and stage.stored and stage.key in self.store)

    def knows(self, stage: Stage) -> bool:
        """Whether the project holds an earlier result of this stage, from other inputs."""
        return self.store is not None and stage.stored and self.store.knows(stage.name)

    def get(self, stage: Stage) -> Any:
        """Give a result; raises ``KeyError`` when it has to be computed."""
        with self._lock:
            if stage.key in self._held:
                self._held.move_to_end(stage.key)
                return self._held[stage.key][0]
        if self.store is None or not stage.stored:
            raise KeyError(stage.key)
        value = self.store.load(stage.key)
        self._hold(stage.key, value)
        return value

    def put(self, stage: Stage, value: Any) -> None:
        """Keep a result. A full disk is remembered in ``storing_failed``, the result stays in memory."""
        if self.store is not None and stage.stored:
            try:
                self.store.save(stage.key, value, stage.name)
                self.storing_failed = None
                if size_of(value) > LARGE:
                    # The copy on the disk serves from here on, mapped, so that a long clip does not fill the memory.
                    value = self.store.load(stage.key)
            except InputError as error:
                self.storing_failed = str(error)
        self._hold(stage.key, value)
        with self._lock:
            self.turns += 1

    def empty(self) -> None:
        """Give up what is held in memory; what is on the disk stays."""
        with self._lock:
            self._held.clear()
            self._bytes = 0

    def _hold(self, key: str, value: Any) -> None:
        size = size_of(value)
        with self._lock:
            if key in self._held:
                self._bytes -= self._held.pop(key)[1]
            self._held[key] = (value, size)
            self._bytes += size
            while self._bytes > self.budget and len(self._held) > 1:
                _, (_, freed) = self._held.popitem(last=False)
                self._bytes -= freed


def size_of(value: Any) -> int:
    """Bytes that a result holds in memory; memory-mapped arrays count nothing."""
    if isinstance(value, np.memmap):
        return 0
    if isinstance(value, np.ndarray):
        return 0 if isinstance(value.base, np.memmap) else int(value.nbytes)
    if isinstance(value, dict):
        return sum(map(size_of, value.values()))
    if isinstance(value, list | tuple):
        return sum(map(size_of, value))
    if attrs.has(type(value)):
        return sum(size_of(getattr(value, field.name)) for field in attrs.fields(type(value)))
    return 64
