"""A stage: a pure function of document values and earlier results, with the key of what it would give."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from typing import Any

import attrs


@attrs.frozen(eq=False)
class Stage:
    """One derived result, not yet computed.

    Attributes
    ----------
    name : what it is, the same through all edits of the document ("track/t3").
    label : what a person reads while it runs ("Tracking left paw").
    compute : module-level function ``(context, inputs, *results of needs) -> result``.
    inputs : the document values it depends on; their ``repr`` must say all that matters.
    needs : stages whose results it takes, in order.
    version : raised when the function gives other results for the same inputs.
    blocked : one sentence on what the user has to do first, None when it can run.
    stored : whether the result is kept in the project folder.
    weight : expected seconds, to share out the progress bar.
    """

    name: str
    label: str
    compute: Callable[..., Any]
    inputs: tuple[Any, ...] = ()
    needs: tuple[Stage, ...] = ()
    version: int = 1
    blocked: str | None = None
    stored: bool = True
    weight: float = 1.0
    key: str = attrs.field(init=False)

    def __attrs_post_init__(self) -> None:
        digest = hashlib.blake2b(digest_size=16)
        digest.update(f"{self.compute.__module__}.{self.compute.__qualname__} {self.version}".encode())
        digest.update(repr(self.inputs).encode())
        for stage in self.needs:
            digest.update(stage.key.encode())
        object.__setattr__(self, "key", digest.hexdigest())

    def why_blocked(self) -> str | None:
        """Give the first thing that the user has to do before this stage or one it needs can run."""
        for stage in self.closure():
            if stage.blocked is not None:
                return stage.blocked
        return None

    def closure(self) -> Iterator[Stage]:
        """Yield all stages this one stands on, needs before what needs them, itself last, each once."""
        seen: set[str] = set()

        def walk(stage: Stage) -> Iterator[Stage]:
            if stage.key in seen:
                return
            seen.add(stage.key)
            for need in stage.needs:
                yield from walk(need)
            yield stage

        yield from walk(self)
