"""``perform add``, ``analyse``, ``evaluate``: sequences and their motions."""

from __future__ import annotations

import itertools
from contextlib import AbstractContextManager, closing
from pathlib import Path
from typing import Any

import click

from app.actions import performing, performing_report
from app.actions.beginning import begun
from app.actions.marks import character_named
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT
from app.model.edits import performance, sequences
from app.storage.folder import ProjectFolder
from imitation.errors import InputError

SEQUENCE = click.option("--sequence", "name", help="Which sequence, where there are several.")


@click.command()
@PROJECT
@click.argument("files", nargs=-1, type=PATH)
@click.option("--character", "characters", multiple=True, help="Add this character's motion (of a project in FILES).")
@click.option(
    "--animation", "animations", multiple=True, help="Add this animation of a GLB with several: name or number."
)
@click.option("--name", help="Name of the sequence; by default that of the file.")
@click.option("--fps", type=float, help="Frame rate of the files.")
@click.option("--up", type=click.Choice(["y", "z"]), help="Up axis of the files.")
@click.option("--unit", type=float, help="Metres in one unit of the files: 1, 0.01, 0.001.")
@click.option("--rate", type=float, help="Frame rate at which it is played: at each time the nearest frame.")
@click.option("--front", type=float, help="Where the performer faces in frame 0: degrees from +x towards +y.")
@click.option("--level", is_flag=True, help="Take out what the performer climbs.")
@click.option("--copy", is_flag=True, help="Copy the files into the project instead of linking them.")
@click.pass_obj
def add(
    console: Console,
    project: Path,
    files: tuple[Path, ...],
    characters: tuple[str, ...],
    animations: tuple[str, ...],
    **said: Any,
) -> None:
    """Add sequences to a project: folders of PLY, OBJ, OFF or GLB, npz, animated GLB, finished motions of projects.

    Makes the project if need be.
    """
    if not files and not characters:
        raise InputError("There is nothing to add: name folders or files, or a character.")
    wanted, characters = _wanted(files, characters)
    chosen_animations = animations or (None,)
    if animations and len(files) != 1:
        raise InputError("It is not clear which file has the animation: name one file beside it.")
    if said["name"] and len(wanted) * len(chosen_animations) + len(characters) > 1:
        raise InputError("One name cannot serve several sequences: add them one by one.")
    with _opened_or_begun(project) as session:
        added = []
        for (file, whose), animation in itertools.product(wanted, chosen_animations):
            facts = {key: said[key] for key in ("fps", "up", "unit")} | {"character": whose, "animation": animation}
            made, note = performing.add_sequence(session, file, name=said["name"], copy=said["copy"], **facts)
            added.append((made, note))
        for character in characters:
            chosen = character_named(session.document, character)
            added.append(performing.add_character_motion(session, chosen.id, name=said["name"]))
        for made, _ in added:
            if said["rate"] is not None:
                session.apply(sequences.set_facts(session.document, made, fps=said["rate"]))
            if said["front"] is not None:
                session.apply(sequences.set_front(session.document, made, said["front"]))
            if said["level"]:
                session.apply(sequences.set_level(session.document, made, True))
        session.save()
        values, lines = [], []
        for made, note in added:
            sequence = session.document.sequence(made)
            values.append(
                {
                    "name": sequence.name,
                    "frames": sequence.frame_count,
                    "fps": sequence.fps,
                    "up": sequence.up,
                    "unit": sequence.unit,
                    "guessed": list(sequence.guessed),
                    "note": note,
                }
            )
            lines.append(f"Added {sequence.name}: {sequence.frame_count} frames at {sequence.fps:g} a second")
            if note:
                console.warn(note)
        console.answer({"project": str(session.folder.path), "added": values}, lines)


def _wanted(
    files: tuple[Path, ...], characters: tuple[str, ...]
) -> tuple[list[tuple[Path, str | None]], tuple[str, ...]]:
    """What is added of files, with whose motion where they are projects, and the characters of the project itself."""
    projects = [file for file in files if performing.is_project(file)]
    if projects and characters and len(files) > 1:
        raise InputError("It is not clear whose character is meant: add the motions of one project at a time.")
    wanted: list[tuple[Path, str | None]] = []
    for file in files:
        whose = (characters or performing.characters_of(file)) if file in projects else (None,)
        wanted += [(file, each) for each in whose]
    return wanted, () if projects else characters


