"""Films, comparisons and motions as a person orders them: what is missing is computed, then the file is written."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import attrs

from app.actions.compositing import SheetForm, Standing
from app.actions.films import COMPARISONS, View, compare_film, render_film, render_sheets
from app.actions.results import Form, export_animation
from app.actions.session import Session
from app.formats.atomic import replacing_numbered
from app.stages.stage import Stage
from imitation.errors import Cancelled
from imitation.progress import Progress, part

WAIT = 0.05
"""Seconds between looks at a computation under way."""


@attrs.frozen
class FilmOrder:
    """What a film shall be.

    Attributes
    ----------
    characters : their ids. view : the film's camera, from the side, or both beside each other.
    standing : how the characters stand in the filmed scene.
    dim : how far the filmed frames fade towards grey, 0 to 1. points : whether tracked points are drawn.
    frames : first and last frame, None for all.
    alpha : pictures of the characters and their shadows alone, with alpha, in place of a film; ``form`` says which.
    """

    characters: tuple[str, ...]
    view: View = "video"
    standing: Standing = attrs.field(factory=Standing)
    dim: float = 0.0
    points: bool = False
    frames: tuple[int, int] | None = None
    alpha: bool = False
    form: SheetForm = "png"

    def stages(self, session: Session) -> tuple[Stage, ...]:
        """The stages whose results it needs."""
        moving = tuple(session.stages.animation(each) for each in self.characters)
        scene = self.standing.stages(session) if self.alpha or self.view != "side" else ()
        return (*scene, *moving)

    def shown(self) -> range | None:
        """The frames as a range."""
        return None if self.frames is None else range(self.frames[0], self.frames[1] + 1)


def write_film(session: Session, order: FilmOrder, target: Path, progress: Progress) -> Path:
    """Compute what a film needs and write it: whole or not at all; gives its path."""
    rest = computed(session, "Getting the film ready", order.stages(session), progress)
    if not order.alpha:
        render_film(
            session, order.characters, target, view=order.view, dim=order.dim, points=order.points,
            standing=order.standing, frames=order.shown(), progress=rest,
        )  # fmt: skip
        return target
    suffix = f".{order.form}"
    with replacing_numbered(target, "", suffix) as folder:
        render_sheets(
            session, order.characters, folder, standing=order.standing, frames=order.shown(), form=order.form,
            progress=rest,
        )  # fmt: skip
        names = {path.name for path in folder.iterdir()}
    for path in target.iterdir():
        # Frames of an earlier, longer sequence would be played after the new ones.
        if re.fullmatch(rf"\d{{5,}}{re.escape(suffix)}", path.name) and path.name not in names:
            path.unlink()
    return target


def write_comparison(
    session: Session, character_id: str, variants: Sequence[str], target: Path, progress: Progress
) -> Path:
    """Compute the paper's comparisons and write them beside our result; gives the film's path."""
    stages = session.stages
    chosen = tuple(each for each in COMPARISONS if each in variants)
    needed = (stages.animation(character_id), *(stages.comparison(character_id, each) for each in chosen))
    rest = computed(session, "Computing the comparisons", needed, progress)
    compare_film(session, character_id, target, chosen, progress=rest)
    return target


def write_motion(session: Session, character_id: str, target: Path, form: Form | None, progress: Progress) -> Path:
    """Compute a character's motion where it is missing and write it; gives its path."""
    rest = computed(session, "Solving the motion", (session.stages.animation(character_id),), progress)
    export_animation(session, character_id, target, form=form, progress=rest)
    return target


def write_background(session: Session, kind: str, target: Path, progress: Progress) -> Path:
    """Measure the background where it is missing, and write of it a film of plates, a mesh or depth maps."""
    from app.actions.backgrounds import plate_film, write_background_mesh, write_depth

    rest = computed(session, "Measuring the background", (session.stages.depth, session.stages.world), progress)
    if kind == "plate":
        plate_film(session, target, progress=rest)
    elif kind == "mesh":
        write_background_mesh(session, target)
    else:
        write_depth(session, target)
    return target


def computed(session: Session, label: str, stages: tuple[Stage, ...], progress: Progress) -> Progress:
    """Compute what is missing; gives the progress of what comes after. ``progress`` may cancel it.

    Raises whatever a stage raised.
    """
    missing = [each for each in stages if each not in session.cache]
    if not missing:
        return progress
    share = 0.7
    job = session.start(label, tuple(missing))
    try:
        while not job.wait(WAIT):
            progress(share * job.fraction)
        progress(share)
    except BaseException:
        job.cancel()
        job.wait()
        raise
    if job.error is not None:
        raise job.error
    if job.state == "cancelled":
        raise Cancelled
    return part(progress, share, 1.0)
