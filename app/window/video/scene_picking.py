"""Choosing points of the recovered scene, or tracks, in the picture."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from app.window.camera_evidence import Evidence, evidence
from app.window.canvas import TrackMark
from app.window.canvas.gestures import Drawn, Placed
from app.window.canvas.hits import GRAB, inside
from app.window.picture_layers import Shown, track_at
from app.window.project import Project

Name = TypeVar("Name", int, str)


def seen_points(project: Project, frame: int) -> Evidence:
    """The recovered points of a frame."""
    return evidence(project.result(project.session.stages.cameras), frame)


def choose(
    project: Project, shown: Shown, marks: tuple[TrackMark, ...], frame: int, event: Placed | Drawn, scale: float
) -> None:
    """Change what is chosen: a click switches one point or track, a line takes the points inside by its mode."""
    points = seen_points(project, frame)
    if isinstance(event, Drawn):
        found = [int(i) for i, place in zip(points.index, points.places, strict=True) if inside(place, event.points)]
        shown.picked = picked(shown.picked, found, event.mode)
        return
    track = track_at(marks, frame, event.place, scale)
    if track:
        shown.picked_tracks = _switched(shown.picked_tracks, track)
        return
    index = points.nearest(event.place, GRAB / scale)
    if index >= 0:
        shown.picked = _switched(shown.picked, index)


def picked(before: tuple[int, ...], found: list[int], mode: str) -> tuple[int, ...]:
    """A choice of points after another one: new, added or taken away; the order of choosing is kept."""
    if mode == "subtract":
        return tuple(index for index in before if index not in set(found))
    return tuple(dict.fromkeys((*(before if mode == "add" else ()), *found)))


def _switched(chosen: tuple[Name, ...], one: Name) -> tuple[Name, ...]:
    return tuple(each for each in chosen if each != one) if one in chosen else (*chosen, one)


def clear(shown: Shown) -> None:
    """Choose nothing."""
    shown.picked, shown.picked_tracks = (), ()


def keep_valid(project: Project, shown: Shown) -> None:
    """Forget what is there no more."""
    path = project.result(project.session.stages.cameras)
    count = len(path.points) if path is not None else 0
    if any(index >= count for index in shown.picked):
        shown.picked = tuple(np.array(shown.picked)[np.array(shown.picked) < count].tolist())
    ids = {track.id for track in project.document.tracks}
    shown.picked_tracks = tuple(track for track in shown.picked_tracks if track in ids)
