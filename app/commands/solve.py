"""Verbs that compute: cameras, track, animate."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click
import numpy as np

from app.actions.limbs import ambiguous_limbs, limb_lines
from app.actions.marks import character_named, track_named
from app.actions.results import rate
from app.actions.session import Session
from app.commands.console import Console
from app.commands.project import PATH, PROJECT
from imitation.errors import InputError, NoSolution


@click.command()
@PROJECT
@click.option("--write", "target", type=PATH, help="Write the path: a folder (COLMAP text) or a .json (nerfstudio).")
@click.pass_obj
def cameras(console: Console, project: Path, target: Path | None) -> None:
    """Solve the camera of every frame."""
    with closing(Session.open(project)) as session:
        (path,) = console.compute(session, "Solving the cameras", (session.stages.cameras,))
        if target is not None:
            from app.formats.cameras import write_cameras

            clip = session.document.clip
            assert clip is not None
            write_cameras(target, path, (clip.width, clip.height))
        residuals = path.residuals[np.isfinite(path.residuals)]
        values: dict[str, Any] = {
            "verdict": path.verdict,
            "reason": path.reason,
            "frames": len(path),
            "focal": float(path.K[0, 0, 0]),
            "points": len(path.points),
            "residual_px": float(np.median(residuals)) if len(residuals) else None,
        }
        error = f", {values['residual_px']:.2f} px" if len(residuals) else ""
        line = f"{path.verdict}: {len(path)} frames, focal {values['focal']:.1f} px, {len(path.points)} points{error}"
        console.answer(values, [line, path.reason] if path.reason else [line])
        if path.verdict == "failed":
            raise NoSolution(path.reason)


@click.command()
@PROJECT
@click.argument("names", nargs=-1)
@click.option("--write", "target", type=PATH, help="Write the tracks: .json or .csv.")
@click.pass_obj
def track(console: Console, project: Path, names: tuple[str, ...], target: Path | None) -> None:
    """Follow the clicked points through the clip (all, or those named)."""
    from imitation.tracking import suggest_correction

    with closing(Session.open(project)) as session:
        document = session.document
        chosen = [track_named(document, name) for name in names] or list(document.tracks)
        if not chosen:
            raise InputError("This project has no tracks yet: click points with set --click NAME FRAME X Y.")
        solved = console.compute(session, "Tracking", tuple(session.stages.track(each.id) for each in chosen))
        if target is not None:
            from app.formats.tracks import TrackFile, write_tracks

            made = {
                each.name: TrackFile(found.positions, found.confidence, tuple(found.state))
                for each, found in zip(chosen, solved, strict=True)
            }
            clip = document.clip
            assert clip is not None
            write_tracks(target, made, size=(clip.width, clip.height), fps=rate(session))
        values, lines = {}, []
        for each, found in zip(chosen, solved, strict=True):
            seen = int(np.isfinite(found.positions).all(axis=1).sum())
            sure, click_next = float(np.mean(found.confidence)), suggest_correction(found)
            values[each.name] = {"frames": seen, "confidence": sure, "click_next": click_next}
            lines.append(
                f"{each.name:24} {seen} frames, confidence {sure:.2f}, next click helps most in frame {click_next}"
            )
        console.answer(values, lines)


@click.command()
@PROJECT
@click.option("--character", "names", multiple=True, help="Only this character; may be given again.")
@click.option("--skip-ambiguous", is_flag=True, help="Do not look for limbs that the video explains in two ways.")
@click.pass_obj
def animate(console: Console, project: Path, names: tuple[str, ...], skip_ambiguous: bool) -> None:
    """Move the characters as the filmed subject moves, and say which limbs could be elsewhere."""
    with closing(Session.open(project)) as session:
        document = session.document
        chosen = [character_named(document, name) for name in names] or list(document.characters)
        if not chosen:
            raise InputError("This project has no character yet: add one with set --character FILE.")
        stages = tuple(session.stages.animation(each.id) for each in chosen)
        solved = console.compute(session, "Animating", stages)
        if not skip_ambiguous:
            looks = tuple(session.stages.ambiguous(each.id) for each in chosen)
            console.compute(session, "Looking for ambiguous limbs", looks)
        values, lines = {}, []
        for each, result in zip(chosen, solved, strict=True):
            limbs = ambiguous_limbs(session, each.id)
            values[each.name] = result.report if limbs is None else {**result.report, "ambiguous": limbs}
            lines += [*_table(each.name, result), *limb_lines(limbs or [])]
        console.answer(values, lines)


def _table(name: str, result: Any) -> list[str]:
    report = result.report
    seconds = ", ".join(f"{step} {spent:.1f} s" for step, spent in report["seconds"].items())
    counts = (
        f"{name}: {report['frames']} frames of {report['vertices']} vertices, {report['tracks']} tracked points, "
        f"{report['anchors']} anchors with {report['contacts']} contacts, {report['edited_frames']} edited frames"
    )
    return [counts, f"  {seconds}"]


@click.command("contacts")
@PROJECT
@click.argument("names", nargs=-1)
@click.option("--accept", is_flag=True, help="Mark what was proposed.")
@click.pass_obj
def contacts(console: Console, project: Path, names: tuple[str, ...], accept: bool) -> None:
    """Propose frames in which points stand on the ground (of all tracks, or those named)."""
    from app.actions.proposing import accept_contacts, proposed_contacts

    with closing(Session.open(project)) as session:
        chosen = [track_named(session.document, name) for name in names] or list(session.document.tracks)
        stages = tuple(session.stages.track(each.id) for each in chosen)
        console.compute(session, "Tracking", (*stages, session.stages.world))
        values, lines = {}, []
        for each in chosen:
            spans = proposed_contacts(session, each.id)
            values[each.name] = [[span.first, span.last] for span in spans]
            lines.append(f"{each.name:24} {', '.join(f'{span.first}-{span.last}' for span in spans) or 'none'}")
            if accept:
                accept_contacts(session, each.id, spans)
        if accept:
            session.save()
        console.answer(values, lines)
