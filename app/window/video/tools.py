"""The tools of the Video workspace: which gesture a press starts, as a pure choice."""

from __future__ import annotations

from typing import Literal

from app.window.canvas import TrackMark
from app.window.canvas.gestures import DragGesture, Gesture, LassoGesture, PlaceGesture
from app.window.picture_layers import track_at

Tool = Literal["select", "lasso", "point", "contact", "pan"]
TOOLS: tuple[tuple[Tool, str, str], ...] = (
    ("select", "Select", "V"),
    ("lasso", "Lasso", ""),
    ("point", "Point", "P"),
    ("contact", "Contact", "C"),
    ("pan", "Pan", "H"),
)
HINTS: dict[str, str] = {
    "select": "Drag a point to where it belongs: the frames around are solved again. Wheel zooms, middle button pans.",
    "lasso": "Draw round the subject, roughly. Shift adds to the mask of this frame, Alt takes away from it.",
    "point": "Click a place on the subject that can be recognised: it is followed through the clip.",
    "contact": "Click a point where it begins to stand on the ground, then click it again in the last such frame.",
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
) -> Gesture | None:
    """The gesture that a press at a place starts with a tool."""
    if tool == "pan":
        return None
    if tool == "lasso":
        return LassoGesture("subtract" if subtracting else "add" if adding else "new", 3.0 / scale, 60.0 / scale)
    track = track_at(marks, frame, place, scale)
    mark = next((each for each in marks if each.name == track), None)
    if mark is not None:
        origin = mark.at(frame) or place
        slack = 1e9 if tool == "contact" else 2.5 / scale
        return DragGesture(track, origin, slack)
    if tool == "point":
        return PlaceGesture(6.0 / scale)
    return DragGesture("", place, 1e9)
