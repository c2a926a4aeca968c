"""A cache that holds what was used last, within a budget of bytes."""

from __future__ import annotations

from collections import OrderedDict
from typing import Generic, TypeVar

V = TypeVar("V")


class ByteCache(Generic[V]):
    """Values by frame; the longest unused are dropped when their bytes exceed the budget (one value always stays)."""

    def __init__(self, budget: int) -> None:
        self.budget, self.used = budget, 0
        self._values: OrderedDict[int, tuple[V, int]] = OrderedDict()

    def get(self, frame: int) -> V | None:
        """The value of a frame, which thereby counts as just used, or None."""
        found = self._values.get(frame)
        if found is None:
            return None
        self._values.move_to_end(frame)
        return found[0]

    def put(self, frame: int, value: V, size: int) -> None:
        """Keep a value of ``size`` bytes."""
        if frame in self._values:
            self.used -= self._values.pop(frame)[1]
        self._values[frame] = (value, size)
        self.used += size
        while self.used > self.budget and len(self._values) > 1:
            _, (_, dropped) = self._values.popitem(last=False)
            self.used -= dropped

    def clear(self) -> None:
        """Drop everything."""
        self._values.clear()
        self.used = 0

    def __len__(self) -> int:
        return len(self._values)