@click.command()
@PROJECT
@SEQUENCE
@click.option("--method", type=click.Choice(["optimal", "paper"]), help="Cut the whole at once, or as printed.")
@click.option("--beta", type=float, help="Threshold of eq. 8, with --method paper.")
@click.option("--longest-period", type=float, help="Seconds a repeat may take.")
@click.option("--sensitivity", type=float, help="1 as measured; less gives fewer motions.")
@click.option("--force-cyclic/--no-force-cyclic", default=None, help="Every long stretch counts as repeating.")
@click.option("--boundaries", help='First frames of the motions, as "40,95", or "found" to find them again.')
@click.option("--features", type=click.Choice(["robust", "paper"]), help="Features of all sequences.")
@click.option("--report", "folder", type=PATH, help="Write distance curve and self-similarity as PNG into this folder.")
@click.pass_obj
def analyse(console: Console, project: Path, name: str | None, folder: Path | None, **said: Any) -> None:
    """Cut sequences into motions, and say why there."""
    with closing(Session.open(project)) as session:
        every = session.document.sequences if name is None else ()
        chosen = [each.id for each in every] or [performing.sequence_named(session.document, name).id]
        for each in chosen:
            _apply_structure(session, each, said)
        if said["features"] is not None:
            session.apply(performance.set_methods(session.document, features=said["features"]))
        if session.history.modified:
            session.save()
        found = console.compute(session, "Analysing", tuple(session.stages.structure(each) for each in chosen))
        values, lines, files = {}, [], []
        for each, structure in zip(chosen, found, strict=True):
            sequence = session.document.sequence(each)
            counted: Any = session.result(session.stages.features(each))
            statistics = counted.statistics
            values[sequence.name] = performing_report.structure_values(structure) | {
                "frames": statistics.frames,
                "vertices": list(statistics.vertices),
                "faces": list(statistics.faces),
                "height": statistics.height,
                "coloured": statistics.coloured,
                "textured": statistics.textured,
            }
            least, median, most = statistics.vertices
            lines.append(
                f"{sequence.name}: {statistics.frames} frames, {statistics.seconds:.1f} s, {least} to {most} vertices "
                f"(median {median}), body height {statistics.height:.2f} m"
            )
            for number, cluster in enumerate(structure.clusters, start=1):
                kind = f"repeats every {cluster.period:.0f} frames" if cluster.cyclic else "played once"
                lines.append(f"  {sequence.name}/{number:<3} {cluster.first:5} to {cluster.last:5}  {kind}")
            lines.append(f"  {structure.reason}")
            if folder is not None:
                files += performing_report.write_report(session, each, folder)
        lines += [f"Wrote {file}" for file in files]
        console.answer({"sequences": values, "files": [str(file) for file in files]}, lines)


@click.command()
@PROJECT
@SEQUENCE
@click.option("--labels", type=PATH, required=True, help="JSON: first frames of the motions, one list or by name.")
@click.option("--tolerance", type=float, default=5, show_default=True, help="Frames.")
@click.pass_obj
def evaluate(console: Console, project: Path, name: str | None, labels: Path, tolerance: float) -> None:
    """Compare found boundaries with labels: precision and recall (Fig. 5), beside the printed method."""
    with closing(Session.open(project)) as session:
        read = performing_report.read_labels(labels)
        if "" in read:
            read = {performing.sequence_named(session.document, name).name: read[""]}
        elif name is not None:
            chosen = performing.sequence_named(session.document, name).name
            if chosen not in read:
                raise InputError(f"{labels.name} has no labels for {chosen}: it has {', '.join(read) or 'none'}.")
            read = {chosen: read[chosen]}
        values, lines = {}, []
        for label, frames in read.items():
            sequence = performing.sequence_named(session.document, label)
            result = performing_report.evaluate(session, sequence.id, frames, tolerance=tolerance)
            values[sequence.name] = result
            printed = result["printed"]
            lines.append(
                f"{sequence.name}: precision {result['precision']:.2f}, recall {result['recall']:.2f} within "
                f"{tolerance:g} frames (printed method: {printed['precision']:.2f}, {printed['recall']:.2f})"
            )
            lines.append(f"  labelled {_frames(result['labels'])}; found {_frames(result['boundaries'])}")
        console.answer(values, lines)


def _opened_or_begun(project: Path) -> AbstractContextManager[Session]:
    try:
        ProjectFolder.find(project)
    except InputError:
        return begun(project)
    return closing(Session.open(project))


def _apply_structure(session: Session, sequence_id: str, said: dict[str, Any]) -> None:
    known = ("method", "beta", "longest_period", "sensitivity", "force_cyclic")
    changes = {key: said[key] for key in known if said[key] is not None}
    if changes:
        session.apply(sequences.set_structure(session.document, sequence_id, **changes))
    given = said["boundaries"]
    if given is None:
        return
    if given == "found":
        session.apply(sequences.set_boundaries(session.document, sequence_id, None))
        return
    try:
        frames = tuple(int(word) for word in given.replace(",", " ").split())
    except ValueError:
        raise InputError(f'The boundaries {given!r} are no frames: write them as "40,95".') from None
    session.apply(sequences.set_boundaries(session.document, sequence_id, frames))


def _frames(frames: list[int]) -> str:
    return ", ".join(map(str, frames)) or "none"
