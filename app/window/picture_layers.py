"""The layers over a picture of the clip, made from the project, and which track lies under the mouse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.model.document import Document
from app.model.tracks import Track
from app.model.values import KeyMask
from app.window import theme
from app.window.camera_evidence import evidence, ground_grid, horizon
from app.window.canvas import GhostPath, GroundGrid, Outline, OutlineLayer, Overlay, ScenePoints, TrackLayer, TrackMark
from app.window.canvas.backdrop import Backdrop
from app.window.canvas.hits import GRAB, nearest_point
from app.window.canvas.overlays import FUTURE, PAST
from app.window.canvas.snap_layer import SnapMark
from app.window.project import Project
from app.window.reading import Reading

HIDDEN_STATES = {"occluded": "hidden", "outside": "outside", "": "missing"}


@dataclass
class Shown:
    """What is drawn, and what is under way with the mouse.

    mask_part : the part of this frame's mask that is selected (``video.mask_editing``); mask_moving the mask as it is
        being dragged. subtracting : the line being drawn takes away. choosing : points of the scene are being chosen.
    background : whether the measured background is wanted; backdrop what of it is shown. snap : an anchor on its way.
    picked : the chosen ones, as indices of the cameras' points; picked_tracks the ids of chosen tracks.
        before : the paths of tracks that are being solved again, compared those of tracks that just were.
    """

    paths: bool = True
    masks: bool = True
    camera: bool = False
    names: bool = True
    marks: bool = True
    onion: bool = False
    grid: bool = False
    background: bool = False
    backdrop: Backdrop | None = None
    snap: SnapMark | None = None
    choosing: bool = False
    picked: tuple[int, ...] = ()
    picked_tracks: tuple[str, ...] = ()
    hovered: str = ""
    mask_part: str = ""
    mask_moving: KeyMask | None = None
    subtracting: bool = False
    dragged: tuple[str, tuple[float, float]] | None = None
    drawing: tuple[tuple[float, float], ...] = ()
    before: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    compared: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)


def colour_of(track: Track) -> str:
    """The colour of a track in the look in use."""
    tracks = theme.active().tracks
    return tracks[track.colour % len(tracks)]


def colour_over_film(track: Track) -> str:
    """The same over a film, where every mark lies on a dark ground, whatever the look of the window."""
    tracks = theme.DARK.tracks
    return tracks[track.colour % len(tracks)]


def track_marks(project: Project, reading: Reading, frame: int, shown: Shown) -> tuple[TrackMark, ...]:
    """The tracks that are drawn, as values."""
    marks = []
    for track in project.document.tracks:
        if not track.visible:
            continue
        known = reading.track(track)
        word = str(known.state[frame]) if frame < len(known.state) else ""
        marks.append(
            TrackMark(
                track.id,
                track.name,
                colour_over_film(track),
                known.positions,
                HIDDEN_STATES.get(word, "seen"),
                clicked=frame in track.clicks,
                selected=track.id in (project.track_id, *shown.picked_tracks),
                contact=any(frame in contact.span for contact in track.contacts),
                place=shown.dragged[1] if shown.dragged and shown.dragged[0] == track.id else None,
            )
        )
    return tuple(marks)


def layers(project: Project, marks: tuple[TrackMark, ...], frame: int, shown: Shown) -> list[Overlay]:
    """All layers, the first at the bottom."""
    made: list[Overlay] = [] if shown.backdrop is None else [shown.backdrop]
    if not shown.marks:
        return made
    if shown.grid:
        made += _grid(project, frame)
    if shown.camera or shown.choosing:
        made.append(_scene_points(project, frame, shown))
    if shown.masks or shown.drawing:
        made.append(_masks(project, frame, shown))
    old = {**shown.compared, **shown.before}
    tracks = [track for track in project.document.tracks if track.visible and track.id in old]
    made += [GhostPath(_around(old[track.id], frame), colour_over_film(track)) for track in tracks]
    made.append(TrackLayer(marks, frame, shown.paths, shown.names, shown.hovered))
    return made if shown.snap is None else [*made, shown.snap]


def _masks(project: Project, frame: int, shown: Shown) -> OutlineLayer:
    document = project.document
    made: list[Outline] = []
    if shown.masks and shown.onion:
        made += _neighbours(document, frame)
    drawn = shown.mask_moving or document.masks.get(frame)
    if shown.masks and drawn is not None:
        kind, lasso, index = _part(shown.mask_part)
        for number, each in enumerate(drawn.lassos):
            lit = number == lasso
            active = index + (kind == "edge" and shown.mask_moving is not None) if lit and kind != "lasso" else -1
            if kind == "edge" and shown.mask_moving is None:
                active = -1
            made.append(Outline(np.array(each.points), "subtract" if each.subtract else "add", active, lit))
    elif shown.masks and document.masks:
        masks = project.result(project.session.stages.masks)
        if masks is not None:
            made += [Outline(points, "between") for points in outline(masks[frame])]
    return OutlineLayer(tuple(made), shown.drawing, shown.subtracting)


def _around(path: NDArray[np.float64], frame: int) -> NDArray[np.float64]:
    """As much of an old path (n, 2) as is shown of the new one of a chosen track."""
    return path[max(frame - 2 * PAST, 0) : frame + 2 * FUTURE + 1]


def _part(name: str) -> tuple[str, int, int]:
    """Kind, lasso and corner of a part of a mask; -1 where there is none."""
    kind, *numbers = name.split("/")
    lasso, index, *_ = (*(int(number) for number in numbers), -1, -1)
    return kind, lasso, index


def _neighbours(document: Document, frame: int) -> list[Outline]:
    """The key masks before and after a frame."""
    before = max((key for key in document.masks if key < frame), default=None)
    after = min((key for key in document.masks if key > frame), default=None)
    found: list[Outline] = []
    for key, kind in ((before, "before"), (after, "after")):
        if key is not None:
            lassos = document.masks[key].lassos
            found += [Outline(np.array(lasso.points), kind) for lasso in lassos]  # type: ignore[arg-type]
    return found


def outline(mask: NDArray[np.bool_]) -> list[NDArray[np.float64]]:
    """The borders of a mask (h, w) as polygons (n, 2)."""
    import cv2

    found, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_TC89_L1)
    return [line[:, 0].astype(np.float64) for line in found if len(line) >= 8]


def _scene_points(project: Project, frame: int, shown: Shown) -> ScenePoints:
    found = evidence(project.result(project.session.stages.cameras), frame)
    clip = project.document.clip
    size = (clip.width, clip.height) if clip is not None else (0, 0)
    inside = ((found.places > -0.5) & (found.places < np.subtract(size, 0.5))).all(1)
    return ScenePoints(found.places[inside], found.residuals[inside], np.isin(found.index[inside], shown.picked))


def missing_evidence(project: Project, layer: str) -> str:
    """Why a layer of evidence shows nothing; empty where it shows something."""
    path = project.result(project.session.stages.cameras)
    if path is None:
        return "The cameras have not been solved yet: run what is missing."
    if layer == "camera":
        return "" if len(path.points) else "These cameras came without points of the scene."
    world = project.result(project.session.stages.world)
    if world is None:
        return "The ground has not been laid yet: run what is missing."
    return "No ground is known: a constant depth is assumed." if world.depth is not None else ""


def _grid(project: Project, frame: int) -> list[Overlay]:
    world, clip = project.result(project.session.stages.world), project.document.clip
    if world is None or clip is None or world.depth is not None or frame >= len(world.cameras):
        return []
    camera, size = world.camera(frame), (clip.width, clip.height)
    lines, step = ground_grid(camera, world.offset, size)
    cell = f"a cell is {step:g} m" if world.metric else f"a cell is {step:g} units, the scale is unknown"
    return [GroundGrid(tuple(lines), size, horizon(camera, size), cell if lines else "")]


def track_at(marks: tuple[TrackMark, ...], frame: int, place: tuple[float, float], scale: float) -> str:
    """The track under a picture place, within a reach that is the same on the screen at any zoom; empty for none.

    Of several within reach a selected one is taken.
    """
    places = [mark.at(frame) or (np.nan, np.nan) for mark in marks]
    chosen = [number for number, mark in enumerate(marks) if mark.selected]
    reach = GRAB / scale
    for numbers in (chosen, range(len(marks))):
        rows = [places[number] for number in numbers]
        found = nearest_point(place, rows, [marks[number].name for number in numbers], reach) if rows else None
        if found is not None:
            return found.owner
    return ""
