"""Edits of characters: meshes, pairs, alignment, how they are solved."""

from __future__ import annotations

import math
from typing import Any

import attrs

from app.model.character import Alignment, Character, UpAxis
from app.model.document import Document
from app.model.edits.edit import Edit, checked_interval, checked_name, checked_place
from app.model.values import MediaRef, ModelError


def add_character(document: Document, mesh: MediaRef, *, name: str, up: UpAxis = "y") -> Edit:
    """Add a character; one clip may drive several."""
    number = document.next_id
    chosen, count = checked_name(name), 2
    taken = {character.name for character in document.characters}
    base = chosen
    while chosen in taken:
        chosen, count = f"{base} {count}", count + 1
    character = Character(f"c{number}", chosen, mesh, alignment=Alignment(up=up))
    grown = attrs.evolve(document, characters=(*document.characters, character), next_id=number + 1)
    return Edit(grown, f"Add {chosen}")


def delete_character(document: Document, character_id: str) -> Edit:
    """Delete a character with its pairs and edits, and the sequences that are its motion."""
    from app.model.edits.sequences import delete_sequence

    character = document.character(character_id)
    for sequence in document.sequences:
        if sequence.character == character_id:
            document = delete_sequence(document, sequence.id).document
    kept = tuple(other for other in document.characters if other.id != character_id)
    return Edit(attrs.evolve(document, characters=kept), f"Delete {character.name}")


def rename_character(document: Document, character_id: str, name: str) -> Edit:
    """Give a character another name."""
    character, name = document.character(character_id), checked_name(name)
    if any(other.name == name and other.id != character_id for other in document.characters):
        raise ModelError(f"Another character is already called {name}: choose another name.")
    return Edit(document.with_character(attrs.evolve(character, name=name)), f"Rename {character.name} to {name}")


def relink_character(document: Document, character_id: str, mesh: MediaRef) -> Edit:
    """Say where the mesh lies now."""
    character = document.character(character_id)
    return Edit(document.with_character(attrs.evolve(character, mesh=mesh)), f"Find {character.name} again")


def set_pair(document: Document, character_id: str, track_id: str, vertex: int) -> Edit:
    """Pair a track with a vertex; a vertex has one track at most, a track one vertex."""
    character, track = document.character(character_id), document.track(track_id)
    if vertex < 0:
        raise ModelError(f"A vertex is a number from 0 on, not {vertex}.")
    other = next((t for t, v in character.pairs.items() if v == vertex and t != track_id), None)
    if other is not None:
        raise ModelError(
            f"Vertex {vertex} of {character.name} already follows {document.track(other).name}: choose another vertex."
        )
    paired = attrs.evolve(character, pairs=character.pairs.with_item(track_id, int(vertex)))
    return Edit(document.with_character(paired), f"Pair {track.name} with vertex {vertex} of {character.name}")


def remove_pair(document: Document, character_id: str, track_id: str) -> Edit:
    """Separate a track from its vertex."""
    character, track = document.character(character_id), document.track(track_id)
    if track_id not in character.pairs:
        raise ModelError(f"{track.name} is not paired with {character.name}.")
    smaller = attrs.evolve(character, pairs=character.pairs.without(track_id))
    return Edit(document.with_character(smaller), f"Separate {track.name} from {character.name}")


def set_alignment(document: Document, character_id: str, **changes: Any) -> Edit:
    """Change fields of the alignment: fitted, scale, rotation (degrees), translation (metres), up."""
    character = document.character(character_id)
    known = {field.name for field in attrs.fields(Alignment)} - {"unknown"}
    if not changes or not set(changes) <= known:
        raise ModelError(f"An alignment has {', '.join(sorted(known))}, not {', '.join(sorted(set(changes) - known))}.")
    if "scale" in changes and not (math.isfinite(changes["scale"]) and changes["scale"] > 0):
        raise ModelError(f"The scale of {character.name} must be a positive number, not {changes['scale']}.")
    for name in ("rotation", "translation"):
        if name in changes:
            changes[name] = checked_place(changes[name])
    alignment = attrs.evolve(character.alignment, **changes)
    what = ", ".join(sorted(changes))
    return Edit(
        document.with_character(attrs.evolve(character, alignment=alignment)), f"Align {character.name}: {what}", 0
    )


def set_solve(document: Document, character_id: str, **changes: Any) -> Edit:
    """Change how the motion is solved: method, smooth, symmetry, keep_volume, lift_feet, reach or None."""
    character = document.character(character_id)
    known = {"method", "smooth", "symmetry", "keep_volume", "lift_feet", "reach"}
    if not changes or not set(changes) <= known:
        raise ModelError(f"A solve has {', '.join(sorted(known))}, not {', '.join(sorted(set(changes) - known))}.")
    if changes.get("method", "joint") not in ("joint", "paper"):
        raise ModelError(f"The method is joint or paper, not {changes['method']!r}.")
    if changes.get("reach") is not None:
        changes["reach"] = checked_interval(document, *changes["reach"])
    solve = attrs.evolve(character.solve, **changes)
    what = ", ".join(f"{name} {value}" for name, value in sorted(changes.items()))
    return Edit(document.with_character(attrs.evolve(character, solve=solve)), f"Solve {character.name} with {what}")
