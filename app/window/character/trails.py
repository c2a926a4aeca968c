"""The ways of the points, in space as the character moves and over the film as they were followed."""

from __future__ import annotations

from collections.abc import Sequence

from app.model.character import Character
from app.window.character.motion import Motion
from app.window.character.overlays import Trail
from app.window.picture_layers import colour_of, colour_over_film
from app.window.project import Project
from app.window.reading import Reading

REACH = 12
"""Frames before and after that are shown."""


def trails(project: Project, character: Character, motion: Motion, frame: int) -> Sequence[Trail]:
    """The ways of the paired vertices round a frame, world."""
    first, last = max(frame - REACH, 0), min(frame + REACH, max(project.frame_count - 1, 0))
    tracks = {track.id: track for track in project.document.tracks}
    pairs = [(tracks[name], vertex) for name, vertex in character.pairs.items() if name in tracks]
    ways = motion.ways(first, last, [vertex for _, vertex in pairs])
    return [Trail(colour_of(track), ways[:, number], frame - first) for number, (track, _) in enumerate(pairs)]


def filmed_trails(project: Project, reading: Reading | None, frame: int) -> Sequence[Trail]:
    """The ways of the points round a frame, picture pixels."""
    if reading is None:
        return ()
    first, made = max(frame - REACH, 0), []
    for track in project.document.tracks:
        places = reading.track(track).positions[first : frame + REACH + 1]
        if track.visible and frame - first < len(places):
            made.append(Trail(colour_over_film(track), places, frame - first))
    return made
