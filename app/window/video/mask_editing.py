"""Editing drawn masks with the mouse: which part of a lasso is under it, and what a drag of that part means.

A part is named "corner/LASSO/INDEX", "edge/LASSO/INDEX" (from that corner to the next) or "lasso/LASSO".
"""

from __future__ import annotations

import math

import numpy as np

from app.model.document import Document
from app.model.edits import Edit, masks, scene
from app.model.values import KeyMask, Point2
from app.window.canvas.gestures import DragGesture
from app.window.canvas.hits import inside, nearest_edge, nearest_point

CORNER, EDGE = 8.0, 6.0
KINDS = ("corner", "edge", "lasso")


def part_at(key: KeyMask | None, place: Point2, scale: float, *, whole: bool) -> str:
    """The part of a mask under a picture place; corners before edges, and insides only where ``whole``."""
    lassos = key.lassos if key is not None else ()
    for number in reversed(range(len(lassos))):
        points = lassos[number].points
        corner = nearest_point(place, points, [""] * len(points), CORNER / scale)
        if corner is not None:
            return f"corner/{number}/{corner.index}"
    for number in reversed(range(len(lassos))):
        edge = nearest_edge(place, lassos[number].points, EDGE / scale)
        if edge is not None:
            return f"edge/{number}/{edge[0]}"
    if whole:
        for number in reversed(range(len(lassos))):
            if inside(place, lassos[number].points):
                return f"lasso/{number}"
    return ""


def is_part(owner: str) -> bool:
    """Whether a name is that of a part of a mask."""
    return owner.split("/", 1)[0] in KINDS


def drag_of(key: KeyMask, part: str, place: Point2, scale: float) -> DragGesture:
    """The drag that begins with a press on a part."""
    kind, lasso, *index = part.split("/")
    origin = key.lassos[int(lasso)].points[int(index[0])] if kind == "corner" else place
    return DragGesture(part, origin, 2.5 / scale)


def moved(document: Document, frame: int, part: str, place: Point2, start: Point2) -> Edit:
    """The edit that dragging a part from ``start`` to ``place`` means: an edge gets a corner where it is pulled."""
    kind, lasso, *index = part.split("/")
    if kind == "corner":
        return scene.move_lasso_point(document, frame, int(lasso), int(index[0]), place)
    if kind == "edge":
        return masks.insert_lasso_point(document, frame, int(lasso), int(index[0]), place)
    return masks.move_lasso(document, frame, int(lasso), (place[0] - start[0], place[1] - start[1]))


def removed(document: Document, frame: int, part: str) -> Edit:
    """The edit that deleting a part means: a corner, or the lasso it belongs to."""
    kind, lasso, *index = part.split("/")
    if kind == "corner":
        return masks.remove_lasso_point(document, frame, int(lasso), int(index[0]))
    return masks.remove_lasso(document, frame, int(lasso))


def simplified(points: tuple[Point2, ...], tolerance: float) -> tuple[Point2, ...]:
    """A drawn line with the corners that it needs: it leaves the hand's way by at most ``tolerance`` pixels.

    Douglas and Peucker's method on the closed line, divided at its first point and at the one farthest from it.
    """
    line = np.asarray(points, np.float64)
    far = int(np.argmax(np.hypot(*(line - line[0]).T)))
    closed = np.vstack([line, line[:1]])
    kept = {0, far}
    stack = [(0, far), (far, len(line))]
    while stack:
        begin, end = stack.pop()
        if end - begin < 2:
            continue
        chord = closed[end] - closed[begin]
        ways = closed[begin + 1 : end] - closed[begin]
        length = math.hypot(*chord)
        gaps = np.abs(ways[:, 0] * chord[1] - ways[:, 1] * chord[0]) / length if length else np.hypot(*ways.T)
        worst = int(np.argmax(gaps))
        if gaps[worst] > tolerance:
            middle = begin + 1 + worst
            kept.add(middle)
            stack += [(begin, middle), (middle, end)]
    corners = tuple((float(x), float(y)) for x, y in line[sorted(kept)])
    return corners if len(corners) >= 3 else points
