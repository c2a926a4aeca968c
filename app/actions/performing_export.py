"""Performances out of a project: folders of meshes, one animated GLB, npz."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Literal

import numpy as np

from app.actions.performing_frames import PerformanceFrames, performance_frames
from app.actions.session import Session
from app.formats import write_sequence
from app.formats.tvm import FrameMesh, Texture, write_mesh_frames
from app.formats.tvm.glb_dress import same_texture, write_dressed_animation
from app.formats.tvm.painting import painted
from app.formats.usd import USD_SUFFIXES
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

PerformanceForm = Literal["ply", "obj", "off", "glb", "npz", "animation", "usd"]
FORMS: tuple[PerformanceForm, ...] = ("ply", "obj", "off", "glb", "npz", "animation", "usd")


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
    form : "ply", "obj", "off", "glb": a folder of meshes; "npz", "usd": one file; "animation": one animated GLB, where
        all frames have the same faces. Taken from the suffix where it is not given (.npz, .usd, .glb); else PLY.
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

    def counted() -> Iterator[FrameMesh]:
        nonlocal textured, blends
        for position, mesh in enumerate(frames):
            textured += mesh.texture is not None
            blends += frames.blended(position)
            yield mesh

    write_mesh_frames(
        target,
        counted(),
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
    if suffix in USD_SUFFIXES:
        return "usd"
    if suffix:
        raise InputError(
            f"{target.name} names no known form: end it in .glb, .usd or .npz, or give a folder and --format."
        )
    return "ply"


def _write_animation(target: Path, frames: PerformanceFrames, name: str, report: Progress) -> str:
    """Write one animated GLB; gives a sentence on what could not be kept."""
    if not frames.moving:
        raise InputError(
            "The frames have faces of their own, which one animated GLB cannot hold: write a folder (--format glb) or "
            "an .npz."
        )
    vertices = np.empty((len(frames), *frames[0].vertices.shape), np.float32)
    worn: list[Texture | None] = []
    for position in range(len(frames)):
        mesh = frames[position]
        vertices[position] = mesh.vertices
        # In-betweens have the faces of all others here, so their pictures lie on them too.
        if not frames.blended(position) and all(mesh.texture is not each for each in worn):
            worn.append(mesh.texture)
        report(0.5 * (position + 1) / len(frames))
    rate = Fraction(frames.fps).limit_denominator(100_000)
    rest = part(report, 0.5, 1.0)
    first, texture = frames[0], worn[0]
    if texture is not None and all(same_texture(texture, other) for other in worn[1:]):
        write_dressed_animation(target, vertices, first.faces, rate, texture, first.colours, name=name, progress=rest)
        return ""
    colours = painted(first).colours
    write_sequence(target, vertices, first.faces, rate, form="glb", colors=colours, name=name, progress=rest)
    if not any(each is not None for each in worn):
        return ""
    return "One animated GLB holds no pictures that change: it has the first frame's colours at its vertices."
