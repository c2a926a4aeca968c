"""Take a pose edit from one frame to another: what was moved goes along with the body."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from app.actions.posing import PoseDrag, release
from app.actions.session import Session
from app.model.edits import Edit
from app.stages.results import Array
from imitation.errors import InputError

Offset = tuple[float, float, float]


@attrs.frozen
class PoseCopy:
    """What was moved in a frame.

    Attributes
    ----------
    character_id, frame : where it was taken.
    offsets : vertex -> how far it was moved from the solution before any edit, world.
    on_rays : vertices of which only the image point was chosen.
    """

    character_id: str
    frame: int
    offsets: dict[int, Offset]
    on_rays: frozenset[int] = frozenset()


def copy_pose(session: Session, character_id: str, frame: int) -> PoseCopy:
    """Take the moves of an edited frame that count.

    Raises ``InputError`` where the frame has none, or the character was not animated.
    """
    character = session.document.character(character_id)
    edit = character.edits.get(frame)
    moves = {vertex: move for vertex, move in edit.moves.items() if not move.muted} if edit else {}
    if not moves:
        raise InputError(f"{character.name} has no pose edit in frame {frame}: go to an edited frame, then copy it.")
    unedited = _unedited(session, character_id, frame)
    offsets: dict[int, Offset] = {}
    for vertex, move in moves.items():
        x, y, z = (float(value) for value in np.subtract(move.place, unedited[vertex]))
        offsets[vertex] = (x, y, z)
    return PoseCopy(character_id, frame, offsets, frozenset(v for v, move in moves.items() if move.on_ray))


def paste_pose(session: Session, frame: int, copy: PoseCopy) -> Edit:
    """Move the same vertices in another frame by as much, turned as the body has turned; one edit, not yet applied.

    It solves one frame, so it may run in a thread of its own while the document stays as it is.
    """
    name = session.document.character(copy.character_id).name
    turn = _turned(_unedited(session, copy.character_id, copy.frame), _unedited(session, copy.character_id, frame))
    unedited = _unedited(session, copy.character_id, frame)
    drag = PoseDrag(session, copy.character_id, frame, before=unedited)
    places = {vertex: unedited[vertex] + turn @ np.array(offset) for vertex, offset in copy.offsets.items()}
    drag.move(places, copy.on_rays)
    edit = release(session, drag, places)
    return Edit(edit.document, f"Paste pose of frame {copy.frame} of {name}, frame {frame}", frame)


def _turned(before: Array, after: Array) -> Array:
    """The rotation (3, 3) that carries one pose (v, 3) best into another."""
    from imitation.geometry.rotations import kabsch

    rotation: Array = kabsch(before, after)[0]
    return rotation


def _unedited(session: Session, character_id: str, frame: int) -> Array:
    """A frame (v, 3) as it is without its edit."""
    stages = session.stages
    if frame:
        solved: Any = session.ready(stages.base(character_id))
        if solved is not None:
            vertices: Array = solved.vertices[frame]
            return vertices
    else:
        placed: Any = session.ready(stages.alignment(character_id))
        if placed is not None:
            return np.asarray(placed.vertices)
    name = session.document.character(character_id).name
    raise InputError(f"{name} has not been animated yet: animate it, then copy its poses.")
