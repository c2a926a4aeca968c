"""The motion graph as values: marks, the lens they are seen through, and what lies under the mouse."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

Place = tuple[float, float]
SMALLEST, LARGEST = 14.0, 120.0
"""Pixels of a node's diameter."""
FITTED = 92.0
"""Pixels a node has at most where everything is shown."""
WIDEST, STRETCH, SHARE = 150.0, 2.6, 0.62
"""Pixels of the layout's unit at most, how much more in one direction; what a node takes of the way to the nearest."""
NAME = (96.0, 44.0)
"""Room for names and badges beside and below."""
OVAL = 1.25
"""How much wider than its nodes the oval of a group is."""
BEND = 0.16
"""How far an edge bows, as a share of its length, so that both directions can be told apart."""


@dataclass(frozen=True)
class NodeMark:
    """A motion as it is drawn. ``x``, ``y`` in node diameters; ``badges`` number the key motions that it is."""

    node: int
    x: float
    y: float
    name: str
    colour: str
    sequence: str
    badges: tuple[int, ...] = ()
    forbidden: bool = False
    on_path: bool = False
    dim: bool = False


@dataclass(frozen=True)
class EdgeMark:
    """A transition as it is drawn. ``strength`` 1 is free, 0 as costly as any; ``kind`` is path, kept or faint."""

    start: int
    goal: int
    cost: float
    strength: float
    kind: str = "kept"
    poor: bool = False


@dataclass(frozen=True)
class GroupMark:
    """Room that a sequence's motions take in a large graph: centre, and half of what the nodes' middles span."""

    name: str
    colour: str
    x: float
    y: float
    wide: float
    high: float


@dataclass(frozen=True)
class Picture:
    """All that is drawn."""

    nodes: tuple[NodeMark, ...] = ()
    edges: tuple[EdgeMark, ...] = ()
    groups: tuple[GroupMark, ...] = ()
    crowded: bool = False

    def mark(self, node: int) -> NodeMark | None:
        """The mark of a node, None where it is not shown."""
        return next((each for each in self.nodes if each.node == node), None)


@dataclass(frozen=True)
class Lens:
    """Pixels from places: ``x_pixel = x * across + dx``; a node is ``size`` pixels wide."""

    size: float = FITTED
    across: float = FITTED
    down: float = FITTED
    dx: float = 0.0
    dy: float = 0.0

    def pixel(self, x: float, y: float) -> Place:
        """Where a place is seen."""
        return x * self.across + self.dx, y * self.down + self.dy

    def place(self, x: float, y: float) -> Place:
        """What place is seen at a pixel."""
        return (x - self.dx) / self.across, (y - self.dy) / self.down

    def zoomed(self, factor: float, x: float, y: float) -> Lens:
        """Zoom so that what is at a pixel stays there."""
        share = min(max(self.size * factor, SMALLEST), LARGEST) / self.size
        dx, dy = x - (x - self.dx) * share, y - (y - self.dy) * share
        return Lens(self.size * share, self.across * share, self.down * share, dx, dy)

    def moved(self, dx: float, dy: float) -> Lens:
        """Move by pixels."""
        return replace(self, dx=self.dx + dx, dy=self.dy + dy)


def fitted(picture: Picture, width: float, height: float) -> Lens:
    """The lens that shows everything, names included; it stretches the picture to the room there is, up to a degree."""
    if not picture.nodes:
        return Lens(dx=width / 2, dy=height / 2)
    xs, ys = [mark.x for mark in picture.nodes], [mark.y for mark in picture.nodes]
    for group in picture.groups:
        xs += [group.x - OVAL * group.wide, group.x + OVAL * group.wide]
        ys += [group.y - OVAL * group.high, group.y + OVAL * group.high]
    wide, high = max(max(xs) - min(xs), 0.5), max(max(ys) - min(ys), 0.5)
    size = min(FITTED, 0.3 * height)
    across = min(max(width - size - NAME[0], 60.0) / wide, WIDEST)
    down = min(max(height - size - NAME[1], 40.0) / high, WIDEST)
    across, down = min(across, STRETCH * down), min(down, STRETCH * across)
    near = _nearest([mark.x for mark in picture.nodes], [mark.y for mark in picture.nodes], across, down)
    size = max(min(size, SHARE * near), SMALLEST)
    dx = width / 2 - across * (max(xs) + min(xs)) / 2
    return Lens(size, across, down, dx, (height - NAME[1] / 2) / 2 - down * (max(ys) + min(ys)) / 2)


