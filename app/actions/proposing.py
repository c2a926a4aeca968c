"""Proposals that the user accepts or not: contacts found in the tracks, the frame whose click helps most."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from app.actions.session import Session
from app.model.document import Document
from app.model.edits import Edit, contacts
from app.model.edits.edit import clip_of
from app.model.values import Interval
from app.stages.results import Array, Masks, World
from app.stages.worldframe import ground_under
from imitation.errors import InputError, NoSolution

FEWEST_PIXELS, WIDTH_SHARE = 1.5, 0.004
"""How far a planted point's track may stray: tracks of real clips jitter by a few pixels of a wide picture."""
BESIDE = 8
"""Pixels by which a point on the subject's outline may lie beside its mask."""


def proposed_contacts(session: Session, track_id: str) -> list[Interval]:
    """Give intervals in which a computed track could stand on the ground, without those that are marked already.

    Raises ``InputError`` when the track or the cameras have not been computed yet.
    """
    from imitation.motion import propose_contacts

    track = session.document.track(track_id)
    found, world = session.ready(session.stages.track(track_id)), session.ready(session.stages.world)
    if found is None or not isinstance(world, World):
        raise InputError(f"{track.name} or the cameras have not been computed yet: run cameras and track first.")
    rest = [session.ready(session.stages.track(other.id)) for other in session.document.tracks if other is not track]
    places = [other.positions for other in rest if other is not None]  # type: ignore[attr-defined]
    proposals = propose_contacts(
        _on_subject(session, found.positions),  # type: ignore[attr-defined]
        world.cameras,
        tolerance=max(FEWEST_PIXELS, WIDTH_SHARE * clip_of(session.document).width),
        ground=_ground_of(session.document, world),
        others=np.stack(places, axis=1) if places else None,
    )
    spans = [Interval(first, last) for first, last in proposals]
    return [span for span in spans if not any(contact.span.overlaps(span) for contact in track.contacts)]


def _on_subject(session: Session, positions: Array) -> Array:
    """Positions (n, 2) without those beside the subject's mask: a track that was lost there stands still as well."""
    masks = session.ready(session.stages.masks)
    if not isinstance(masks, Masks):
        return positions
    kept = np.array(positions)
    for frame, (x, y) in enumerate(positions):
        if np.isfinite(x + y):
            left, top = max(0, round(x) - BESIDE), max(0, round(y) - BESIDE)
            if not masks[frame][top : round(y) + BESIDE + 1, left : round(x) + BESIDE + 1].any():
                kept[frame] = np.nan
    return kept


def _ground_of(document: Document, world: World) -> Callable[[int, Array], Array | None] | None:
    """Where rays meet the chosen ground; None where only a depth is known, for that is no place to stand on."""
    if world.depth is not None:
        return None

    def met(frame: int, pixel: Array) -> Array | None:
        try:
            place: Array = ground_under(document.world, world, frame, pixel).intersect(world.camera(frame), pixel)
        except NoSolution:
            return None
        return place

    return met


def accept_contacts(session: Session, track_id: str, spans: list[Interval]) -> None:
    """Accept proposed contacts as one entry of the history."""
    document, track = session.document, session.document.track(track_id)
    for span in spans:
        document = contacts.add_contact(document, track_id, span.first, span.last, accepted=True).document
    if spans:
        count = f"{len(spans)} contacts" if len(spans) > 1 else "a contact"
        session.apply(Edit(document, f"Accept {count} of {track.name}", spans[0].first))


def accept_all(session: Session, proposals: Mapping[str, Sequence[Interval]]) -> int:
    """Accept the proposed contacts of several tracks as one entry of the history; gives how many."""
    document, count, first = session.document, 0, None
    for track_id, spans in proposals.items():
        for span in spans:
            if not contacts.marked(document.track(track_id), span):
                document = contacts.add_contact(document, track_id, span.first, span.last, accepted=True).document
                count, first = count + 1, span.first if first is None else min(first, span.first)
    if count:
        session.apply(Edit(document, f"Accept {count} contacts" if count > 1 else "Accept a contact", first))
    return count


def click_wanted(session: Session, track_id: str = "") -> tuple[str, int] | None:
    """The track and the frame whose click would help most, of one track or of all; None where nothing is open.

    Only tracks that have been computed count.
    """
    from imitation.tracking import rank_tracks, suggest_correction

    tracks = [track for track in session.document.tracks if track_id in ("", track.id)]
    found = {track.id: session.ready(session.stages.track(track.id)) for track in tracks}
    known = {name: track for name, track in found.items() if track is not None}
    for name in rank_tracks(known):  # type: ignore[arg-type]
        frame = suggest_correction(known[name])  # type: ignore[arg-type]
        if frame is not None:
            return name, frame
    return None
