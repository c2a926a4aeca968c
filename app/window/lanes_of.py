"""The lanes of a project: what the document holds and how far its results are, as plain values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from app.model.character import Character
from app.model.edits import contacts
from app.model.tracks import Track
from app.model.values import Interval
from app.stages.stage import Stage
from app.window import theme
from app.window.moment import Moment
from app.window.project import Project
from app.window.timeline import Bar, Curve, Diamond, Lane, Row

DOUBT = 0.5
FAR_OFF = 1.0
"""Pixels of reprojection error above which a frame's camera deserves a look."""
Proposals = Mapping[str, Sequence[Interval]]
_CURVES: WeakKeyDictionary[Project, Curve] = WeakKeyDictionary()
_TRACKS: WeakKeyDictionary[Project, dict[int, tuple[tuple[Moment, str, str], Lane]]] = WeakKeyDictionary()
STATE_COLOURS = {"fresh": "ok", "running": "accent", "stale": "warn", "failed": "err", "missing": "line2"}
VIDEO_LEGEND = (
    ("click, mask", "text", "diamond"),
    ("being solved", "accent", "bar"),
    ("waiting", "warn", "bar"),
    ("low confidence", "text2", "hatch"),
    ("contact", "contact", "bar"),
    ("proposed", "contact", "hatch"),
)
CHARACTER_LEGEND = (
    ("pose edit", "edit", "diamond"),
    ("up to date", "ok", "bar"),
    ("being solved", "accent", "bar"),
    ("waiting", "warn", "bar"),
    ("contact", "contact", "bar"),
)


def video_lanes(project: Project, proposals: Proposals | None = None) -> list[Lane]:
    """Pictures and masks, tracks, contacts with those proposed, and how well the cameras fit."""
    lanes = [_pictures(project), _tracks(project, 8), _contacts(project, proposals or {})]
    fit = _reprojection(project)
    return lanes if fit is None else [*lanes, fit]


def character_lanes(project: Project, solved: NDArray[np.bool_] | None) -> list[Lane]:
    """Tracks, contacts, edited poses, and how far the solution is (``solved``: frames that have streamed in)."""
    lanes = [_tracks(project, 6), _contacts(project)]
    character = next((each for each in project.document.characters if each.id == project.character_id), None)
    if character is not None:
        lanes += [_poses(project, character), _solution(project, character, solved)]
    return lanes


def _pictures(project: Project) -> Lane:
    masks = tuple(Diamond(frame) for frame in project.document.masks)
    last = max(project.frame_count - 1, 0)
    row = Row("masks", (Bar(0, last, "line2", "line"),) if masks else (), masks)
    title = f"Video, {len(masks)} mask{'s' if len(masks) != 1 else ''}" if masks else "Video"
    return Lane("video", title, "video", (row,) if masks else (), 12, 1, thumbnails=True, edits=("retime",))


def _tracks(project: Project, shown: int) -> Lane:
    """The points, made anew where anything that they show may have changed: not for every frame that streams in."""
    now = (Moment.of(project.session), project.track_id, theme.active().name)
    kept = _TRACKS.setdefault(project, {})
    if shown not in kept or kept[shown][0] != now:
        kept[shown] = (now, _tracks_now(project, shown))
    return kept[shown][1]


def _tracks_now(project: Project, shown: int) -> Lane:
    rows = tuple(_track_row(project, track) for track in project.document.tracks)
    return Lane("tracks", "Points", "tracks", rows, 9, shown, counted=True)


def _track_row(project: Project, track: Track) -> Row:
    colour = _track_colour(track)
    clicks = tuple(Diamond(frame) for frame in track.clicks)
    bars: list[Bar] = []
    for stage in project.session.stages.spans(track.id):
        bars += _span_bars(project, stage, colour)
    return Row(track.id, tuple(bars), clicks, selected=track.id == project.track_id)


def _track_colour(track: Track) -> str:
    tracks = theme.active().tracks
    return tracks[track.colour % len(tracks)]


