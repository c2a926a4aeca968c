"""The handles of a character in a frame: what is paired, anchored, moved here, moved elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from app.model.character import Character
from app.model.tracks import Track
from app.window import theme
from app.window.project import Project
from app.window.viewport import Handle

Array = NDArray[np.float64]


def control_vertices(character: Character) -> set[int]:
    """Vertices that were moved in some frame."""
    return {vertex for edit in character.edits.values() for vertex in edit.moves}


def vertex_title(project: Project, character: Character, vertex: int) -> str:
    """What a vertex is called: by its track, else by its number."""
    for track_id, paired in character.pairs.items():
        if paired == vertex:
            return project.document.track(track_id).name
    return f"vertex {vertex:,}"


def vertex_titles(project: Project, character: Character, vertices: Iterable[int]) -> dict[int, str]:
    """What some vertices are called, each looked up once."""
    names = {track.id: track.name for track in project.document.tracks}
    paired = {vertex: names.get(track_id) for track_id, vertex in character.pairs.items()}
    return {vertex: paired.get(vertex) or f"vertex {vertex:,}" for vertex in vertices}


def kind_of(character: Character, frame: int, vertex: int, track: Track | None) -> str:
    """What a vertex is in a frame, as ``Handle`` names it."""
    edit = character.edits.get(frame)
    move = edit.moves.get(vertex) if edit is not None else None
    if move is not None and not move.muted:
        return "edited ray" if move.on_ray else "edited"
    if track is None:
        return "plain"
    return "anchor" if any(frame in contact.span for contact in track.contacts) else "ray"


def handles(
    project: Project,
    character: Character,
    vertices: Array,
    before: Array | None,
    *,
    unedited: Array | None = None,
    away: Mapping[int, float] | None = None,
    limit: float = np.inf,
    metric: bool = True,
) -> list[Handle]:
    """The handles in the frame shown.

    before : (v, 3) the pose before the drag under way. unedited : (v, 3) the frame without its edit.
    away : vertex -> pixels from its point; over the limit it is marked. metric : whether the world is in metres.
    """
    frame = project.frame
    named = {track.id: track for track in project.document.tracks}
    tracks = {vertex: named[track_id] for track_id, vertex in character.pairs.items()}
    made = []
    wanted = set(tracks) | control_vertices(character) | ({project.vertex} if project.vertex >= 0 else set())
    look = theme.DARK.tracks  # marks over a picture have a dark ground in either look
    for vertex in sorted(wanted):
        if vertex >= len(vertices):
            continue
        track, selected = tracks.get(vertex), vertex == project.vertex
        kind = kind_of(character, frame, vertex, track)
        old = before[vertex] if before is not None and selected else None
        if old is None and unedited is not None and kind.startswith("edited"):
            old = unedited[vertex]
        title = track.name if track is not None else f"vertex {vertex:,}"
        if old is not None:
            moved = float(np.linalg.norm(vertices[vertex] - old))
            title += f"  {100 * moved:+.1f} cm" if metric else f"  {moved:+.2g} units"
        made.append(
            Handle(
                vertex,
                title,
                _triple(vertices[vertex]),
                kind,
                look[track.colour % len(look)] if track is not None else "accent",
                selected,
                warning=away is not None and away.get(vertex, 0.0) > limit,
                before=None if old is None else _triple(old),
            )
        )
    return made


def _triple(place: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in place)
    return x, y, z
