"""Verbs on projects: new, set, info."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from app.actions import bringing, lost_media, marks, masking
from app.actions.beginning import begun
from app.actions.overview import overview
from app.actions.session import Session
from app.commands.console import Console
from app.commands.world_options import set_lengths, set_world, world_options
from app.model.edits import characters, contacts, scene, tracks
from imitation.errors import InputError

PATH = click.Path(path_type=Path)
PROJECT = click.argument("project", type=PATH)


@click.command()
@PROJECT
@click.option("--clip", type=PATH, help="The filmed video, or a folder of pictures.")
@click.option("--character", "meshes", type=PATH, multiple=True, help="A mesh that shall move; may be given again.")
@click.option("--up", type=click.Choice(["x", "y", "z"]), help="The up axis of the meshes.")
@click.option("--marks", "marks_file", type=PATH, help="Lassos, clicks, contacts and pairs (docs/formats.md).")
@click.option("--copy", is_flag=True, help="Copy media into the project instead of linking them.")
@click.pass_obj
def new(
    console: Console,
    project: Path,
    clip: Path | None,
    meshes: tuple[Path, ...],
    up: Any,
    marks_file: Path | None,
    copy: bool,
) -> None:
    """Begin a project."""
    if clip is not None and not clip.exists():
        raise InputError(f"{clip} does not exist: check the path.")
    with begun(project) as session:
        if clip is not None:
            bringing.add_clip(session, clip, copy=copy)
        for mesh in meshes:
            bringing.add_character(session, mesh, up=up, copy=copy)
        if marks_file is not None:
            marks.apply_marks(session, marks_file, copy=copy)
        session.save()
        console.answer({"project": session.folder.path}, [f"Made {session.folder.path}"])


@click.command("set")
@PROJECT
@click.option("--clip", type=PATH, help="The filmed video, or a folder of pictures.")
@click.option("--fps", type=float, help="Frame rate of a folder of pictures.")
@click.option("--find", "places", type=PATH, multiple=True, help="Look here for files that are missing.")
@click.option("--character", "meshes", type=PATH, multiple=True, help="Add a character.")
@click.option("--up", type=click.Choice(["x", "y", "z"]), help="The up axis of the added characters.")
@click.option("--marks", "marks_file", type=PATH, help="Take lassos, clicks, contacts and pairs from a file.")
@click.option("--masks", "mask_folder", type=PATH, help="Take masks from a folder of pictures, one a frame.")
@click.option("--masks-every", type=int, default=1, help="Use only each so manieth of them.")
@click.option("--focal", type=float, help="Focal length, pixels.")
@click.option("--static", is_flag=True, help="The camera stands still.")
@click.option("--camera-file", type=PATH, help="Read cameras: a COLMAP model folder or transforms.json.")
@world_options
@click.option(
    "--click", "clicks", nargs=4, type=(str, int, float, float), multiple=True, help="NAME FRAME X Y: click a point."
)
@click.option(
    "--contact", "marked", nargs=3, type=(str, int, int), multiple=True, help="NAME FIRST LAST: mark a contact."
)
@click.option("--pair", "pairs", nargs=3, type=(str, str, int), multiple=True, help="CHARACTER NAME VERTEX: pair.")
@click.option(
    "--mirror",
    "mirrors",
    nargs=3,
    type=(str, str, str),
    multiple=True,
    help="NAME OTHER LAG: two points on both sides of the body; where one is hidden it moves as the other does, LAG "
    "frames later (half a stride), or 'auto' to find that from the tracks.",
)
@click.option(
    "--lift-feet",
    "lifts",
    nargs=2,
    type=(str, click.Choice(["on", "off"])),
    multiple=True,
    help="CHARACTER on|off: lift its feet onto the ground where the motion puts them below.",
)
@click.option("--name", help="Name of the project.")
@click.option("--copy", is_flag=True, help="Copy media into the project instead of linking them.")
@click.pass_obj
def set_(console: Console, project: Path, **options: Any) -> None:
    """Change a project: media, clicks, contacts, pairs, cameras, ground."""
    with closing(Session.open(project)) as session:
        before = session.history.present
        _set_media(session, options)
        if options["static"] or options["focal"] is not None:
            source = "static" if options["static"] else "solve"
            session.apply(scene.set_camera(session.document, source, focal=options["focal"]))
        set_world(session, options)
        for name, frame, x, y in options["clicks"]:
            marks.click_named(session, name, frame, (x, y))
        for name, first, last in options["marked"]:
            session.apply(
                contacts.add_contact(session.document, marks.track_named(session.document, name).id, first, last)
            )
        for character, name, vertex in options["pairs"]:
            marks.pair_named(session, character, name, vertex)
        for name, other, lag in options["mirrors"]:
            _mirror(session, name, other, lag)
        for character, wanted in options["lifts"]:
            one = marks.character_named(session.document, character)
            session.apply(characters.set_solve(session.document, one.id, lift_feet=wanted == "on"))
        set_lengths(session, options)
        if options["name"]:
            session.apply(scene.rename(session.document, options["name"]))
        session.save()
        done = [version.label for version in session.history.versions[before + 1 : session.history.present + 1]]
        console.answer({"done": done}, done or ["Nothing was changed."])


def _mirror(session: Session, name: str, other: str, lag: str) -> None:
    """Make two tracks mirrors of each other, and let the characters that they move use it."""
    document = session.document
    first, second = marks.track_named(document, name), marks.track_named(document, other)
    if lag != "auto" and not lag.lstrip("+-").isdigit():
        raise InputError(f"The lag between {name} and {other} is a number of frames or auto, not {lag}.")
    session.apply(tracks.set_mirror(document, first.id, second.id, lag=None if lag == "auto" else int(lag)))
    for character in session.document.characters:
        if {first.id, second.id} <= set(character.pairs) and not character.solve.symmetry:
            session.apply(characters.set_solve(session.document, character.id, symmetry=True))


def _set_media(session: Session, options: dict[str, Any]) -> None:
    copy = options["copy"]
    for place in options["places"]:
        lost_media.find_in(session, place)
    if options["clip"] is not None:
        bringing.add_clip(session, options["clip"], copy=copy, fps=options["fps"])
    for mesh in options["meshes"]:
        bringing.add_character(session, mesh, up=options["up"], copy=copy)
    if options["marks_file"] is not None:
        marks.apply_marks(session, options["marks_file"], copy=copy)
    if options["mask_folder"] is not None:
        masking.import_masks(session, options["mask_folder"], every=options["masks_every"])
    if options["camera_file"] is not None:
        bringing.use_camera_file(session, options["camera_file"], copy=copy)


@click.command()
@PROJECT
@click.pass_obj
def info(console: Console, project: Path) -> None:
    """Say what is in a project and how far it is."""
    with closing(Session.open(project)) as session:
        values, lines = overview(session)
        console.answer(values, lines)
