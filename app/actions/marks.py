"""Marks by name: what a script or a file says of points, lassos, contacts and pairs (docs/formats.md)."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from app.actions import bringing
from app.actions.session import Session
from app.model.character import Character
from app.model.document import Document
from app.model.edits import characters, contacts, scene, tracks
from app.model.edits.edit import checked_place
from app.model.tracks import Track
from app.model.values import Point2
from app.model.world import KnownLength, SeenLength
from imitation.errors import InputError


def track_named(document: Document, name: str) -> Track:
    """Give the track of this name or id."""
    for track in document.tracks:
        if name in (track.name, track.id):
            return track
    known = ", ".join(track.name for track in document.tracks) or "none yet"
    raise InputError(f"There is no track called {name}: the tracks are {known}.")


def character_named(document: Document, name: str | None) -> Character:
    """Give the character of this name or id; without a name the only one."""
    if name is None and len(document.characters) == 1:
        return document.characters[0]
    for character in document.characters:
        if name in (character.name, character.id):
            return character
    known = ", ".join(character.name for character in document.characters) or "none yet"
    asked = "Which character?" if name is None else f"There is no character called {name}:"
    raise InputError(f"{asked} The characters are {known}." if name is None else f"{asked} the characters are {known}.")


def click_named(session: Session, name: str, frame: int, point: Iterable[float]) -> None:
    """Click a point: a new track where the name is new, a click or correction of it otherwise."""
    known = next((track for track in session.document.tracks if name in (track.name, track.id)), None)
    if known is None:
        session.apply(tracks.add_track(session.document, frame, point, name=name))
    else:
        session.apply(tracks.set_click(session.document, known.id, frame, point))


def pair_named(session: Session, character: str | None, track: str, vertex: int) -> None:
    """Pair a track with a vertex; ``InputError`` for one that the mesh does not have."""
    found = character_named(session.document, character)
    followed = track_named(session.document, track)
    try:
        count = len(session.media.mesh(found.mesh).vertices)
    except InputError:
        count = vertex + 1  # a mesh that is not there says what it has once it is: solving looks again
    if vertex >= count:
        raise InputError(
            f"{found.name} has no vertex {vertex} to pair {followed.name} with: its mesh has {count}, "
            f"numbered from 0 to {count - 1}."
        )
    session.apply(characters.set_pair(session.document, found.id, followed.id, vertex))


def apply_marks(session: Session, path: Path, *, copy: bool = False) -> None:
    """Take the marks of a JSON file into the project.

    Raises ``InputError`` when the file is damaged or its marks do not fit the project.
    """
    try:
        body = json.loads(path.read_text())
    except OSError as error:
        raise InputError(f"{path} cannot be read ({error.strerror}).") from error
    except ValueError as error:
        raise InputError(f"{path} is no JSON file ({error}).") from error
    if not isinstance(body, dict):
        raise InputError(f"{path} holds no marks: an object with lassos, tracks or characters was expected.")
    try:
        apply_values(session, body, path.parent, copy=copy)
    except (KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{path} is not as docs/formats.md says ({type(error).__name__}: {error}).") from error


def apply_values(session: Session, body: Mapping[str, Any], folder: Path, *, copy: bool = False) -> None:
    """Take marks that were read already; paths are relative to ``folder``."""
    for frame, lassos in body.get("lassos", {}).items():
        for lasso in lassos:
            points = lasso["points"] if isinstance(lasso, Mapping) else lasso
            subtract = bool(lasso.get("subtract", False)) if isinstance(lasso, Mapping) else False
            session.apply(scene.add_lasso(session.document, int(frame), points, subtract=subtract))
    for name, marks in body.get("tracks", {}).items():
        _apply_track(session, name, marks)
    for name, marks in body.get("tracks", {}).items():
        if marks.get("mirror"):
            track, other = track_named(session.document, name), track_named(session.document, marks["mirror"])
            edit = tracks.set_mirror(session.document, track.id, other.id, lag=marks.get("mirror_lag"))
            session.apply(edit)
    camera = body.get("camera", {})
    if "focal" in camera:
        session.apply(scene.set_camera(session.document, "solve", focal=camera["focal"]))
    _apply_world(session, body.get("world", {}))
    for name, marks in body.get("characters", {}).items():
        _apply_character(session, name, marks, folder, copy)


def _apply_world(session: Session, world: Mapping[str, Any]) -> None:
    if "ground" in world:
        named = world.get("depth_of", [])
        held = [track_named(session.document, name).id for name in ([named] if isinstance(named, str) else named)]
        edit = scene.set_ground(session.document, world["ground"], depth_tracks=held, depth=world.get("depth"))
        session.apply(edit)
    if "from_above" in world:
        session.apply(scene.set_from_above(session.document, bool(world["from_above"])))
    if "pitch" in world or "roll" in world:
        session.apply(scene.set_horizon(session.document, world.get("pitch"), float(world.get("roll", 0.0))))
    if "height" in world:
        session.apply(scene.set_camera_height(session.document, float(world["height"])))
    if "length" in world:
        length = world["length"]
        metres = float(length["metres"])
        if "tracks" in length:
            one, other = length["tracks"]
            length_between(session, one, other, int(length["frame"]), metres)
        elif "pixels" in length:
            (ax, ay), (bx, by) = length["pixels"]
            seen = SeenLength(int(length["frame"]), (float(ax), float(ay)), (float(bx), float(by)), metres)
            session.apply(scene.set_length(session.document, seen))
        else:
            first, second = (checked_place(length[end]) for end in ("first", "second"))
            session.apply(scene.set_length(session.document, KnownLength(first, second, metres)))


def length_between(session: Session, first: str, second: str, frame: int, metres: float) -> None:
    """Say how far two tracked points are from each other in a frame.

    Raises ``InputError`` when a track is neither clicked in that frame nor computed there.
    """
    chosen = [track_named(session.document, name) for name in (first, second)]
    ends = [_seen_at(session, track, frame) for track in chosen]
    length = SeenLength(frame, ends[0], ends[1], metres, tuple(track.id for track in chosen))
    session.apply(scene.set_length(session.document, length))


def _seen_at(session: Session, track: Track, frame: int) -> Point2:
    """Where a track is in a frame: at its click, or where it was followed to."""
    if frame in track.clicks:
        return track.clicks[frame]
    found: Any = session.result(session.stages.track(track.id))
    if not 0 <= frame < len(found.positions) or not math.isfinite(found.positions[frame].sum()):
        raise InputError(f"{track.name} is not in the picture in frame {frame}: choose a frame that shows it.")
    x, y = found.positions[frame]
    return float(x), float(y)


def _apply_track(session: Session, name: str, marks: Mapping[str, Any]) -> None:
    for frame, point in marks["clicks"].items():
        click_named(session, name, int(frame), point)
    track_id = track_named(session.document, name).id
    for first, last in marks.get("occluded", []):
        session.apply(tracks.set_occluded(session.document, track_id, first, last, True))
    for first, _last in marks.get("absent", []):
        session.apply(tracks.end_track(session.document, track_id, first))
    for contact in marks.get("contacts", []):
        first, last = contact[:2]
        place = contact[2] if len(contact) > 2 else None
        session.apply(contacts.add_contact(session.document, track_id, first, last, place=place))
    if "mode" in marks:
        session.apply(tracks.set_track_mode(session.document, track_id, marks["mode"]))


def _apply_character(session: Session, name: str, marks: Mapping[str, Any], folder: Path, copy: bool) -> None:
    known = next((each for each in session.document.characters if each.name == name), None)
    if known is None:
        if "mesh" not in marks:
            raise InputError(f"The character {name} has no mesh: name its file.")
        bringing.add_character(session, folder / marks["mesh"], name=name, up=marks.get("up"), copy=copy)
    character = character_named(session.document, name)
    for track, vertex in marks.get("pairs", {}).items():
        pair_named(session, character.id, track, int(vertex))
    if marks.get("alignment"):
        session.apply(characters.set_alignment(session.document, character.id, **marks["alignment"]))
    if marks.get("solve"):
        session.apply(characters.set_solve(session.document, character.id, **marks["solve"]))
