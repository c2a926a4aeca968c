"""The tools of the Video workspace: which gesture a press starts, as a pure choice."""

from __future__ import annotations

from typing import Literal

from app.model.values import KeyMask
from app.window.canvas import TrackMark
from app.window.canvas.gestures import DragGesture, Gesture, LassoGesture, PickGesture, PlaceGesture
from app.window.picture_layers import track_at
from app.window.video import mask_editing
from app.window.video.contact_snapping import ANCHOR

Tool = Literal["select", "lasso", "point", "contact", "ground", "pan"]
TOOLS: tuple[tuple[Tool, str, str], ...] = (
    ("select", "Select", "V"),
    ("lasso", "Lasso", "M"),
    ("point", "Point", "P"),
    ("contact", "Contact", "C"),
    ("ground", "Ground", "B"),
    ("pan", "Pan", "H"),
)
LAYERS = (
    ("paths", "paths", "Paths"),
    ("masks", "masks", "Masks"),
    ("onion", "onion", "Onion"),
    ("names", "labels", "Names"),
    ("camera", "camera", "Camera"),
    ("grid", "grid", "Ground"),
    ("background", "background", "Background"),
)
"""What can be drawn over the picture and is remembered between runs: name, icon, text."""
NARROW = 1300
"""Pixels of width below which the switches show no text."""
HINTS: dict[str, str] = {
    "select": "Drag a point, or a mask's corner, edge or inside, to where it belongs. Wheel zooms, middle button pans.",
    "lasso": "Draw round the subject, roughly. Shift adds, Alt takes away; corners and edges can be pulled.",
    "point": "Click a place on the subject that can be recognised: it is followed through the clip.",
    "contact": "Click a point where it begins to stand, then in the last such frame; drag it onto the surface.",
    "ground": "Click recovered points or draw round them, for the ground or a length. Shift adds, Alt removes.",
    "pan": "Drag to move the picture.",
}


def gesture_for(
    tool: Tool,
    marks: tuple[TrackMark, ...],
    frame: int,
    place: tuple[float, float],
    scale: float,
    *,
    adding: bool,
    subtracting: bool,
    key: KeyMask | None = None,
    anchors: bool = False,
) -> Gesture | None:
    """The gesture that a press at a place starts with a tool.

    ``key`` is the mask drawn in this frame, if seen; ``anchors`` says that contacts can be dragged over a surface.
    """
    if tool == "pan":
        return None
    part = mask_editing.part_at(key, place, scale, whole=tool == "select")
    if tool == "lasso":
        if part and key is not None and not (adding or subtracting):
            return mask_editing.drag_of(key, part, place, scale)
        return LassoGesture("subtract" if subtracting else "add" if adding else "new", 3.0 / scale, 60.0 / scale)
    if tool == "ground":
        mode = "subtract" if subtracting else "add" if adding else "new"
        return PickGesture(mode, 3.0 / scale, 60.0 / scale, 5.0 / scale)
    track = track_at(marks, frame, place, scale)
    mark = next((each for each in marks if each.name == track), None)
    if mark is not None:
        origin = mark.at(frame) or place
        if tool == "contact" and anchors:
            return DragGesture(f"{ANCHOR}{track}", origin, 2.5 / scale)
        return DragGesture(track, origin, 1e9 if tool == "contact" else 2.5 / scale)
    if tool == "select" and part and key is not None:
        return mask_editing.drag_of(key, part, place, scale)
    if tool == "point":
        return PlaceGesture(6.0 / scale)
    return DragGesture("", place, 1e9)
