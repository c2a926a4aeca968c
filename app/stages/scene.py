"""Stages of the scene: cameras, the world they stand in, and where contacts lie."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.model.document import Document
from app.model.tracks import Track
from app.model.values import Clip
from app.model.world import CameraChoice, WorldChoice
from app.stages import tracking
from app.stages.context import Context
from app.stages.once import once
from app.stages.results import Masks, PlacedContact, World
from app.stages.stage import Stage
from imitation import CameraPath
from imitation.errors import InputError


@once
def cameras(document: Document) -> Stage:
    """The camera path in its own units."""
    clip, choice = document.clip, document.camera
    if clip is None:
        return Stage("cameras", "Solving the cameras", _cameras, blocked=tracking.NO_CLIP)
    needs = (tracking.masks(document),) if choice.source == "solve" else ()
    seconds = 0.4 * clip.frame_count if choice.source == "solve" else 0.1
    return Stage("cameras", "Solving the cameras", _cameras, (clip, choice), needs, 3, weight=seconds)


@once
def world(document: Document) -> Stage:
    """The camera path with Z up and in metres, as far as they are known."""
    seen = document.world.seen
    marked = tuple(tracking.track(document, document.track(each)) for each in seen.tracks) if seen is not None else ()
    return Stage("world", "Finding the ground", _world, (document.world,), (cameras(document), *marked), 2, weight=0.2)


@once
def placed(document: Document) -> Stage:
    """The contacts of all tracks with their places, in the world: a weakly supported one is judged by the others."""
    marked = [track for track in document.tracks if track.contacts or _anchored(document, track)]
    needs: tuple[Stage, ...] = (world(document), *(tracking.track(document, track) for track in marked))
    inputs = (
        document.world,
        tuple((track.id, track.name, track.contacts, _anchored(document, track)) for track in marked),
    )
    if document.world.ground == "background" and marked:
        from app.stages.depth import depth

        needs = (depth(document), tracking.masks(document), *needs)
        return Stage("contacts", "Placing contacts", _on_background, (document.clip, *inputs), needs, 4, weight=2.0)
    return Stage("contacts", "Placing contacts", _placed, inputs, needs, version=3, weight=0.2)


@once
def contacts(document: Document, track: Track) -> Stage:
    """The contacts of a track with their places, in the world."""
    label = f"Placing contacts of {track.name}"
    needs = (placed(document),) if track.contacts or _anchored(document, track) else ()
    return Stage(f"contacts/{track.id}", label, _contacts, (track.id,), needs, weight=0.01)


def _anchored(document: Document, track: Track) -> bool:
    return document.world.ground == "depth" and track.id in document.world.depth_tracks


def _cameras(context: Context, inputs: tuple[Clip, CameraChoice], masks: Masks | None = None) -> CameraPath:
    clip, choice = inputs
    if choice.source == "file":
        from app.formats.cameras import read_cameras

        assert choice.file is not None
        path: CameraPath = read_cameras(context.media.locate(choice.file))
        if len(path) != clip.frame_count:
            raise InputError(
                f"The camera file holds {len(path)} cameras, but the clip has {clip.frame_count} frames: "
                "export one camera a frame."
            )
        return path
    if choice.source == "static":
        return _static(clip, choice.focal)
    from imitation.cameras import solve_cameras

    frames = context.media.frames(clip)
    return solve_cameras(frames, masks=masks, focal=choice.focal, progress=context.progress)


def _static(clip: Clip, focal: float | None) -> CameraPath:
    guessed = focal or 1.2 * max(clip.width, clip.height)
    K = np.array([[guessed, 0, (clip.width - 1) / 2], [0, guessed, (clip.height - 1) / 2], [0, 0, 1.0]])
    level = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    count = clip.frame_count
    reason = "The camera was said to stand still: depth and scale are unknown."
    return CameraPath(
        np.tile(K, (count, 1, 1)), np.tile(level, (count, 1, 1)), np.zeros((count, 3)), "static", reason=reason
    )


def _world(context: Context, inputs: tuple[WorldChoice], path: CameraPath, *marked: Any) -> World:
    from app.stages.worldframe import make_world

    (choice,) = inputs
    return make_world(choice, path, marked)


def _placed(context: Context, inputs: Any, world_: World, *tracks: Any) -> dict[str, list[PlacedContact]]:
    from app.stages.worldframe import agreed, depth_anchors, place_contact

    choice, marked = inputs
    found: dict[str, list[PlacedContact]] = {}
    for (track_id, name, contacts_, anchored), track in zip(marked, tracks, strict=True):
        if anchored:
            found[track_id] = depth_anchors(track, world_)
        else:
            found[track_id] = [place_contact(contact, name, track, choice, world_) for contact in contacts_]
    return agreed(found, {entry[0]: track for entry, track in zip(marked, tracks, strict=True)}, world_)


def _on_background(
    context: Context, inputs: Any, maps: Any, masks: Masks | None, world_: World, *tracks: Any
) -> dict[str, list[PlacedContact]]:
    from app.stages.depth import background, map_in_world
    from app.stages.worldframe import agreed, place_on_background

    clip, choice, marked = inputs
    known = background(context.media.frames(clip), [map_in_world(each, world_) for each in maps], world_.cameras, masks)
    total, done = max(1, sum(len(entry[2]) for entry in marked)), 0
    found: dict[str, list[PlacedContact]] = {}
    for (track_id, name, contacts_, _), track in zip(marked, tracks, strict=True):
        found[track_id] = []
        for contact in contacts_:
            context.progress(done / total)
            found[track_id].append(place_on_background(contact, name, track, choice, world_, known))
            done += 1
    return agreed(found, {entry[0]: track for entry, track in zip(marked, tracks, strict=True)}, world_)


def _contacts(context: Context, inputs: tuple[str], found: dict[str, list[PlacedContact]] | None = None) -> Any:
    return [] if found is None else found[inputs[0]]
