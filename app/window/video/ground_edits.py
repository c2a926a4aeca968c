"""What is said about ground, horizon and scale, as edits; the ground is laid anew at once, for that is quick."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from app.model.edits import scene
from app.window.background_state import why_unmeasured
from app.window.project import Project

FLAT = ("static", "rotation", "planar")
"""Verdicts on the cameras that leave the depth of the ground open."""


FEWEST = 3
"""Points that a plane needs."""


@dataclass(frozen=True)
class Fallback:
    """What can be assumed where the pictures do not tell: its kind, what the button says, and why."""

    kind: str
    text: str
    words: str


PLANE = Fallback("plane", "A ground plane", "One level ground under the camera carries all contacts.")
DEPTH = Fallback("depth", "Constant depth", "No ground: the subject stays equally far from the camera.")
POINTS = Fallback("points", "Choose points…", "The ground is laid through points of the scene that you choose.")
STILL = Fallback("still", "Take the camera as still", "The clip is treated as filmed from a stand.")


def fallbacks(project: Project) -> tuple[Fallback, ...]:
    """What to offer in place: where the cameras failed, or show no depth and no ground was chosen yet."""
    path, document = project.result(project.session.stages.cameras), project.document
    if path is None:
        return ()
    if path.verdict == "failed":
        return (STILL,) if document.camera.source == "solve" else ()
    if document.world.ground != "local" or not (path.verdict in FLAT or why_unmeasured(project)):
        return ()
    return (*((POINTS,) if len(path.points) >= FEWEST else ()), PLANE, DEPTH)


def lead(project: Project) -> str:
    """Why something has to be assumed."""
    path = project.result(project.session.stages.cameras)
    if path is not None and path.verdict != "failed" and (reason := why_unmeasured(project)):
        return reason
    words = {
        "failed": "The cameras could not be solved.",
        "static": "The camera stands still: the pictures show no depth. Assume:",
        "rotation": "The camera only turns: the pictures show no depth. Assume:",
        "planar": "The scene is flat: its depth is not sure. Assume:",
    }
    return words.get(path.verdict, "") if path is not None else ""


def change(project: Project, make: Callable[..., Any], *values: object, **options: object) -> None:
    """Do an edit of what is known about the world, and lay the ground anew."""
    if project.edit(make, *values, **options):
        lay_anew(project)


def lay_anew(project: Project) -> None:
    """Lay the ground anew where the cameras are there."""
    stages = project.session.stages
    if project.result(stages.cameras) is None:
        return
    if project.state(stages.world) in ("missing", "stale") and stages.world.why_blocked() is None:
        project.start("Laying the ground", stages.world)


def choose(project: Project, kind: str) -> None:
    """Choose where contacts lie, or a fallback; points chosen before for a plane stay."""
    choice = project.document.world
    if kind == "still":
        project.edit(scene.set_camera, "static", focal=project.document.camera.focal)
        return
    kept = choice.plane_points if kind == "plane" else ()
    change(project, scene.set_ground, kind, plane_points=kept, depth_tracks=choice.depth_tracks, depth=choice.depth)


def drop_points(project: Project) -> None:
    """Forget the points that the ground was laid through: all recovered points count again."""
    change(project, scene.set_ground, "plane")


def hold(project: Project, tracks: Sequence[str]) -> None:
    """Keep these tracks, and no others, at the constant depth."""
    change(project, scene.set_ground, "depth", depth_tracks=tracks, depth=project.document.world.depth)


def set_depth(project: Project, depth: float | None) -> None:
    """Say how far away what is held at a constant depth is; None takes the usual."""
    change(project, scene.set_ground, "depth", depth_tracks=project.document.world.depth_tracks, depth=depth)
