"""``perform compose``, ``export``, ``info``: performances."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from app.actions import performing
from app.actions.performing_export import FORMS, export_performance
from app.actions.performing_films import film_performance
from app.actions.performing_path import choice_from_path, path_values, write_path
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT
from app.model.edits import performance
from app.model.performance import KeyMotion
from imitation.errors import InputError


@click.command()
@PROJECT
@click.option(
    "--key", "keys", multiple=True, help='A key motion, in order: "walk/2" (second motion) or "walk@40" (a frame).'
)
@click.option(
    "--repeat", "repeats", nargs=2, type=int, multiple=True, help="PLACE TIMES: play a key (from 1) more often."
)
@click.option("--forbid", multiple=True, help="A motion that must not be played.")
@click.option("--allow-all", is_flag=True, help="Forbid nothing.")
@click.option("--mu", type=float, help="Size of the motion graph.")
@click.option("--length", type=int, help="Wanted number of frames; 0 takes any.")
@click.option("--seconds", type=float, help="Wanted length in seconds.")
@click.option("--loop/--no-loop", default=None, help="Lead the end back to the start.")
@click.option("--alternative", type=int, help="Take a next best path: 1, 2, ...; 0 is the best.")
@click.option("--graph", type=click.Choice(["robust", "paper"]), help="Transitions and pruning, or eq. 9 to 14.")
@click.option("--align/--no-align", default=None, help="Place every clip where the one before it ends.")
@click.option("--blend/--no-blend", default=None, help="Make in-betweens at cuts.")
@click.option("--blend-seconds", type=float, help="How long.")
@click.option("--from", "source", type=PATH, help="Take all choices from a path.json.")
@click.option("--path", "target", type=PATH, help="Write path.json.")
@click.pass_obj
def compose(console: Console, project: Path, source: Path | None, target: Path | None, **said: Any) -> None:
    """Find the best path through key motions, place its clips and blend its cuts."""
    with closing(Session.open(project)) as session:
        graph = console.compute(session, "Analysing", (session.stages.graph,))[0]
        if source is not None:
            session.apply(choice_from_path(session, source))
        _choose(session, said)
        if said["graph"] is not None:
            graph = console.compute(session, "Finding transitions", (session.stages.graph,))[0]
        _choose_motions(session, graph, said)
        _composed(console, session)
        # Only what can be composed is kept: a refusal leaves the project as it was.
        session.save()
        values = path_values(session)
        if target is not None:
            write_path(session, target)
        if console.as_json:
            console.answer(values)
            return
        console.answer({}, _path_lines(values) + ([f"Wrote {target}"] if target else []))


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@click.option("--format", "form", type=click.Choice(FORMS), help="Default: by suffix; a folder of PLY.")
@click.option("--no-blend", is_flag=True, help="Without in-betweens, to compare.")
@click.option("--view", type=float, default=60.0, show_default=True, help="Films: the camera's side, degrees.")
@click.option("--turntable", is_flag=True, help="Films: go once round.")
@click.option("--marks", is_flag=True, help="Films: name motions and cuts.")
@click.option("--size", nargs=2, type=click.IntRange(64, 4096), default=(960, 540), show_default=True)
@click.option("--path", "path", type=PATH, help="Write path.json too.")
@click.pass_obj
def export(
    console: Console,
    project: Path,
    target: Path,
    form: Any,
    no_blend: bool,
    view: float,
    turntable: bool,
    marks: bool,
    size: tuple[int, int],
    path: Path | None,
) -> None:
    """Write the performance: a folder of PLY, OBJ, OFF or GLB, npz, one animated GLB, USD, or an mp4 film."""
    with closing(Session.open(project)) as session:
        _composed(console, session)
        note, wrote = "", str(form)
        with console.progress(f"Writing {target.name}") as bar:
            if form is None and target.suffix.lower() in (".mp4", ".mov", ".mkv"):
                wrote = "film"
                film_performance(
                    session, target, view=view, turntable=turntable, marks=marks, size=size, blended=not no_blend,
                    progress=bar,
                )  # fmt: skip
            else:
                wrote, note = export_performance(session, target, form=form, blended=not no_blend, progress=bar)
        if path is not None:
            write_path(session, path)
        if note:
            console.warn(note)
        lines = [f"Wrote {target} ({wrote})", *([f"Wrote {path}"] if path is not None else [])]
        console.answer({"file": str(target), "format": wrote, "note": note}, lines)


@click.command()
@PROJECT
@click.pass_obj
def info(console: Console, project: Path) -> None:
    """Say what sequences there are, their motions as far as they are known, and what is chosen."""
    with closing(Session.open(project)) as session:
        document = session.document
        lines, values = [], []
        for sequence in document.sequences:
            structure: Any = session.ready(session.stages.structure(sequence.id))
            count = None if structure is None else len(structure.clusters)
            guessed = f", guessed: {', '.join(sequence.guessed)}" if sequence.guessed else ""
            known = "not analysed yet" if count is None else f"{count} motions"
            place = sequence.media.path if sequence.media is not None else "the motion of a character"
            lines.append(
                f"{sequence.name}: {sequence.frame_count} frames at {sequence.fps:g} a second, {known}{guessed} "
                f"({place})"
            )
            values.append(
                {
                    "name": sequence.name,
                    "frames": sequence.frame_count,
                    "fps": sequence.fps,
                    "up": sequence.up,
                    "unit": sequence.unit,
                    "guessed": list(sequence.guessed),
                    "motions": count,
                    "boundaries_by_hand": sequence.structure.boundaries,
                }
            )
        choice = document.performance
        named = {sequence.id: sequence.name for sequence in document.sequences}
        keys = [f"{named[key.motion.sequence]}@{key.motion.frame}" for key in choice.keys]
        lines.append(f"mu {choice.mu:g}, key motions: {', '.join(keys) or 'none yet'}")
        steps = {
            stage.name: session.runner.state(stage) for stage in (session.stages.performance, session.stages.blends)
        }
        lines += [f"  {state:8} {name}" for name, state in steps.items()]
        console.answer({"sequences": values, "mu": choice.mu, "keys": keys, "steps": steps}, lines)


def _choose(session: Session, said: dict[str, Any]) -> None:
    document = session.document
    if said["graph"] is not None:
        document = session.apply(performance.set_methods(document, graph=said["graph"]))
    if said["mu"] is not None:
        document = session.apply(performance.set_mu(document, said["mu"]))
    if said["length"] is not None and said["seconds"] is not None:
        raise InputError("The length is given in frames and in seconds: give one.")
    if said["length"] is not None:
        document = session.apply(performance.set_length(document, said["length"] or None))
    if said["seconds"] is not None:
        frames = round(said["seconds"] * document.sequences[0].fps)
        document = session.apply(performance.set_length(document, frames))
    if said["loop"] is not None:
        document = session.apply(performance.set_loop(document, said["loop"]))
    smoothing = {"align": said["align"], "blend": said["blend"], "seconds": said["blend_seconds"]}
    if any(value is not None for value in smoothing.values()):
        session.apply(performance.set_smoothing(document, **smoothing))


def _choose_motions(session: Session, graph: Any, said: dict[str, Any]) -> None:
    named = performing.motions(session.document, graph)
    if said["allow_all"]:
        session.apply(performance.clear_forbidden(session.document))
    for text in said["forbid"]:
        motion = performing.motion_named(session.document, named, text).motion
        session.apply(performance.set_forbidden(session.document, motion, True))
    if said["keys"]:
        keys = [KeyMotion(performing.motion_named(session.document, named, text).motion) for text in said["keys"]]
        session.apply(performance.set_keys(session.document, keys))
    for place, times in said["repeats"]:
        session.apply(performance.set_repeats(session.document, place - 1, times))
    if said["alternative"] is not None:
        session.apply(performance.set_alternative(session.document, said["alternative"]))


def _composed(console: Console, session: Session) -> None:
    """Compute the performance and its blends; a motion out of reach is named."""
    from tvmedit import Unreachable

    try:
        console.compute(session, "Composing", (session.stages.performance, session.stages.blends))
    except Unreachable as error:
        graph = session.result(session.stages.graph)
        raise performing.explained(error, performing.motions(session.document, graph)) from None
    # Alternatives that are not there would silently be the best one.
    found: Any = session.result(session.stages.paths)
    asked = session.document.performance.alternative
    if asked >= len(found):
        raise InputError(f"There are {len(found)} paths, the best among them: alternative {asked} is not there.")


def _path_lines(values: dict[str, Any]) -> list[str]:
    keys = set(values["keys"])
    stops = [stop["motion"] + ("*" if k in keys else "") for k, stop in enumerate(values["path"])]
    seconds = values["frame_count"] / values["fps"]
    lines = [f"{' -> '.join(stops)}  ({values['frame_count']} frames, {seconds:.1f} s; * key motions)"]
    if values["note"]:
        lines.append(values["note"])
    for cut in values["cuts"]:
        if cut["kind"] == "wrap":
            continue
        step = f"step {1000 * cut['step_as_filmed']:.0f} mm as filmed, {1000 * cut['step_placed']:.0f} mm placed"
        poor = ", a poor cut" if cut["poor"] else ""
        blend = f", blended over {len(cut['blended_frames'])} frames" if cut["blended_frames"] else ""
        lines.append(
            f"  frame {cut['position']:5}  {cut['from']} to {cut['to']}: {step}, {cut['score']:.2f} of the usual"
            f"{poor}{blend}"
        )
        if cut["blend_note"]:
            lines.append(f"    {cut['blend_note']}")
    wraps = [cut for cut in values["cuts"] if cut["kind"] == "wrap"]
    if wraps:
        worst = max(wraps, key=lambda cut: cut["step_placed"])
        lines.append(f"  {len(wraps)} rounds, worst wrap {1000 * worst['step_placed']:.0f} mm ({worst['from']})")
    return lines
