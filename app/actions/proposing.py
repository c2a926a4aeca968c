"""Proposals that the user accepts or not: contacts found in the tracks, the frame whose click helps most."""

from __future__ import annotations

from app.actions.session import Session
from app.model.edits import Edit, contacts
from app.model.values import Interval
from app.stages.results import World
from imitation.errors import InputError


def proposed_contacts(session: Session, track_id: str) -> list[Interval]:
    """Give intervals in which a computed track could stand on the ground, without those that are marked already.

    Raises ``InputError`` when the track or the cameras have not been computed yet.
    """
    from imitation.motion import propose_contacts

    track = session.document.track(track_id)
    found, world = session.ready(session.stages.track(track_id)), session.ready(session.stages.world)
    if found is None or not isinstance(world, World):
        raise InputError(f"{track.name} or the cameras have not been computed yet: run cameras and track first.")
    proposals = propose_contacts(found.positions, world.cameras)  # type: ignore[attr-defined]
    spans = [Interval(first, last) for first, last in proposals]
    return [span for span in spans if not any(contact.span.overlaps(span) for contact in track.contacts)]


def accept_contacts(session: Session, track_id: str, spans: list[Interval]) -> None:
    """Accept proposed contacts as one entry of the history."""
    document, track = session.document, session.document.track(track_id)
    for span in spans:
        document = contacts.add_contact(document, track_id, span.first, span.last, accepted=True).document
    if spans:
        count = f"{len(spans)} contacts" if len(spans) > 1 else "a contact"
        session.apply(Edit(document, f"Accept {count} of {track.name}", spans[0].first))
