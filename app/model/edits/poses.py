"""Edits of poses: control vertices moved, deleted and muted in single frames."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

import attrs

from app.model.character import Character, Move, PoseEdit
from app.model.document import Document
from app.model.edits.edit import Edit, checked_frame, checked_place
from app.model.frozen import FrozenMap
from app.model.values import ModelError

Places = Mapping[int, Iterable[float]]


def move_vertices(
    document: Document,
    character_id: str,
    frame: int,
    moves: Places,
    committed: Places,
    on_rays: Collection[int] = (),
) -> Edit:
    """Put vertices somewhere in one frame and commit the frame's pose.

    ``moves`` are the vertices the user moved now; those moved in this frame before stay. ``committed`` holds the
    place of every key point and control vertex of the frame as the user saw it on release; of the vertices
    ``on_rays`` the user chose the image point only.
    """
    character, frame = document.character(character_id), checked_frame(document, frame)
    if not moves:
        raise ModelError("No vertex was moved: drag one, or name a vertex and its place.")
    placed = {int(vertex): Move(checked_place(place), on_ray=vertex in on_rays) for vertex, place in moves.items()}
    if min(placed) < 0:
        raise ModelError(f"A vertex is a number from 0 on, not {min(placed)}.")
    former = character.edits.get(frame)
    edit = PoseEdit(
        moves=(former.moves if former else FrozenMap[int, Move]()).with_items(placed),
        committed=FrozenMap({int(v): checked_place(p) for v, p in committed.items()}),
        until=former.until if former else None,
    )
    name = f"vertex {next(iter(placed))}" if len(placed) == 1 else f"{len(placed)} vertices"
    return Edit(_with(document, character, frame, edit), f"Move {name} of {character.name}, frame {frame}", frame)


def recommit(document: Document, character_id: str, frame: int, committed: Places) -> Edit:
    """Commit the frame's pose anew, after its moves were deleted or muted."""
    character, edit = _edit_of(document, character_id, frame)
    fresh = attrs.evolve(edit, committed=FrozenMap({int(v): checked_place(p) for v, p in committed.items()}))
    return Edit(_with(document, character, frame, fresh), f"Commit pose of {character.name}, frame {frame}", frame)


def delete_move(document: Document, character_id: str, frame: int, vertex: int) -> Edit:
    """Delete one vertex's move in one frame; the last one takes the edited frame with it.

    The frame's committed pose is cleared, so that it is committed anew from what remains.
    """
    character, edit = _edit_of(document, character_id, frame)
    _move_of(character, edit, frame, vertex)
    rest = edit.moves.without(vertex)
    label = f"Delete move of vertex {vertex}, frame {frame}"
    if not rest:
        return Edit(_without(document, character, frame), label, frame)
    fresh = attrs.evolve(edit, moves=rest, committed=FrozenMap())
    return Edit(_with(document, character, frame, fresh), label, frame)


def mute_move(document: Document, character_id: str, frame: int, vertex: int, muted: bool) -> Edit:
    """Mute one vertex's move in one frame, or let it count again."""
    character, edit = _edit_of(document, character_id, frame)
    move = _move_of(character, edit, frame, vertex)
    changed = attrs.evolve(
        edit, moves=edit.moves.with_item(vertex, attrs.evolve(move, muted=muted)), committed=FrozenMap()
    )
    verb = "Mute" if muted else "Unmute"
    return Edit(_with(document, character, frame, changed), f"{verb} vertex {vertex}, frame {frame}", frame)


def delete_control_vertex(document: Document, character_id: str, vertex: int) -> Edit:
    """Delete a control vertex in all frames."""
    character = document.character(character_id)
    edits: dict[int, PoseEdit] = {}
    touched = False
    for frame, edit in character.edits.items():
        if vertex not in edit.moves:
            edits[frame] = edit
            continue
        touched = True
        if rest := edit.moves.without(vertex):
            edits[frame] = attrs.evolve(edit, moves=rest, committed=FrozenMap())
    if not touched:
        raise ModelError(f"Vertex {vertex} of {character.name} is no control vertex: it was not moved in any frame.")
    smaller = attrs.evolve(character, edits=FrozenMap(edits), following=character.following.without(vertex))
    return Edit(document.with_character(smaller), f"Delete control vertex {vertex} of {character.name}")


def delete_edit(document: Document, character_id: str, frame: int) -> Edit:
    """Delete an edited frame: the result is the same as if it had never been made."""
    character, _ = _edit_of(document, character_id, frame)
    return Edit(_without(document, character, frame), f"Delete pose edit of {character.name}, frame {frame}", frame)


def set_edit_end(document: Document, character_id: str, frame: int, until: int | None) -> Edit:
    """Say up to which frame the edit reaches when no later one follows; None holds it to the end."""
    character, edit = _edit_of(document, character_id, frame)
    if until is not None and checked_frame(document, until) <= frame:
        raise ModelError(f"The edit of frame {frame} must reach a later frame, not {until}.")
    changed = attrs.evolve(edit, until=until)
    return Edit(_with(document, character, frame, changed), f"Set the reach of the edit in frame {frame}", frame)


def follow_track(document: Document, character_id: str, vertex: int, track_id: str | None) -> Edit:
    """Tell a control vertex to follow a track's motion, or not to (None)."""
    character = document.character(character_id)
    if track_id is None:
        following, label = character.following.without(vertex), f"Let vertex {vertex} of {character.name} go"
    else:
        track = document.track(track_id)
        following = character.following.with_item(vertex, track_id)
        label = f"Let vertex {vertex} of {character.name} follow {track.name}"
    return Edit(document.with_character(attrs.evolve(character, following=following)), label)


def _edit_of(document: Document, character_id: str, frame: int) -> tuple[Character, PoseEdit]:
    character = document.character(character_id)
    if frame not in character.edits:
        raise ModelError(f"{character.name} has no pose edit in frame {frame}.")
    return character, character.edits[frame]


def _move_of(character: Character, edit: PoseEdit, frame: int, vertex: int) -> Move:
    if vertex not in edit.moves:
        raise ModelError(f"Vertex {vertex} of {character.name} was not moved in frame {frame}.")
    return edit.moves[vertex]


def _with(document: Document, character: Character, frame: int, edit: PoseEdit) -> Document:
    return document.with_character(attrs.evolve(character, edits=character.edits.with_item(frame, edit)))


def _without(document: Document, character: Character, frame: int) -> Document:
    return document.with_character(attrs.evolve(character, edits=character.edits.without(frame)))
