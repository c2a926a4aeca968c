"""What can go wrong in an engine, as three exceptions."""

from __future__ import annotations


class InputError(ValueError):
    """The input cannot be used. The message is one sentence: what is wrong, where, and what to do."""


class NoSolution(RuntimeError):  # noqa: N818 - the name says what the user is told
    """The input is sound, but what was asked has no solution. The message is one sentence that says why."""


class Cancelled(Exception):  # noqa: N818 - not an error
    """Raised by a progress callback to stop a computation; nothing partial is kept."""
