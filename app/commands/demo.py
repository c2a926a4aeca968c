"""The demonstration: from the sample's film to a moving character, with everything left to look at."""

from __future__ import annotations

import shutil
import time
from contextlib import closing
from pathlib import Path

import click

from app.actions.films import render_film
from app.actions.results import export_animation
from app.actions.sample import fill_with_sample
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH


@click.command()
@click.argument("folder", type=PATH, default=Path("out"))
@click.option("--fresh", is_flag=True, help="Compute everything again instead of going on where the last run ended.")
@click.pass_obj
def demo(console: Console, folder: Path, fresh: bool) -> None:
    """Let the sample's filmed hound move two characters; writes a project, films and meshes into FOLDER (out)."""
    started = time.monotonic()
    place = folder / "sample.motionwright"
    if fresh:
        shutil.rmtree(place, ignore_errors=True)
    with closing(_session(place)) as session:
        characters = session.document.characters
        console.compute(session, "Solving the cameras", (session.stages.cameras,))
        stages = tuple(session.stages.animation(each.id) for each in characters)
        console.compute(session, "Animating", stages)
        made = [str(session.folder.path)]
        for each in characters:
            film = folder / f"{each.name}.mp4"
            with console.progress(f"Rendering {film.name}") as bar:
                render_film(session, [each.id], film, progress=bar)
            animation = folder / f"{each.name}.glb"
            with console.progress(f"Writing {animation.name}") as bar:
                export_animation(session, each.id, animation, progress=bar)
            made += [str(film), str(animation)]
        with console.progress("Writing meshes") as bar:
            export_animation(
                session, characters[0].id, folder / f"{characters[0].name}_frames", form="ply", progress=bar
            )
        made.append(str(folder / f"{characters[0].name}_frames"))
    seconds = time.monotonic() - started
    lines = [
        f"Done in {seconds:.0f} s. Look at:",
        *(f"  {path}" for path in made),
        "Open the project in the window with: motionwright gui " + made[0],
    ]
    console.answer({"files": made, "seconds": seconds}, lines)


def _session(place: Path) -> Session:
    if (place / "project.json").is_file():
        return Session.open(place)
    session = Session.new(place, name="Sample")
    fill_with_sample(session, copy=True)
    session.save()
    return session