def _span_bars(project: Project, stage: Stage, colour: str) -> list[Bar]:
    state = project.state(stage)
    if state != "fresh":
        ends = stage.name.rsplit("/", 1)[-1].split("-")
        if len(ends) != 2 or not all(end.isdigit() for end in ends):
            return []
        token = {"running": "accent", "failed": "err"}.get(state, "warn")
        return [Bar(int(ends[0]), int(ends[1]), token)]
    span = project.result(stage)
    return [] if span is None else span_bars(span, colour)


def span_bars(span: Any, colour: str) -> list[Bar]:
    """A solved span as bars: solid where it is sure, hatched where it is not, dim where the point is hidden."""
    confidence, state = np.asarray(span.confidence), np.asarray(span.state)
    code = np.where(state == "outside", 3, np.where(state == "occluded", 2, np.where(confidence < DOUBT, 1, 0)))
    edges = np.flatnonzero(np.diff(code)) + 1
    styles = ("solid", "hatch", "dim")
    first = int(span.plan.first)
    return [
        Bar(first + int(begin), first + int(end), colour, styles[code[begin]])
        for begin, end in zip((0, *edges), (*edges, len(code) - 1), strict=True)
        if code[begin] < 3
    ]


def _contacts(project: Project, proposals: Proposals | None = None) -> Lane:
    rows, count = [], 0
    for track in project.document.tracks:
        open_ = [span for span in (proposals or {}).get(track.id, ()) if not contacts.marked(track, span)]
        chosen = track.id == project.track_id
        if track.contacts or open_ or chosen:
            bars = tuple(Bar(each.span.first, each.span.last, "contact") for each in track.contacts)
            offered = tuple(Bar(span.first, span.last, "contact", "hatch") for span in open_)
            rows.append(Row(track.id, bars + offered, selected=chosen))
            count += len(bars)
    return Lane("contacts", f"Contacts, {count}", "contact", tuple(rows), 9, 6, edits=("paint", "trim"))


def _reprojection(project: Project) -> Lane | None:
    """How far the recovered points are from where they were seen, a frame; None where nothing is known."""
    path = project.result(project.session.stages.cameras)
    if path is None or not np.isfinite(path.residuals).any():
        return None
    kept = _CURVES.get(project)
    if kept is None or kept.values is not path.residuals:
        kept = _CURVES[project] = Curve(path.residuals, FAR_OFF)
    worst = float(np.nanmax(path.residuals))
    return Lane("reprojection", f"Reprojection, {worst:.1f} px", "reprojection", curve=kept)


def worst_near(residuals: NDArray[np.float64], frame: int, reach: int) -> int:
    """The frame of the largest residual (n,) within ``reach`` frames; the frame itself where none is known."""
    first = max(frame - reach, 0)
    near = residuals[first : frame + reach + 1]
    return first + int(np.nanargmax(near)) if np.isfinite(near).any() else frame


def _poses(project: Project, character: Character) -> Lane:
    marks = tuple(
        Diamond(frame, "edit", frame == project.frame or not any(move.muted for move in edit.moves.values()))
        for frame, edit in character.edits.items()
    )
    last = max(project.frame_count - 1, 0)
    row = Row("poses", (Bar(0, last, "edit", "line"),) if marks else (), marks)
    return Lane("poses", f"Pose edits, {len(marks)}", "pose", (row,), 22, 1, padding=2)


def _solution(project: Project, character: Character, solved: NDArray[np.bool_] | None) -> Lane:
    last = max(project.frame_count - 1, 0)
    state = project.motion_state(character.id)
    bars: list[Bar] = []
    if state in ("running", "stale") and solved is not None and solved.any():
        done = "accent" if state == "running" else "ok"
        edges = np.flatnonzero(np.diff(solved)) + 1
        for begin, end in zip((0, *edges), (*edges, len(solved) - 1), strict=True):
            bars.append(Bar(int(begin), int(end), done if solved[begin] else "warn"))
    elif state != "blocked":
        texts = {"fresh": "up to date", "stale": "waiting", "running": "being solved", "failed": "failed"}
        bars.append(Bar(0, last, STATE_COLOURS.get(state, "line2"), text=texts.get(state, "not solved yet")))
    return Lane("solution", "Solution", "solution", (Row("solution", tuple(bars)),), 22, 1, padding=2)
