"""An immutable mapping with sorted keys: the same content has the same order, bytes and hash."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Generic, TypeVar

K = TypeVar("K", int, str)
V = TypeVar("V", covariant=True)


class FrozenMap(Mapping[K, V], Generic[K, V]):
    """A mapping that never changes; ``with_item`` and ``without`` give new ones that share the values."""

    __slots__ = ("_hash", "_items")

    def __init__(self, items: Mapping[K, V] | None = None) -> None:
        self._items: dict[K, V] = dict(sorted(items.items())) if items else {}
        self._hash: int | None = None

    def __getitem__(self, key: K) -> V:
        return self._items[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        if self._hash is None:
            self._hash = hash(tuple(self._items.items()))
        return self._hash

    def __eq__(self, other: object) -> bool:
        if isinstance(other, FrozenMap):
            return self._items == other._items
        return NotImplemented

    def __repr__(self) -> str:
        return f"FrozenMap({self._items!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return FrozenMap, (self._items,)

    def with_item(self, key: K, value: V) -> FrozenMap[K, V]:  # type: ignore[misc]
        """Give a map in which ``key`` holds ``value``."""
        return FrozenMap({**self._items, key: value})

    def with_items(self, items: Mapping[K, V]) -> FrozenMap[K, V]:
        """Give a map in which all keys of ``items`` hold its values."""
        return FrozenMap({**self._items, **items})

    def without(self, *keys: K) -> FrozenMap[K, V]:
        """Give a map without these keys; keys that are not there do not matter."""
        return FrozenMap({key: value for key, value in self._items.items() if key not in keys})
