"""Verbs that bring results out: render, compare, export."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from app.actions.films import COMPARISONS, compare_film, render_film
from app.actions.marks import character_named
from app.actions.results import export_animation
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT

CHARACTER = click.option("--character", "name", help="Which character, where there are several.")


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@click.option("--character", "names", multiple=True, help="Only this character; may be given again.")
@click.option("--view", type=click.Choice(["video", "side", "both"]), default="both", show_default=True)
@click.option("--dim", type=click.FloatRange(0, 1), default=0.0, help="Fade the filmed frames towards grey.")
@click.option("--points", is_flag=True, help="Draw the tracked points.")
@click.pass_obj
def render(
    console: Console, project: Path, target: Path, names: tuple[str, ...], view: Any, dim: float, points: bool
) -> None:
    """Film the characters over the video and from the side, as an mp4."""
    with closing(Session.open(project)) as session:
        document = session.document
        chosen = [character_named(document, name) for name in names] or list(document.characters)
        console.compute(session, "Animating", tuple(session.stages.animation(each.id) for each in chosen))
        ids = [each.id for each in chosen]
        with console.progress("Rendering") as bar:
            render_film(session, ids, target, view=view, dim=dim, points=points, progress=bar)
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
