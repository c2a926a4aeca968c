"""What states and results are read from, to tell whether anything can have changed since they were read."""

from __future__ import annotations

from dataclasses import dataclass

from app.actions.session import Session
from app.model.document import Document
from app.stages.cache import ResultCache


@dataclass(frozen=True, eq=False)
class Moment:
    """A document, the cache of its results, and how often results and states have changed until now.

    Asking a hundred stages for results takes longer than painting a frame; what was read in an equal moment holds.
    """

    document: Document
    cache: ResultCache
    results: int
    states: int

    @classmethod
    def of(cls, session: Session) -> Moment:
        """The moment of a session."""
        return cls(session.document, session.cache, session.cache.turns, session.runner.turns)

    def __eq__(self, other: object) -> bool:
        """Whether nothing has changed between two; documents are told by identity."""
        return (
            isinstance(other, Moment)
            and self.document is other.document
            and self.cache is other.cache
            and (self.results, self.states) == (other.results, other.states)
        )

    __hash__ = None  # type: ignore[assignment]
