"""Moving characters, and the ground that they stand on, as pictures need them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from app.actions.results import animation_of
from app.actions.session import Session
from app.stages.results import Array, World
from imitation.errors import InputError

Placed = dict[str, list[tuple[int, int, Array]]]


class Moving:
    """A character with what drawing needs: ``vertices`` (n, v, 3) in the world, ``faces``, ``colors`` or None."""

    def __init__(self, vertices: Array, faces: Any, colors: Any) -> None:
        self.vertices, self.faces, self.colors = vertices, faces, colors

    @classmethod
    def of(cls, session: Session, character_id: str) -> Moving:
        """Take an animated character of the project."""
        animated, aligned = animation_of(session, character_id)
        mesh = session.media.mesh(session.document.character(character_id).mesh)
        return cls(animated.vertices, aligned.faces, mesh.colors)

    def with_vertices(self, vertices: Array) -> Moving:
        """Give the same character in another motion."""
        return Moving(vertices, self.faces, self.colors)


def animated(session: Session, character_ids: Sequence[str]) -> list[Moving]:
    """Take animated characters of the project; there must be one."""
    motions = [Moving.of(session, character_id) for character_id in character_ids]
    if not motions:
        raise InputError("There is no character to film: add one and animate it.")
    return motions


def solved_world(session: Session) -> World:
    """Give the world; its stage must have run."""
    world = session.ready(session.stages.world)
    if not isinstance(world, World):
        raise InputError("The cameras have not been solved yet: run animate first.")
    return world


def placed_contacts(session: Session) -> Placed:
    """Give the placed contacts by track; what was not kept from an earlier opening is placed again, quickly."""
    marked = [track for track in session.document.tracks if track.contacts]
    found = {track.id: session.result(session.stages.contacts(track.id)) for track in marked}
    return {
        name: [(contact.first, contact.last, contact.place) for contact in placed]
        for name, placed in found.items()
        if isinstance(placed, list) and placed
    }


def floor(world: World, contacts: Placed, frame: int) -> Any:
    """Give what takes the shadow in a frame: the steps under the feet, else the ground plane, else nothing."""
    from imitation.rendering import Plane, footing_at

    if world.depth is not None:
        return None
    footing = footing_at(contacts, frame, world.normal)
    if footing is not None:
        return footing
    return Plane(world.normal * world.offset, world.normal) if world.grounded else None
