"""The handles of a character in a frame: what is paired, anchored, moved here, moved elsewhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.model.character import Character
from app.window import theme
from app.window.project import Project
from app.window.viewport import Handle


def control_vertices(character: Character) -> set[int]:
    """Vertices that were moved in some frame."""
    return {vertex for edit in character.edits.values() for vertex in edit.moves}


def vertex_title(project: Project, character: Character, vertex: int) -> str:
    """What a vertex is called: by its track, else by its number."""
    for track_id, paired in character.pairs.items():
        if paired == vertex:
            return project.document.track(track_id).name
    return f"vertex {vertex:,}"


def handles(
    project: Project, character: Character, vertices: NDArray[np.float64], before: NDArray[np.float64] | None
) -> list[Handle]:
    """The handles in the frame shown; ``before`` is the pose before the drag under way."""
    frame = project.frame
    edit = character.edits.get(frame)
    moved = {vertex for vertex, move in edit.moves.items() if not move.muted} if edit else set()
    tracks = {vertex: project.document.track(track_id) for track_id, vertex in character.pairs.items()}
    made = []
    wanted = set(tracks) | control_vertices(character) | ({project.vertex} if project.vertex >= 0 else set())
    look = theme.active().tracks
    for vertex in sorted(wanted):
        if vertex >= len(vertices):
            continue
        track = tracks.get(vertex)
        planted = track is not None and any(frame in contact.span for contact in track.contacts)
        kind = "edited" if vertex in moved else "anchor" if planted else "ray" if track is not None else "plain"
        x, y, z = (float(value) for value in vertices[vertex])
        selected = vertex == project.vertex
        old = before[vertex] if before is not None and selected else None
        title = vertex_title(project, character, vertex)
        if old is not None:
            title += f"  {100 * float(np.linalg.norm(vertices[vertex] - old)):+.1f} cm"
        made.append(
            Handle(
                vertex,
                title,
                (x, y, z),
                kind,
                look[track.colour % len(look)] if track is not None else "accent",
                selected,
                before=None if old is None else (float(old[0]), float(old[1]), float(old[2])),
            )
        )
    return made
