"""Performances out of a project: folders of meshes, one animated GLB, npz."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Literal

import numpy as np

from app.actions.performing_frames import PerformanceFrames, performance_frames
from app.actions.session import Session
from app.formats import write_sequence
from app.formats.tvm import write_mesh_frames
from app.formats.tvm.painting import painted
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

PerformanceForm = Literal["ply", "obj", "off", "glb", "npz", "animation"]
FORMS: tuple[PerformanceForm, ...] = ("ply", "obj", "off", "glb", "npz", "animation")


def export_performance(
    session: Session,
    target: Path,
    *,
    form: PerformanceForm | None = None,
    blended: bool = True,
    progress: Progress | None = None,
) -> tuple[PerformanceForm, str]:
    """Write the composed performance; gives the form, and a sentence on what could not be kept (empty if nothing).

    Parameters
    ----------
    form : "ply", "obj", "off", "glb": a folder of meshes; "npz": one file; "animation": one animated GLB, where all
        frames have the same faces. Taken from the suffix where it is not given: .npz, .glb; else PLY.
    blended : with in-betweens at the cuts.

    Raises ``InputError`` when it has not been composed, or cannot be written so.
    """
    frames = performance_frames(session, blended=blended)
    chosen = form or _form(target)
    name = session.document.name.replace("/", "-")
    report = progress or silent
    if chosen == "animation":
        return chosen, _write_animation(target, frames, name, report)
    textured = blends = 0

    def counted() -> object:
        nonlocal textured, blends
        for position, mesh in enumerate(frames):
            textured += mesh.texture is not None
            blends += frames.blended(position)
            yield mesh

    write_mesh_frames(
        target,
        counted(),  # type: ignore[arg-type]
        form=chosen,
        fps=Fraction(frames.fps).limit_denominator(100_000),
        count=len(frames),
        name=name,
        progress=report,
    )
    if not textured:
        return chosen, ""
    if chosen in ("obj", "ply", "glb"):
        note = f"{blends} blended frames have colours at their vertices instead of pictures." if blends else ""
        return chosen, note
    return chosen, f"{chosen.upper()} holds no pictures here: {textured} frames have their colours at the vertices."


def _form(target: Path) -> PerformanceForm:
    suffix = target.suffix.lower()
    if suffix == ".npz":
        return "npz"
    if suffix in (".glb", ".gltf"):
        return "animation"
    if suffix:
        raise InputError(f"{target.name} names no known form: end it in .glb or .npz, or give a folder and --format.")
    return "ply"


def _write_animation(target: Path, frames: PerformanceFrames, name: str, report: Progress) -> str:
    """Write one animated GLB; gives a sentence on what could not be kept."""
    if not frames.moving:
        raise InputError(
            "The frames have faces of their own, which one animated GLB cannot hold: write a folder (--format glb) or "
            "an .npz."
        )
    textured = frames[0].texture is not None
    first = painted(frames[0])
    vertices = np.empty((len(frames), *first.vertices.shape), np.float32)
    for position in range(len(frames)):
        vertices[position] = frames[position].vertices
        report(0.5 * (position + 1) / len(frames))
    rate = Fraction(frames.fps).limit_denominator(100_000)
    colours = first.colours
    write_sequence(
        target, vertices, first.faces, rate, form="glb", colors=colours, name=name, progress=part(report, 0.5, 1.0)
    )
    return "One animated GLB holds no pictures here: it has their colours at the vertices." if textured else ""
