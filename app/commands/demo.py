"""The demonstration: from the sample's film to a moving character, with everything left to look at."""

from __future__ import annotations

import shutil
import time
from contextlib import closing
from pathlib import Path

import click

from app.actions.compositing import Standing
from app.actions.films import render_film
from app.actions.performing_export import export_performance
from app.actions.performing_films import film_performance
from app.actions.performing_path import write_path
from app.actions.performing_sample import add_sample_performance, choose_sample_keys
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
    """Let the sample's filmed hound move two characters, and join its walk with other takes into a performance.

    The first character takes the hound's place in the film: behind the railing's posts, its shadow on the stairs.

    Writes a project, films and meshes into FOLDER (out).
    """
    started = time.monotonic()
    place = folder / "sample.motionwright"
    if fresh:
        shutil.rmtree(place, ignore_errors=True)
    with closing(_session(place)) as session:
        characters = session.document.characters
        standing = Standing(occlusion=True, shadow=True, plate=True, grain=None)
        stages = tuple(session.stages.animation(each.id) for each in characters)
        # All at once: points are tracked while the cameras are solved, the background is measured while it is animated.
        console.compute(session, "Tracking, cameras, background, motion", (*stages, *standing.stages(session)))
        made, first = [str(session.folder.path)], characters[0]
        for each in characters:
            film = folder / f"{each.name}.mp4"
            with console.progress(f"Rendering {film.name}") as bar:
                render_film(session, [each.id], film, standing=standing if each is first else None, progress=bar)
            animation = folder / f"{each.name}.glb"
            with console.progress(f"Writing {animation.name}") as bar:
                export_animation(session, each.id, animation, progress=bar)
            made += [str(film), str(animation)]
        with console.progress("Writing meshes") as bar:
            export_animation(session, first.id, folder / f"{first.name}_frames", form="ply", progress=bar)
        made.append(str(folder / f"{first.name}_frames"))
        made += _perform(console, session, folder)
    seconds = time.monotonic() - started
    lines = [
        f"Done in {seconds:.0f} s. Look at:",
        *(f"  {path}" for path in made),
        "Open the project in the window with: motionwright gui " + made[0],
    ]
    console.answer({"files": made, "seconds": seconds}, lines)


def _perform(console: Console, session: Session, folder: Path) -> list[str]:
    """Compose a performance of the filmed walk and further takes of the hound; gives the files."""
    if not session.document.sequences:
        with console.progress("Capturing further takes") as bar:
            add_sample_performance(session, folder, progress=bar)
        console.compute(session, "Analysing the takes", (session.stages.graph,))
        choose_sample_keys(session)
        session.save()
    console.compute(session, "Composing the performance", (session.stages.performance, session.stages.blends))
    film, meshes, path = folder / "performance.mp4", folder / "performance.npz", folder / "path.json"
    with console.progress(f"Rendering {film.name}") as bar:
        film_performance(session, film, view=70.0, size=(640, 360), marks=True, progress=bar)
    with console.progress(f"Writing {meshes.name}") as bar:
        export_performance(session, meshes, progress=bar)
    write_path(session, path)
    return [str(film), str(meshes), str(path)]


def _session(place: Path) -> Session:
    if (place / "project.json").is_file():
        return Session.open(place)
    session = Session.new(place, name="Sample")
    fill_with_sample(session, copy=True)
    session.save()
    return session
