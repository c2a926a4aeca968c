"""The sample project, opened as one that has no place yet."""

from __future__ import annotations

from app.actions.session import Session


def sample_session() -> Session:
    """A session on the built-in sample: its clip, lassos, clicks, contacts and characters."""
    from app.actions.sample import fill_with_sample

    session = Session.new(name="Sample")
    fill_with_sample(session)
    session.history.mark_saved()
    return session
