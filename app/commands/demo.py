"""The demonstration: from the sample's film to a moving character, with everything left to look at."""

from __future__ import annotations

import shutil
import sys
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
from app.commands.together import Meter, Strand, together

SOLVE, TAKES, GRAPH, COMPOSE, PLAY, MESHES = 150.0, 10.0, 10.0, 10.0, 15.0, 2.0
FILM, PLAIN_FILM, EXPORT = 40.0, 10.0, 1.0
"""Expected seconds of work of the steps, to share out the progress."""


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
    with closing(_session(place)) as session, console.progress("Beginning") as bar:
        # The films need the document as it is now; the performance adds its takes to it meanwhile.
        filmed = session.as_it_is()
        total = SOLVE + FILM + PLAIN_FILM + 3 * EXPORT + TAKES + GRAPH + COMPOSE + PLAY + MESHES
        strands = {
            "films": lambda strand: _film(strand, filmed, folder),
            "performance": lambda strand: _perform(strand, session, folder),
        }
        films, performance = together(session, Meter(bar, total), strands)
        made = [str(session.folder.path), *films, *performance]
    seconds = time.monotonic() - started
    lines = [
        f"Done in {seconds:.0f} s. Look at:",
        *(f"  {path}" for path in made),
        f"Open the project in the window with: {_program()} gui {made[0]}",
    ]
    console.answer({"files": made, "seconds": seconds}, lines)


def _program() -> str:
    """What to type for the program: in a checkout it lies in an environment that no path leads to."""
    return "motionwright" if shutil.which("motionwright") else sys.argv[0]


def _film(strand: Strand, session: Session, folder: Path) -> list[str]:
    """Solve the film and let both characters move as the hound does; gives the files."""
    characters = session.document.characters
    standing = Standing(occlusion=True, shadow=True, plate=True, grain=None)
    stages = tuple(session.stages.animation(each.id) for each in characters)
    # All at once: points are tracked while the cameras are solved, the background is measured while it is animated.
    strand.compute("Tracking, cameras, background, motion", SOLVE, *stages, *standing.stages(session))
    made, first = [], characters[0]
    for each in characters:
        film, animation = folder / f"{each.name}.mp4", folder / f"{each.name}.glb"
        stands, weight = (standing, FILM) if each is first else (None, PLAIN_FILM)
        step = strand.step(f"Rendering {film.name}", weight)
        render_film(session, [each.id], film, standing=stands, progress=step)
        export_animation(session, each.id, animation, progress=strand.step(f"Writing {animation.name}", EXPORT))
        made += [str(film), str(animation)]
    meshes = folder / f"{first.name}_frames"
    export_animation(session, first.id, meshes, form="ply", progress=strand.step(f"Writing {meshes.name}", EXPORT))
    return [*made, str(meshes)]


def _perform(strand: Strand, session: Session, folder: Path) -> list[str]:
    """Compose a performance of the filmed walk and further takes of the hound; gives the files."""
    if not session.document.sequences:
        add_sample_performance(session, folder, progress=strand.step("Capturing further takes", TAKES))
    if not session.document.performance.keys:
        strand.compute("Analysing the takes", GRAPH, session.stages.graph)
        choose_sample_keys(session)
        session.save()
    strand.compute("Composing the performance", COMPOSE, session.stages.performance, session.stages.blends)
    film, meshes, path = folder / "performance.mp4", folder / "performance.npz", folder / "path.json"
    step = strand.step(f"Rendering {film.name}", PLAY)
    film_performance(session, film, view=70.0, size=(640, 360), marks=True, progress=step)
    export_performance(session, meshes, progress=strand.step(f"Writing {meshes.name}", MESHES))
    write_path(session, path)
    return [str(film), str(meshes), str(path)]


def _session(place: Path) -> Session:
    there = (place / "project.json").is_file()
    session = Session.open(place) if there else Session.new(place, name="Sample")
    if session.document.characters:
        return session
    try:
        # Also where an earlier run was stopped, or found the disk full, before the sample was in it.
        fill_with_sample(session, copy=True)
        session.save()
    except BaseException:
        session.close()
        raise
    return session
