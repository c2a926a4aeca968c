"""Edits of tracks: clicks, corrections, ends, hidden frames, names."""

from __future__ import annotations

from collections.abc import Iterable

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit, checked_frame, checked_interval, checked_name, checked_pixel, cut, merged
from app.model.frozen import FrozenMap
from app.model.tracks import Track, TrackMode
from app.model.values import Interval, ModelError

COLOURS = 8


def add_track(document: Document, frame: int, point: Iterable[float], *, name: str = "") -> Edit:
    """Begin a track with one click."""
    frame, pixel = checked_frame(document, frame), checked_pixel(document, point)
    number = document.next_id
    chosen = _free_name(document, name.strip() or f"point {number}")
    track = Track(f"t{number}", chosen, FrozenMap({frame: pixel}), colour=len(document.tracks) % COLOURS)
    grown = attrs.evolve(document, tracks=(*document.tracks, track), next_id=number + 1)
    return Edit(grown, f"Add {chosen}, frame {frame}", frame)


def set_click(document: Document, track_id: str, frame: int, point: Iterable[float]) -> Edit:
    """Add a click to a track or move the one of this frame; in a frame where the track had ended it begins again."""
    track = document.track(track_id)
    frame, pixel = checked_frame(document, frame), checked_pixel(document, point)
    if any(frame in interval for interval in track.absent):
        return restart_track(document, track_id, frame, pixel)
    verb = "Move" if frame in track.clicks else "Correct"
    moved = attrs.evolve(track, clicks=track.clicks.with_item(frame, pixel))
    return Edit(document.with_track(moved), f"{verb} {track.name}, frame {frame}", frame)


def remove_click(document: Document, track_id: str, frame: int) -> Edit:
    """Remove a click; a track keeps at least one."""
    track = document.track(track_id)
    if frame not in track.clicks:
        raise ModelError(f"{track.name} has no click in frame {frame}.")
    if len(track.clicks) == 1:
        raise ModelError(f"{track.name} has only this click: delete the track instead.")
    smaller = attrs.evolve(track, clicks=track.clicks.without(frame))
    return Edit(document.with_track(smaller), f"Remove click of {track.name}, frame {frame}", frame)


def delete_track(document: Document, track_id: str) -> Edit:
    """Delete a track and what hangs on it: pairs, mirrors, followers, a constant depth."""
    track = document.track(track_id)
    tracks = tuple(
        attrs.evolve(other, mirror=None, mirror_lag=None) if other.mirror == track_id else other
        for other in document.tracks
        if other.id != track_id
    )
    characters = tuple(
        attrs.evolve(
            character,
            pairs=character.pairs.without(track_id),
            following=FrozenMap({v: t for v, t in character.following.items() if t != track_id}),
        )
        if track_id in character.pairs or track_id in character.following.values()
        else character
        for character in document.characters
    )
    world = document.world
    if track_id in world.depth_tracks:
        world = attrs.evolve(world, depth_tracks=tuple(each for each in world.depth_tracks if each != track_id))
    if world.seen is not None and track_id in world.seen.tracks:
        world = attrs.evolve(world, seen=attrs.evolve(world.seen, tracks=()))
    smaller = attrs.evolve(document, tracks=tracks, characters=characters, world=world)
    return Edit(smaller, f"Delete {track.name}")


def end_track(document: Document, track_id: str, frame: int) -> Edit:
    """End a track before this frame, up to its next click or the end of the clip."""
    track = document.track(track_id)
    frame = checked_frame(document, frame)
    if frame in track.clicks:
        raise ModelError(f"{track.name} has a click in frame {frame}: end it in a frame after that.")
    following = [click for click in track.clicks if click > frame]
    if len(following) == len(track.clicks):
        raise ModelError(f"{track.name} has no click before frame {frame}: a track ends after a click.")
    last = following[0] - 1 if following else _last_frame(document)
    ended = attrs.evolve(track, absent=merged((*track.absent, Interval(frame, last))))
    return Edit(document.with_track(ended), f"End {track.name}, frame {frame}", frame)


def restart_track(document: Document, track_id: str, frame: int, point: Iterable[float]) -> Edit:
    """Begin a track again with a click in a frame in which it had ended; frames after it are tracked again."""
    track = document.track(track_id)
    frame, pixel = checked_frame(document, frame), checked_pixel(document, point)
    gone = next((interval for interval in track.absent if frame in interval), None)
    if gone is None:
        raise ModelError(f"{track.name} has not ended in frame {frame}: move it there instead.")
    again = attrs.evolve(
        track,
        clicks=track.clicks.with_item(frame, pixel),
        absent=cut(track.absent, Interval(frame, gone.last)),
    )
    return Edit(document.with_track(again), f"Restart {track.name}, frame {frame}", frame)


