"""Verbs on the background: depth, plate."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import click
import numpy as np

from app.actions.marks import character_named
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT


@click.command()
@PROJECT
@click.option("--write", "folder", type=PATH, help="Write the maps: false-colour PNG files and depth.npz.")
@click.option("--mesh", "mesh", type=PATH, help="Write the background as a mesh: .ply, .obj or .glb.")
@click.option("--meeting", help="Say how far this character goes into the background, frame by frame.")
@click.pass_obj
def depth(console: Console, project: Path, folder: Path | None, mesh: Path | None, meeting: str | None) -> None:
    """Measure the depth of the background in a sparse set of frames."""
    from app.actions.backgrounds import solved_background, summary, write_background_mesh, write_depth

    with closing(Session.open(project)) as session:
        console.compute(session, "Measuring the background", (session.stages.depth, session.stages.world))
        known, world = solved_background(session)
        values = summary(known.maps)
        unit = " m" if world.metric else ""
        middle = f"{values['median']:.2f}{unit}"
        lines = [
            f"{len(known.maps)} key frames: {', '.join(map(str, values['key_frames']))}",
            f"{values['nearest']:.2f} to {values['farthest']:.2f}{unit} away, half of it within {middle}",
            f"{100 * values['confirmed']:.0f} % confirmed by other frames",
        ]
        if folder is not None:
            values["files"] = [str(path) for path in write_depth(session, folder)]
            lines.append(f"Wrote {len(values['files'])} files to {folder}")
        if mesh is not None:
            vertices, triangles = write_background_mesh(session, mesh)
            values["mesh"] = {"file": str(mesh), "vertices": vertices, "triangles": triangles}
            lines.append(f"Wrote {mesh}: {vertices} vertices, {triangles} triangles")
        if meeting is not None:
            character = character_named(session.document, meeting)
            (found,) = console.compute(session, "Meeting the background", (session.stages.penetration(character.id),))
            worst = int(np.argmax(found.depth))
            values["penetration"] = {"depth": found.depth, "share": found.share, "tolerance": found.tolerance}
            lines.append(
                f"{meeting} is up to {found.depth[worst]:.3f}{unit} behind the background's surface (frame {worst}), "
                f"in {int((found.depth > found.tolerance).sum())} of {len(found.depth)} frames by more than "
                f"{found.tolerance:.3f}{unit}"
            )
        console.answer(values, lines)


@click.command()
@PROJECT
@click.argument("target", type=PATH)
@click.option("--remove-shadow", is_flag=True, help="Take the shadow out too that the subject casts.")
@click.pass_obj
def plate(console: Console, project: Path, target: Path, remove_shadow: bool) -> None:
    """Film the clip without its subject, as an mp4."""
    from app.actions.backgrounds import plate_film

    with closing(Session.open(project)) as session:
        console.compute(session, "Measuring the background", (session.stages.depth, session.stages.world))
        with console.progress("Clean plates") as bar:
            mean, least = plate_film(session, target, shadows=remove_shadow, progress=bar)
        console.answer(
            {"film": str(target), "filled": mean, "filled_least": least},
            [f"Wrote {target}: behind the subject {100 * mean:.1f} % from other frames, {100 * least:.1f} % at least"],
        )
