"""Where a character stands in the first frame: the fit to the pairs, and the user's own values on top."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from app.formats import MeshFile
from app.model.character import Alignment
from app.stages.results import AlignedCharacter, Array, PlacedContact, World
from imitation.errors import InputError, NoSolution

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
# Turns that bring the file's up axis to Z, by whole quarters, so that no digit of a coordinate changes.
AGREEING = 1.25
"""Sizes that differ by more, standing in frame 0 and on the first contact, are not those of a subject that stands."""
TO_Z = {
    "x": np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]]),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "z": np.eye(3),
}


def place_character(
    mesh: MeshFile,
    pairs: Mapping[str, int],
    choice: Alignment,
    world: World,
    tracks: Sequence[Any],
    contacts: Sequence[Sequence[PlacedContact]],
) -> AlignedCharacter:
    """Put the character on the subject of the first frame (paper A, 3.3).

    Raises ``InputError`` when a pair names a vertex that the mesh does not have, or when too few paired tracks are
    seen in the first frame.
    """
    vertices = np.asarray(mesh.vertices, np.float64)
    for name, vertex in pairs.items():
        if vertex >= len(vertices):
            raise InputError(f"A pair of {name} names vertex {vertex}, but the mesh has {len(vertices)}: pair it anew.")
    scale, rotation, translation, note = _fit(vertices, pairs, choice, world, tracks, contacts)
    centre = scale * rotation @ vertices.mean(axis=0) + translation
    scale, rotation, translation = _on_top(choice, centre, scale, rotation, translation)
    moved = scale * vertices @ rotation.T + translation
    faces = np.asarray(mesh.faces, np.int32)
    return AlignedCharacter(moved, faces, scale, rotation, translation, note)


def _fit(
    vertices: Array,
    pairs: Mapping[str, int],
    choice: Alignment,
    world: World,
    tracks: Sequence[Any],
    contacts: Sequence[Sequence[PlacedContact]],
) -> tuple[float, Array, Array, str]:
    if not choice.fitted:
        return 1.0, TO_Z[choice.up], np.zeros(3), ""
    from imitation.motion import align_character

    pixels, places = {}, {}
    for name, track, placed in zip(pairs, tracks, contacts, strict=True):
        if np.isfinite(track.positions[0]).all():
            pixels[name] = track.positions[0]
            if placed and placed[0].first == 0:
                places[name] = placed[0].place
    if len(pixels) < 3:
        raise InputError(
            f"Only {len(pixels)} paired tracks are seen in the first frame, but the character needs 3 to stand on: "
            "add clicks in frame 0 or pair more tracks."
        )
    chosen = {name: pairs[name] for name in pixels}
    up, own = world.normal if world.levelled else None, AXES[choice.up]
    ground = (world.normal, world.offset) if world.grounded else None
    fitted = align_character(
        vertices, chosen, world.camera(0), pixels, places, ground=ground, up=up, character_up=own, depth=world.depth
    )
    stood = ""
    if (
        not places
        and world.depth is None
        and (later := _first_stand(vertices, pairs, own, up, world, tracks, contacts))
    ):
        frame, scale = later
        if abs(np.log(scale / fitted.scale)) > np.log(AGREEING):
            # In the air in frame 0, or the ground there is not the plane: the picture gives the depth of a known size.
            fitted = align_character(vertices, chosen, world.camera(0), pixels, up=up, character_up=own, scale=scale)
            stood = f", as large as on the ground in frame {frame}"
    worst = max(fitted.residuals, key=lambda name: fitted.residuals[name])
    mean = float(np.mean(list(fitted.residuals.values())))
    return (
        fitted.scale,
        fitted.rotation,
        fitted.translation,
        f"{mean:.1f} px from its pairs on average, {worst} the worst{stood}",
    )


def _first_stand(
    vertices: Array,
    pairs: Mapping[str, int],
    own: tuple[float, float, float],
    up: Array | None,
    world: World,
    tracks: Sequence[Any],
    contacts: Sequence[Sequence[PlacedContact]],
) -> tuple[int, float] | None:
    """Frame of the first contact and the character's scale standing on it; None where nothing can be told."""
    from imitation.motion import align_character

    firsts = [placed[0] for placed in contacts if placed]
    if not firsts:
        return None
    frame = min(contact.first for contact in firsts)
    pixels, places = {}, {}
    for name, track, placed in zip(pairs, tracks, contacts, strict=True):
        if np.isfinite(track.positions[frame]).all():
            pixels[name] = track.positions[frame]
            if here := [contact.place for contact in placed if contact.first <= frame <= contact.last]:
                places[name] = here[0]
    if len(pixels) < 3 or not places:
        return None
    shown = {name: pairs[name] for name in pixels}
    try:
        fitted = align_character(vertices, shown, world.camera(frame), pixels, places, up=up, character_up=own)
    except NoSolution:
        return None
    return frame, fitted.scale


def _on_top(
    choice: Alignment, centre: Array, scale: float, rotation: Array, translation: Array
) -> tuple[float, Array, Array]:
    from scipy.spatial.transform import Rotation

    if choice.scale == 1.0 and not any(choice.rotation) and not any(choice.translation):
        return scale, rotation, translation
    turn = Rotation.from_euler("xyz", choice.rotation, degrees=True).as_matrix()
    moved = choice.scale * turn @ (translation - centre) + centre + np.array(choice.translation)
    return scale * choice.scale, turn @ rotation, moved