def set_occluded(document: Document, track_id: str, first: int, last: int, hidden: bool) -> Edit:
    """Say that a point is hidden in these frames, or that it is not."""
    track = document.track(track_id)
    interval = checked_interval(document, first, last)
    changed = merged((*track.occluded, interval)) if hidden else cut(track.occluded, interval)
    word = "Hide" if hidden else "Show"
    where = f"frame {interval.first}" if interval.first == interval.last else f"frames {interval.first}-{interval.last}"
    label = f"{word} {track.name}, {where}"
    return Edit(document.with_track(attrs.evolve(track, occluded=changed)), label, interval.first)


def rename_track(document: Document, track_id: str, name: str) -> Edit:
    """Give a track another name; two tracks never share one."""
    track, name = document.track(track_id), checked_name(name)
    if any(other.name == name and other.id != track_id for other in document.tracks):
        raise ModelError(f"Another track is already called {name}: choose another name.")
    return Edit(document.with_track(attrs.evolve(track, name=name)), f"Rename {track.name} to {name}")


def set_track_mode(document: Document, track_id: str, mode: TrackMode) -> Edit:
    """Choose how a track is followed: "robust" or "paper"."""
    if mode not in ("robust", "paper"):
        raise ModelError(f"A track is followed in mode robust or paper, not {mode!r}.")
    track = document.track(track_id)
    return Edit(document.with_track(attrs.evolve(track, mode=mode)), f"Track {track.name} in mode {mode}")


def set_track_masked(document: Document, track_id: str, masked: bool) -> Edit:
    """Choose whether the masks rule out places beside the subject."""
    track = document.track(track_id)
    label = f"Keep {track.name} inside the mask" if masked else f"Let {track.name} leave the mask"
    return Edit(document.with_track(attrs.evolve(track, masked=masked)), label)


def set_track_look(
    document: Document, track_id: str, *, colour: int | None = None, visible: bool | None = None
) -> Edit:
    """Choose the colour of a track, or whether it is drawn."""
    track = document.track(track_id)
    if colour is not None:
        track = attrs.evolve(track, colour=colour % COLOURS)
    if visible is not None:
        track = attrs.evolve(track, visible=visible)
    what = "Colour" if visible is None else ("Show" if visible else "Do not draw")
    return Edit(document.with_track(track), f"{what} {track.name}")


def set_mirror(document: Document, track_id: str, other_id: str | None, *, lag: int | None = None) -> Edit:
    """Say which two tracks are mirrors of each other; None separates.

    ``lag`` is by how many frames the first is later than the second: half a stride in a walk, 0 in a bound; None finds
    it from the tracks.
    """
    track = document.track(track_id)
    if lag is not None and document.clip is not None and abs(lag) >= document.clip.frame_count:
        raise ModelError(f"A lag of {lag} frames is longer than the clip of {document.clip.frame_count}.")
    if other_id == track_id:
        raise ModelError(f"{track.name} cannot be its own mirror: choose the point on the other side of the body.")
    former = {track.mirror, other_id, track_id, document.track(other_id).mirror if other_id else None}
    tracks = []
    for each in document.tracks:
        if each.id == track_id:
            tracks.append(attrs.evolve(each, mirror=other_id, mirror_lag=lag if other_id else None))
        elif each.id == other_id:
            tracks.append(attrs.evolve(each, mirror=track_id, mirror_lag=None if lag is None else -lag))
        elif each.id in former and each.mirror in (track_id, other_id):
            tracks.append(attrs.evolve(each, mirror=None, mirror_lag=None))
        else:
            tracks.append(each)
    partner = document.track(other_id).name if other_id else "nothing"
    return Edit(attrs.evolve(document, tracks=tuple(tracks)), f"Mirror {track.name} with {partner}")


def _free_name(document: Document, name: str) -> str:
    taken = {track.name for track in document.tracks}
    if name not in taken:
        return name
    number = 2
    while f"{name} {number}" in taken:
        number += 1
    return f"{name} {number}"


def _last_frame(document: Document) -> int:
    assert document.clip is not None
    return document.clip.frame_count - 1