def _nearest(xs: list[float], ys: list[float], across: float, down: float) -> float:
    """The way in pixels between the two nodes that are nearest."""
    order = sorted(zip((x * across for x in xs), (y * down for y in ys), strict=True))
    best = math.inf
    for place, (x, y) in enumerate(order):
        for other_x, other_y in order[place + 1 :]:
            if other_x - x >= best:
                break
            best = min(best, math.hypot(other_x - x, other_y - y))
    return best


def node_at(picture: Picture, lens: Lens, x: float, y: float) -> NodeMark | None:
    """The node under a pixel; of several the one drawn last."""
    radius = max(lens.size / 2, 9.0)
    for mark in reversed(picture.nodes):
        px, py = lens.pixel(mark.x, mark.y)
        if math.hypot(px - x, py - y) <= radius:
            return mark
    return None


def bow(start: Place, goal: Place, radius: float) -> tuple[Place, Place, Place]:
    """Begin, control point and end of an edge between two nodes at pixels; it leaves and meets their rims."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    length = max(math.hypot(dx, dy), 1e-6)
    middle = ((start[0] + goal[0]) / 2 - dy * BEND, (start[1] + goal[1]) / 2 + dx * BEND)
    return _towards(start, middle, min(radius, length / 2)), middle, _towards(goal, middle, min(radius, length / 2))


def on_bow(begin: Place, middle: Place, end: Place, share: float) -> Place:
    """A point of the quadratic curve."""
    a, b, c = (1 - share) ** 2, 2 * share * (1 - share), share**2
    return a * begin[0] + b * middle[0] + c * end[0], a * begin[1] + b * middle[1] + c * end[1]


def edge_at(picture: Picture, lens: Lens, x: float, y: float, reach: float = 6.0) -> EdgeMark | None:
    """The edge within reach of a pixel; those of the path first."""
    marks = {mark.node: mark for mark in picture.nodes}
    best: tuple[int, float, EdgeMark] | None = None
    for edge in picture.edges:
        if edge.kind == "faint" or edge.start not in marks or edge.goal not in marks:
            continue
        start, goal = (lens.pixel(marks[node].x, marks[node].y) for node in (edge.start, edge.goal))
        curve = bow(start, goal, lens.size / 2)
        if not _inside(curve, x, y, reach):
            continue
        near = min(math.dist(on_bow(*curve, step / 24), (x, y)) for step in range(25))
        found = (0 if edge.kind == "path" else 1, near, edge)
        if near <= reach and (best is None or found[:2] < best[:2]):
            best = found
    return None if best is None else best[2]


def neighbour(picture: Picture, node: int, dx: int, dy: int) -> int:
    """The node that an arrow key leads to: the nearest in that direction; the same one where there is none."""
    here = picture.mark(node)
    if here is None:
        return picture.nodes[0].node if picture.nodes else -1
    best, least = node, math.inf
    for mark in picture.nodes:
        along = (mark.x - here.x) * dx + (mark.y - here.y) * dy
        across = abs((mark.x - here.x) * dy) + abs((mark.y - here.y) * dx)
        if mark.node != node and along > 0 and along + 2 * across < least:
            best, least = mark.node, along + 2 * across
    return best


def following(picture: Picture, node: int, step: int) -> int:
    """The node after (1) or before (-1) in the order of names; the first one where none is chosen."""
    order = [mark.node for mark in picture.nodes]
    if not order:
        return -1
    if node not in order:
        return order[0] if step > 0 else order[-1]
    return order[(order.index(node) + step) % len(order)]


def _towards(place: Place, other: Place, pixels: float) -> Place:
    length = max(math.dist(place, other), 1e-6)
    share = min(pixels / length, 1.0)
    return place[0] + (other[0] - place[0]) * share, place[1] + (other[1] - place[1]) * share


def _inside(curve: tuple[Place, Place, Place], x: float, y: float, reach: float) -> bool:
    xs, ys = [place[0] for place in curve], [place[1] for place in curve]
    return min(xs) - reach <= x <= max(xs) + reach and min(ys) - reach <= y <= max(ys) + reach
