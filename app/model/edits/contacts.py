"""Edits of contacts: two marks make an interval in which a point stands on the ground."""

from __future__ import annotations

from collections.abc import Iterable

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit, checked_interval, checked_place
from app.model.tracks import Contact, Track
from app.model.values import Interval, ModelError


def add_contact(
    document: Document,
    track_id: str,
    first: int,
    last: int,
    *,
    place: Iterable[float] | None = None,
    accepted: bool = False,
) -> Edit:
    """Mark a contact; it joins the contacts that it touches or overlaps."""
    track = document.track(track_id)
    span = checked_interval(document, first, last)
    kept: list[Contact] = []
    given = None if place is None else checked_place(place)
    for contact in track.contacts:
        if contact.span.overlaps(span):
            span = Interval(min(span.first, contact.span.first), max(span.last, contact.span.last))
            given = given if given is not None else contact.place
        else:
            kept.append(contact)
    kept.append(Contact(span, given, accepted))
    verb = "Accept contact of" if accepted else "Mark contact of"
    frames = f"frame {span.first}" if span.first == span.last else f"frames {span.first}-{span.last}"
    return Edit(_with(document, track, kept), f"{verb} {track.name}, {frames}", span.first)


def marked(track: Track, span: Interval) -> bool:
    """Whether some of these frames are marked as a contact already."""
    return any(contact.span.overlaps(span) for contact in track.contacts)


def toggle_contact(document: Document, track_id: str, frame: int) -> Edit:
    """Mark one frame as a contact, joined to the contacts beside it; or take one frame out of its contact."""
    track = document.track(track_id)
    span = checked_interval(document, frame, frame)
    here = next((contact for contact in track.contacts if frame in contact.span), None)
    if here is None:
        beside = [c for c in track.contacts if frame in (c.span.first - 1, c.span.last + 1)]
        kept = [contact for contact in track.contacts if contact not in beside]
        first = min([span.first, *(c.span.first for c in beside)])
        last = max([span.last, *(c.span.last for c in beside)])
        place = next((contact.place for contact in beside if contact.place is not None), None)
        kept.append(Contact(Interval(first, last), place))
        return Edit(_with(document, track, kept), f"Mark contact of {track.name}, frame {frame}", frame)
    kept = [contact for contact in track.contacts if contact is not here]
    for first, last in ((here.span.first, frame - 1), (frame + 1, here.span.last)):
        if first <= last:
            kept.append(attrs.evolve(here, span=Interval(first, last)))
    return Edit(_with(document, track, kept), f"No contact of {track.name}, frame {frame}", frame)


def trim_contact(document: Document, track_id: str, frame: int, first: int, last: int) -> Edit:
    """Give the contact that holds ``frame`` other ends."""
    track = document.track(track_id)
    contact = _contact_at(track, frame)
    span = checked_interval(document, first, last)
    others = [other for other in track.contacts if other is not contact]
    if any(other.span.overlaps(span) for other in others):
        raise ModelError(
            f"The contact of {track.name} would run into its neighbour: join them by marking one interval."
        )
    changed = [*others, attrs.evolve(contact, span=span)]
    return Edit(_with(document, track, changed), f"Trim contact of {track.name}, frame {frame}", frame)


def place_contact(document: Document, track_id: str, frame: int, place: Iterable[float] | None) -> Edit:
    """Say where a contact lies, or leave it to the ground again (None)."""
    track = document.track(track_id)
    contact = _contact_at(track, frame)
    given = None if place is None else checked_place(place)
    changed = [attrs.evolve(c, place=given) if c is contact else c for c in track.contacts]
    return Edit(_with(document, track, changed), f"Place contact of {track.name}, frame {frame}", frame)


def remove_contact(document: Document, track_id: str, frame: int) -> Edit:
    """Remove the contact that holds this frame."""
    track = document.track(track_id)
    contact = _contact_at(track, frame)
    kept = [other for other in track.contacts if other is not contact]
    return Edit(_with(document, track, kept), f"Remove contact of {track.name}, frame {frame}", frame)


def _contact_at(track: Track, frame: int) -> Contact:
    for contact in track.contacts:
        if frame in contact.span:
            return contact
    raise ModelError(f"{track.name} has no contact in frame {frame}.")


def _with(document: Document, track: Track, contacts: list[Contact]) -> Document:
    ordered = tuple(sorted(contacts, key=lambda contact: contact.span))
    return document.with_track(attrs.evolve(track, contacts=ordered))
