"""Bring results out of a project: moving meshes, and the figures of the paper's Table 1."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Literal

from app.actions.session import Session
from app.formats import write_sequence
from app.stages.results import AlignedCharacter, Animation
from imitation.errors import InputError
from imitation.progress import Progress

Form = Literal["glb", "ply", "obj", "usd", "npz"]
SUFFIXES: dict[str, Form] = {".glb": "glb", ".usd": "usd", ".usda": "usd", ".usdc": "usd", ".npz": "npz"}


def export_animation(
    session: Session, character_id: str, target: Path, *, form: Form | None = None, progress: Progress | None = None
) -> Form:
    """Write a character's motion as one file, or as a folder of PLY or OBJ files; gives the form that was chosen.

    Raises ``InputError`` when it was not animated, or the target cannot be written.
    """
    animated, aligned = animation_of(session, character_id)
    character = session.document.character(character_id)
    chosen = form or SUFFIXES.get(target.suffix.lower())
    if chosen is None:
        if target.suffix:
            raise InputError(f"{target.name} names no known form: end it in .glb, .usd or .npz, or give --format.")
        chosen = "ply"
    mesh = session.media.mesh(character.mesh)
    write_sequence(
        target,
        animated.vertices,
        aligned.faces,
        rate(session),
        form=chosen,
        colors=mesh.colors,
        name=character.name.replace("/", "-"),
        progress=progress,
    )
    return chosen


def animation_of(session: Session, character_id: str) -> tuple[Animation, AlignedCharacter]:
    """Give a character's computed motion and its rest mesh."""
    animated = session.ready(session.stages.animation(character_id))
    aligned = session.ready(session.stages.alignment(character_id))
    if not isinstance(animated, Animation) or not isinstance(aligned, AlignedCharacter):
        name = session.document.character(character_id).name
        raise InputError(f"{name} has not been animated yet: run animate first.")
    return animated, aligned


def rate(session: Session) -> Fraction:
    """Give the clip's frame rate as the fraction it most likely is."""
    clip = session.document.clip
    return Fraction(25) if clip is None else Fraction(clip.fps).limit_denominator(1001)
