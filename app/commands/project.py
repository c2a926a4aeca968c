"""Verbs on projects: new, set, info."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from app.actions import bringing, marks, masking
from app.actions.overview import overview
from app.actions.session import Session
from app.commands.console import Console
from app.model.edits import contacts, scene
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
    with closing(Session.new(project)) as session:
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
@click.option("--character", "meshes", type=PATH, multiple=True, help="Add a character.")
@click.option("--up", type=click.Choice(["x", "y", "z"]), help="The up axis of the added characters.")
@click.option("--marks", "marks_file", type=PATH, help="Take lassos, clicks, contacts and pairs from a file.")
@click.option("--masks", "mask_folder", type=PATH, help="Take masks from a folder of pictures, one a frame.")
@click.option("--masks-every", type=int, default=1, help="Use only each so manieth of them.")
@click.option("--focal", type=float, help="Focal length, pixels.")
@click.option("--static", is_flag=True, help="The camera stands still.")
@click.option("--camera-file", type=PATH, help="Read cameras: a COLMAP model folder or transforms.json.")
@click.option("--ground", type=click.Choice(["local", "plane", "depth"]), help="Where contacts lie.")
@click.option("--from-above", is_flag=True, help="The camera looks down on the subject.")
@click.option("--depth-of", help="Track kept at constant depth, with --ground depth.")
@click.option("--depth", type=float, help="That depth, metres.")
@click.option(
    "--click", "clicks", nargs=4, type=(str, int, float, float), multiple=True, help="NAME FRAME X Y: click a point."
)
@click.option(
    "--contact", "marked", nargs=3, type=(str, int, int), multiple=True, help="NAME FIRST LAST: mark a contact."
)
@click.option("--pair", "pairs", nargs=3, type=(str, str, int), multiple=True, help="CHARACTER NAME VERTEX: pair.")
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
        if options["ground"] is not None:
            depth_of = marks.track_named(session.document, options["depth_of"]).id if options["depth_of"] else None
            session.apply(
                scene.set_ground(session.document, options["ground"], depth_track=depth_of, depth=options["depth"])
            )
        if options["from_above"]:
            session.apply(scene.set_from_above(session.document, True))
        for name, frame, x, y in options["clicks"]:
            marks.click_named(session, name, frame, (x, y))
        for name, first, last in options["marked"]:
            session.apply(
                contacts.add_contact(session.document, marks.track_named(session.document, name).id, first, last)
            )
        for character, name, vertex in options["pairs"]:
            marks.pair_named(session, character, name, vertex)
        if options["name"]:
            session.apply(scene.rename(session.document, options["name"]))
        session.save()
        done = [version.label for version in session.history.versions[before + 1 : session.history.present + 1]]
        console.answer({"done": done}, done or ["Nothing was changed."])


def _set_media(session: Session, options: dict[str, Any]) -> None:
    copy = options["copy"]
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
