"""Drawing the motion graph: edges by cost, round pictures in the colour of their sequence, badges of key motions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QFontMetricsF, QImage, QPainter, QPainterPath, QPen, QPolygonF

from app.window import fonts, theme
from app.window.performance.graph_view import OVAL, EdgeMark, GroupMark, Lens, NodeMark, Picture, Place, bow, on_bow

Thumbnail = Callable[[int], QImage | None]
SOLID, ROUND = Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap
PICTURED, NAMED = 34.0, 30.0
"""Least diameter in pixels at which a node shows its picture, and every node its name."""
THIN = 400
"""So many edges of one kind are drawn thinly at most, the cheapest first."""
SHARES = (0.42, 0.55, 0.3, 0.68, 0.2, 0.8)
"""Where along an edge its cost may stand, the best first."""
ASIDE = (16.0, 28.0, -16.0)
"""Pixels beside it where it may stand else."""


def paint_ground(painter: QPainter, width: int, height: int, lens: Lens) -> None:
    """The surface, with dots that move with the graph so that panning is felt."""
    look = theme.active()
    painter.fillRect(0, 0, width, height, look.colour("canvas"))
    step = 36.0
    painter.setPen(QPen(look.colour("line"), 1.4, SOLID, ROUND))
    dots = [
        QPointF(lens.dx % step + column * step, lens.dy % step + row * step)
        for column in range(-1, int(width / step) + 1)
        for row in range(-1, int(height / step) + 1)
    ]
    painter.drawPoints(dots)


def paint_groups(painter: QPainter, groups: tuple[GroupMark, ...], lens: Lens) -> None:
    """The room of each sequence in a large graph."""
    for group in groups:
        colour = theme.active().colour(group.colour)
        painter.setPen(QPen(_faded(colour, 90), 1))
        painter.setBrush(_faded(colour, 18))
        painter.drawEllipse(_oval(group, lens))


def paint_group_names(painter: QPainter, groups: tuple[GroupMark, ...], lens: Lens) -> None:
    """Their names, over the edges, at the upper rim."""
    face = fonts.font(fonts.BODY, QFont.Weight.DemiBold)
    metrics = QFontMetricsF(face)
    for group in groups:
        oval = _oval(group, lens)
        plate = QRectF(0, 0, metrics.horizontalAdvance(group.name) + 12, metrics.height() + 2)
        plate.moveCenter(QPointF(oval.center().x(), max(oval.top(), plate.height() / 2 + 2)))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.active().colour("canvas", 225))
        painter.drawRoundedRect(plate, 4, 4)
        painter.setFont(face)
        painter.setPen(theme.active().colour(group.colour))
        painter.drawText(plate, Qt.AlignmentFlag.AlignCenter, group.name)


def _oval(group: GroupMark, lens: Lens) -> QRectF:
    x, y = lens.pixel(group.x, group.y)
    wide, high = OVAL * group.wide * lens.across + lens.size, OVAL * group.high * lens.down + lens.size
    return QRectF(x - wide, y - high, 2 * wide, 2 * high)


def paint_edges(painter: QPainter, picture: Picture, lens: Lens, chosen: int) -> None:
    """All edges; in a large graph only those of the chosen node and of the path fully, of the others the cheapest."""
    marks = {mark.node: mark for mark in picture.nodes}
    thin: dict[str, list[EdgeMark]] = {"faint": [], "kept": []}
    whole: list[EdgeMark] = []
    for edge in picture.edges:
        if edge.start in marks and edge.goal in marks:
            near = chosen in (edge.start, edge.goal)
            full = edge.kind == "path" or (edge.kind == "kept" and (near or not picture.crowded))
            (whole if full else thin[edge.kind]).append(edge)
    for kind, alpha in (("faint", 70), ("kept", 110)):
        _paint_thin(painter, thin[kind][:THIN], marks, lens, theme.active().colour("line2", alpha))
    for edge in sorted(whole, key=lambda edge: edge.kind == "path"):
        _paint_edge(painter, edge, marks[edge.start], marks[edge.goal], lens, chosen)


def _paint_thin(
    painter: QPainter, edges: list[EdgeMark], marks: dict[int, NodeMark], lens: Lens, colour: QColor
) -> None:
    """Many edges at one stroke, without heads."""
    path = QPainterPath()
    for edge in edges:
        start, goal = marks[edge.start], marks[edge.goal]
        begin, middle, end = bow(lens.pixel(start.x, start.y), lens.pixel(goal.x, goal.y), lens.size / 2 + 2)
        path.moveTo(*begin)
        path.quadTo(*middle, *end)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(colour, 1.0))
    painter.drawPath(path)


def _paint_edge(painter: QPainter, edge: EdgeMark, start: NodeMark, goal: NodeMark, lens: Lens, chosen: int) -> None:
    look = theme.active()
    near = chosen in (edge.start, edge.goal)
    if edge.kind == "path":
        colour, width = look.colour("accent"), 2.2 + 1.6 * edge.strength
    else:
        alpha = 30 if start.dim or goal.dim else 230 if near else 150
        colour, width = look.colour("text2" if near else "line2", alpha), 1.0 + 1.6 * edge.strength
    gap = lens.size / 2 + (3.5 if edge.kind == "path" else 2.0)
    begin, middle, end = bow(lens.pixel(start.x, start.y), lens.pixel(goal.x, goal.y), gap)
    path = QPainterPath(QPointF(*begin))
    path.quadTo(QPointF(*middle), QPointF(*end))
    pen = QPen(colour, width, SOLID, ROUND)
    if edge.poor:
        pen.setDashPattern([4, 3])
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(pen)
    painter.drawPath(path)
    if math.dist(begin, end) > 12:
        _paint_head(painter, on_bow(begin, middle, end, 0.86), end, colour, 6.0 + width)


def _paint_head(painter: QPainter, before: Place, tip: Place, colour: QColor, size: float) -> None:
    angle = math.atan2(tip[1] - before[1], tip[0] - before[0])
    turns = (angle + 2.72, angle - 2.72)
    points = [QPointF(tip[0] + size * math.cos(turn), tip[1] + size * math.sin(turn)) for turn in turns]
    points.append(QPointF(*tip))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(QPolygonF(points))


def paint_costs(painter: QPainter, picture: Picture, lens: Lens, names: dict[int, QRectF]) -> None:
    """The cost of every edge of the path, on a plate where it covers neither a node nor a name nor another cost.

    In a crowded graph a cost without such a place is left out: the lane below has it.
    """
    look = theme.active()
    face = fonts.font(fonts.CAPTION, QFont.Weight.DemiBold)
    metrics = QFontMetricsF(face)
    painter.setFont(face)
    marks = {mark.node: mark for mark in picture.nodes}
    taken = Taken([*(_circle(mark, lens) for mark in picture.nodes), *names.values()])
    for edge in picture.edges:
        if edge.kind != "path" or edge.start not in marks or edge.goal not in marks:
            continue
        start, goal = (lens.pixel(marks[node].x, marks[node].y) for node in (edge.start, edge.goal))
        curve = bow(start, goal, lens.size / 2)
        text = f"{edge.cost:.2f}"
        plate = QRectF(0, 0, metrics.horizontalAdvance(text) + 10, metrics.height() + 2)
        covered, plate = taken.take([plate.translated(spot - plate.center()) for spot in _spots(curve)])
        if picture.crowded and covered > 0:
            continue
        taken.keep(plate)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("canvas", 235))
        painter.drawRoundedRect(plate, 4, 4)
        painter.setPen(look.colour("accent"))
        painter.drawText(plate, Qt.AlignmentFlag.AlignCenter, text)


def _spots(curve: tuple[Place, Place, Place]) -> list[QPointF]:
    """Where the cost of an edge may stand: on it, then beside it on the side that it bows to."""
    begin, _, end = curve
    length = max(math.dist(begin, end), 1e-6)
    aside = QPointF(-(end[1] - begin[1]) / length, (end[0] - begin[0]) / length)
    on = [QPointF(*on_bow(*curve, share)) for share in SHARES]
    return [*on, *(spot + aside * shift for shift in ASIDE for spot in on[:3])]


class Taken:
    """Rooms that are covered already, of which new ones keep clear as far as they can."""

    def __init__(self, rooms: Iterable[QRectF]) -> None:
        self._rows = np.array([_row(room) for room in rooms]).reshape(-1, 4)

    def take(self, rooms: list[QRectF]) -> tuple[float, QRectF]:
        """The room that covers least, the first of equals, and how many pixels it covers; it is not kept."""
        rows = np.array([_row(room) for room in rooms])[:, None]
        low, high = np.maximum(self._rows[:, :2], rows[..., :2]), np.minimum(self._rows[:, 2:], rows[..., 2:])
        covered = np.prod(np.clip(high - low, 0.0, None), axis=2).sum(axis=1)
        best = int(covered.argmin())
        return float(covered[best]), rooms[best]

    def keep(self, room: QRectF) -> None:
        """Let others keep clear of it too."""
        self._rows = np.vstack([self._rows, _row(room)])


def _row(room: QRectF) -> tuple[float, float, float, float]:
    return room.left(), room.top(), room.right(), room.bottom()


def _circle(mark: NodeMark, lens: Lens) -> QRectF:
    x, y = lens.pixel(mark.x, mark.y)
    return QRectF(x - lens.size / 2, y - lens.size / 2, lens.size, lens.size)


def name_plates(picture: Picture, lens: Lens, chosen: int = -1) -> dict[int, QRectF]:
    """Where the names that are seen stand: below their nodes, or where they cover less of other nodes and names."""
    metrics = {strong: QFontMetricsF(_name_face(strong)) for strong in (False, True)}
    circles = {mark.node: _circle(mark, lens) for mark in picture.nodes}
    plates: dict[int, QRectF] = {}
    taken = Taken(circles.values())
    for mark in sorted(picture.nodes, key=lambda mark: (mark.node != chosen, not mark.on_path)):
        if not (lens.size >= NAMED or mark.on_path or mark.node == chosen):
            continue
        ring = mark.on_path or mark.node == chosen
        room, circle = metrics[ring], circles[mark.node]
        size = QSizeF(room.horizontalAdvance(_name(mark, room)) + 8, room.height())
        gap = 7.0 if ring else 4.0
        middle = circle.center()
        down = QPointF(0, circle.height() / 2 + gap + size.height() / 2)
        across = QPointF(circle.width() / 2 + gap + size.width() / 2, 0)
        plate = QRectF(QPointF(), size)
        spots = [plate.translated(middle + step - plate.center()) for step in (down, -down, across, -across)]
        _, plates[mark.node] = taken.take(spots)
        taken.keep(plates[mark.node])
    return plates


def paint_node(
    painter: QPainter,
    mark: NodeMark,
    lens: Lens,
    image: QImage | None,
    *,
    chosen: bool,
    hovered: bool,
    focus: bool,
    name: QRectF | None = None,
) -> None:
    """One motion: picture, ring, its name on a plate of a place, what is said about it."""
    look = theme.active()
    x, y = lens.pixel(mark.x, mark.y)
    radius = lens.size / 2
    circle = QRectF(x - radius, y - radius, 2 * radius, 2 * radius)
    painter.setOpacity(0.3 if mark.dim and not (chosen or hovered) else 1.0)
    _paint_inside(painter, mark, circle, image)
    ring = look.colour(mark.colour)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(ring, 2.4 if lens.size >= PICTURED else 1.6))
    painter.drawEllipse(circle)
    if mark.on_path or chosen:
        painter.setPen(QPen(look.colour("text" if chosen else "accent"), 2.4 if chosen else 2.0))
        painter.drawEllipse(circle.adjusted(-3.6, -3.6, 3.6, 3.6))
    if chosen and focus:
        painter.setPen(QPen(look.colour("accent"), 2))
        painter.drawEllipse(circle.adjusted(-7, -7, 7, 7))
    if name is not None:
        _paint_name(painter, mark, name, chosen or hovered)
    if mark.badges:
        turned = radius * 0.74
        paint_badge(painter, x + turned, y - turned, mark.badges)
    painter.setOpacity(1.0)


def _paint_inside(painter: QPainter, mark: NodeMark, circle: QRectF, image: QImage | None) -> None:
    look = theme.active()
    painter.setPen(Qt.PenStyle.NoPen)
    pictured = circle.width() >= PICTURED
    painter.setBrush(look.colour("panel") if pictured else _faded(look.colour(mark.colour), 120))
    painter.drawEllipse(circle)
    if pictured and image is not None and not image.isNull():
        path = QPainterPath()
        path.addEllipse(circle)
        painter.save()
        painter.setClipPath(path)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.drawImage(circle, image)
        painter.restore()
    if mark.forbidden:
        painter.setBrush(look.colour("canvas", 150))
        painter.drawEllipse(circle)
        painter.setBrush(QBrush(look.colour("err", 210), Qt.BrushStyle.BDiagPattern))
        painter.drawEllipse(circle)


def _name_face(strong: bool) -> QFont:
    return fonts.font(fonts.CAPTION, QFont.Weight.DemiBold if strong else QFont.Weight.Medium)


def _name(mark: NodeMark, metrics: QFontMetricsF) -> str:
    return metrics.elidedText(mark.name, Qt.TextElideMode.ElideMiddle, 150)


def _paint_name(painter: QPainter, mark: NodeMark, plate: QRectF, strong: bool) -> None:
    look = theme.active()
    face = _name_face(strong or mark.on_path)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(look.colour("canvas", 190))
    painter.drawRoundedRect(plate, 3, 3)
    painter.setFont(face)
    painter.setPen(look.colour("err" if mark.forbidden else "text" if strong or mark.on_path else "text2"))
    text = _name(mark, QFontMetricsF(face))
    painter.drawText(plate, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextDontClip), text)


def paint_badge(painter: QPainter, x: float, y: float, numbers: tuple[int, ...]) -> None:
    """The numbers of key motions, in the colour of what the user made."""
    look = theme.active()
    face = fonts.font(fonts.CAPTION, QFont.Weight.Bold)
    text = ", ".join(map(str, numbers))
    wide = max(20.0, QFontMetricsF(face).horizontalAdvance(text) + 10)
    plate = QRectF(x - wide / 2, y - 10, wide, 20)
    painter.setPen(QPen(look.colour("canvas"), 2))
    painter.setBrush(look.colour("edit"))
    painter.drawRoundedRect(plate, 10, 10)
    painter.setFont(face)
    painter.setPen(look.colour("on_accent"))
    painter.drawText(plate, Qt.AlignmentFlag.AlignCenter, text)


def _faded(colour: QColor, alpha: int) -> QColor:
    made = QColor(colour)
    made.setAlpha(alpha)
    return made
