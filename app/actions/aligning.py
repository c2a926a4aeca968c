"""Place a character on the subject of the first frame by hand: on top of the fit to its pairs, or without one."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from app.actions.session import Session
from app.model.character import Alignment, Character
from app.model.document import Document
from app.model.edits import Edit, characters
from app.stages.placing import AXES, TO_Z
from app.stages.results import AlignedCharacter, Array, World
from imitation.errors import InputError

FARTHEST = 50.0
"""A ray that meets the ground farther away than this many camera heights meets none that a subject stands on."""


def stood(vertices: Array, centre: ArrayLike, *, shift: ArrayLike, turn: ArrayLike, scale: float) -> Array:
    """Vertices (v, 3) scaled and turned about a centre, then shifted: what a change of the alignment will show.

    turn : (3,) axis times angle, radians, world.
    """
    from imitation.geometry.rotations import rotation_of

    middle = np.asarray(centre, np.float64)
    moved: Array = scale * (vertices - middle) @ rotation_of(turn).T + middle + np.asarray(shift, np.float64)
    return moved


def changed(
    document: Document,
    character_id: str,
    *,
    shift: ArrayLike = (0, 0, 0),
    turn: ArrayLike = (0, 0, 0),
    scale: float = 1.0,
) -> Edit:
    """Move, turn (axis times angle, radians, world) and scale a character about its middle, on top of what there is."""
    from scipy.spatial.transform import Rotation

    character = document.character(character_id)
    now = character.alignment
    changes: dict[str, Any] = {}
    if np.any(shift):
        changes["translation"] = _triple(np.add(now.translation, shift))
    if np.any(turn):
        turned = Rotation.from_rotvec(np.asarray(turn, np.float64)) * Rotation.from_euler(
            "xyz", now.rotation, degrees=True
        )
        changes["rotation"] = _triple(turned.as_euler("xyz", degrees=True))
    if scale != 1.0:
        changes["scale"] = now.scale * scale
    edit = characters.set_alignment(document, character_id, **(changes or {"scale": now.scale}))
    verb = {"translation": "Move", "rotation": "Turn", "scale": "Scale"}
    words = [verb[name] for name in changes] or ["Place"]
    return Edit(edit.document, f"{words[0]} {character.name} in the first frame", 0)


def reset(document: Document, character_id: str) -> Edit:
    """Take back what was done on top of the fit; by hand, stand upright at the size of the file again."""
    character = document.character(character_id)
    plain = Alignment()
    edit = characters.set_alignment(
        document, character_id, scale=plain.scale, rotation=plain.rotation, translation=plain.translation
    )
    return Edit(edit.document, f"Reset the place of {character.name}", 0)


def by_hand(session: Session, character_id: str) -> Edit:
    """Let a character stand where it was put and not where its pairs fit; it stays where it is seen.

    One that was never placed is stood on the subject: on the ground under the mask or the points of frame 0, as high
    as they are. The cameras must have been solved.
    """
    document = session.document
    character = document.character(character_id)
    vertices = np.asarray(session.media.mesh(character.mesh).vertices, np.float64)
    upright = vertices @ TO_Z[character.alignment.up].T
    placed = session.ready(session.stages.alignment(character_id))
    if isinstance(placed, AlignedCharacter):
        scale, turn = placed.scale, placed.rotation @ TO_Z[character.alignment.up].T
        middle = placed.vertices.mean(axis=0)
    else:
        scale, turn, middle = _on_subject(session, document, character, upright)
    return _standing(document, character, scale, turn, middle - upright.mean(axis=0))


def to_pairs(document: Document, character_id: str) -> Edit:
    """Let the pairs say again where a character stands."""
    name = document.character(character_id).name
    edit = characters.set_alignment(
        document, character_id, fitted=True, scale=1.0, rotation=(0.0, 0.0, 0.0), translation=(0.0, 0.0, 0.0)
    )
    return Edit(edit.document, f"Fit {name} to its pairs", 0)


def _standing(document: Document, character: Character, scale: float, turn: Array, shift: Array) -> Edit:
    from scipy.spatial.transform import Rotation

    angles = Rotation.from_matrix(turn).as_euler("xyz", degrees=True)
    edit = characters.set_alignment(
        document,
        character.id,
        fitted=False,
        scale=float(scale),
        rotation=_triple(angles),
        translation=_triple(shift),
    )
    return Edit(edit.document, f"Place {character.name} by hand", 0)


def _on_subject(
    session: Session, document: Document, character: Character, upright: Array
) -> tuple[float, Array, Array]:
    """Scale, turn (3, 3) and place of the middle (3,) of an upright mesh that stands on what was marked in frame 0."""
    world = session.ready(session.stages.world)
    if not isinstance(world, World):
        raise InputError(f"{character.name} cannot be placed before the cameras are solved: run what is missing first.")
    camera = world.camera(0)
    left, top, right, bottom = _marked(document)
    foot = ((left + right) / 2, bottom)
    depth = _depth_of(world, foot)
    size = float(np.ptp(upright[:, 2])) or 1.0
    scale = max((bottom - top) * depth / float(camera.K[1, 1]) / size, 1e-6)
    long_axis = 0 if np.ptp(upright[:, 0]) >= np.ptp(upright[:, 1]) else 1
    across = camera.R[0] - world.normal * float(camera.R[0] @ world.normal)
    heading = math.atan2(float(across[1]), float(across[0])) - (math.pi / 2 if long_axis else 0.0)
    turn = np.array(
        [[math.cos(heading), -math.sin(heading), 0], [math.sin(heading), math.cos(heading), 0], [0, 0, 1.0]]
    )
    stands = camera.lift(np.array(foot), depth)
    above = float(upright[:, 2].mean() - upright[:, 2].min())
    return scale, turn, stands + scale * above * np.array(AXES["z"])


def _marked(document: Document) -> tuple[float, float, float, float]:
    """Left, top, right and bottom of the subject in frame 0, by mask or clicks; else of the middle of the picture."""
    mask = document.masks.get(0)
    places = [point for lasso in mask.lassos if not lasso.subtract for point in lasso.points] if mask else []
    if len(places) < 3:
        places = [track.clicks[0] for track in document.tracks if 0 in track.clicks]
    clip = document.clip
    if clip is None:
        raise InputError("There is no clip to place the character on: add a video first.")
    if len(places) < 3:
        places = [(0.25 * clip.width, 0.3 * clip.height), (0.75 * clip.width, 0.75 * clip.height)]
    (left, top), (right, bottom) = np.min(places, axis=0), np.max(places, axis=0)
    return float(left), float(top), float(right), float(max(bottom, top + 8.0))


def _depth_of(world: World, pixel: tuple[float, float]) -> float:
    """Camera z of the ground at a pixel of frame 0; that of the scene's middle where its ray meets no ground."""
    camera = world.camera(0)
    if world.depth is not None:
        return float(world.depth)
    ray = camera.rays(np.array(pixel))
    slope, height = float(ray @ world.normal), float(camera.centre @ world.normal) - world.offset
    if world.grounded and slope < 0 and 0 < height < -slope * FARTHEST * height:
        return -height / slope
    depths = camera.depth(world.cameras.points) if len(world.cameras.points) else np.zeros(0)
    ahead = depths[depths > 0]
    return float(np.median(ahead)) if len(ahead) else 5.0


def _triple(values: ArrayLike) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in np.asarray(values))
    return x, y, z


def tried(vertices: Array, now: Alignment, wanted: Alignment) -> Array:
    """Vertices (v, 3) that stand by the alignment ``now``, as they would by another one that differs in its numbers."""
    from scipy.spatial.transform import Rotation

    before, after = (Rotation.from_euler("xyz", each.rotation, degrees=True) for each in (now, wanted))
    shift = np.subtract(wanted.translation, now.translation)
    turn = (after * before.inv()).as_rotvec()
    return stood(vertices, vertices.mean(axis=0), shift=shift, turn=turn, scale=wanted.scale / now.scale)
