"""Verbs that bring results out: render, compare, export."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from app.actions.compositing import SHUTTER, Standing, without_depth
from app.actions.films import COMPARISONS, compare_film, render_film, render_sheets
from app.actions.marks import character_named
from app.actions.results import export_animation
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT
from app.formats.exr import need_exr
from imitation.errors import NoSolution

CHARACTER = click.option("--character", "name", help="Which character, where there are several.")


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@click.option("--character", "names", multiple=True, help="Only this character; may be given again.")
@click.option("--view", type=click.Choice(["video", "side", "both"]), help="Default: both; video for composites.")
@click.option("--dim", type=click.FloatRange(0, 1), default=0.0, help="Fade the filmed frames towards grey.")
@click.option("--points", is_flag=True, help="Draw the tracked points.")
@click.option("--occlusion", is_flag=True, help="Let what stands before the characters hide them.")
@click.option("--shadow", is_flag=True, help="Let their shadow fall on the measured background.")
@click.option("--plate", is_flag=True, help="Take the filmed subject out.")
@click.option("--remove-shadow", is_flag=True, help="With --plate: take the shadow out too that the subject casts.")
@click.option("--match-light", is_flag=True, help="Light them as the background is lit.")
@click.option(
    "--motion-blur", "shutter", type=click.FloatRange(0, 1), is_flag=False, flag_value=SHUTTER, default=0.0,
    help="Blur their motion as the camera sees it: share of the frame time that the shutter is open, 0.5 if not given.",
)  # fmt: skip
@click.option("--grain", is_flag=True, help="Put the film's grain over them.")
@click.option("--format", "form", type=click.Choice(["png", "exr"]), help="Of a folder's pictures: png, or exr.")
@click.option("--light-turn", type=float, default=0.0, help="Turn the main light, degrees clockwise from above.")
@click.option("--light-lift", type=float, default=0.0, help="Raise the main light, degrees.")
@click.option("--brightness", type=click.FloatRange(0, 10), default=1.0, help="Factor on their light.")
@click.option("--warmth", type=click.FloatRange(-1, 1), default=0.0, help="Tone of their light, -1 blue to 1 amber.")
@click.option("--shadow-strength", type=click.FloatRange(0, 3), default=1.0, help="Factor on their shadows' darkness.")
@click.pass_obj
def render(
    console: Console, project: Path, target: Path, names: tuple[str, ...], view: Any, dim: float, points: bool,
    grain: bool, form: Any, **scene: Any,
) -> None:  # fmt: skip
    """Film the characters over the video and from the side.

    TARGET ends in .mp4; a name without a suffix becomes a folder of PNG or EXR files with alpha,
    characters and shadows alone.
    """
    standing = Standing(grain=None if grain else 0.0, **scene)
    if standing.remove_shadow and not standing.plate:
        raise click.UsageError("--remove-shadow takes out the shadow of what --plate takes out: give both.")
    if form == "exr" and not target.suffix:
        need_exr()
    if form and target.suffix:
        raise click.UsageError("--format is of a folder's pictures: give a folder.")
    if not target.suffix and (view in ("side", "both") or dim or points or standing.plate):
        raise click.UsageError("A folder of PNG files holds the characters alone: no view, plate, fading or points.")
    with closing(Session.open(project)) as session:
        document = session.document
        chosen = [character_named(document, name) for name in names] or list(document.characters)
        stages = tuple(session.stages.animation(each.id) for each in chosen)
        try:
            if standing.needs_depth:
                console.compute(session, "Measuring the background", standing.stages(session))
        except NoSolution as reason:
            raise without_depth(reason) from None
        console.compute(session, "Animating", stages)
        ids = [each.id for each in chosen]
        with console.progress("Rendering") as bar:
            if target.suffix:
                shown = view or ("both" if standing == Standing() else "video")
                render_film(session, ids, target, view=shown, dim=dim, points=points, standing=standing, progress=bar)
            else:
                render_sheets(session, ids, target, standing=standing, form=form or "png", progress=bar)
        console.answer({"film": str(target)}, [f"Wrote {target}"])


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@CHARACTER
@click.option("--with", "variants", type=click.Choice(list(COMPARISONS)), multiple=True, help="Only these comparisons.")
@click.pass_obj
def compare(console: Console, project: Path, target: Path, name: str | None, variants: tuple[str, ...]) -> None:
    """Film our result beside the paper's comparisons, from the same project."""
    with closing(Session.open(project)) as session:
        character = character_named(session.document, name)
        chosen = variants or tuple(COMPARISONS)
        stages = tuple(session.stages.comparison(character.id, variant) for variant in chosen)
        console.compute(session, "Comparing", (session.stages.animation(character.id), *stages))
        with console.progress("Rendering") as bar:
            compare_film(session, character.id, target, chosen, progress=bar)
        console.answer({"film": str(target)}, [f"Wrote {target}"])


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@CHARACTER
@click.option("--format", "form", type=click.Choice(["glb", "ply", "obj", "usd", "npz"]), help="Default: by suffix.")
@click.pass_obj
def export(console: Console, project: Path, target: Path, name: str | None, form: Any) -> None:
    """Write a character's motion: an animated GLB, USD, npz, or a folder of PLY or OBJ files."""
    with closing(Session.open(project)) as session:
        character = character_named(session.document, name)
        console.compute(session, "Animating", (session.stages.animation(character.id),))
        with console.progress("Exporting") as bar:
            chosen = export_animation(session, character.id, target, form=form, progress=bar)
        console.answer({"file": str(target), "format": chosen}, [f"Wrote {target} ({chosen})"])
