"""Drawing the composed timeline: blocks with pictures and badges, the gap, costs and how well cuts are hidden."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QFont, QFontMetricsF, QImage, QPainter, QPen

from app.window import fonts, icons, theme
from app.window.performance.blocks import BUTTON, Block, Composed, Joint, box, repeatable
from app.window.performance.graph_paint import paint_badge
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER

Thumbnail = Callable[[str, int], QImage | None]
LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
OTHERWISE = "a motion between, or take another path"
LOOPED = 92.0
"""Pixels that the words of the way back to the start take, left of its bar."""


def paint_labels(painter: QPainter, width: int, heights: tuple[int, int]) -> None:
    """Names of the two lanes, and the lines between them."""
    look = theme.active()
    top = RULER
    for name, title, height in (("graph", "Composed", heights[0]), ("transition", "Transition cost", heights[1])):
        middle = top + height / 2
        painter.drawPixmap(QPointF(12, middle - 8), icons.pixmap(name, "text3", 16))
        painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.Medium))
        painter.setPen(look.colour("text2"))
        painter.drawText(QRectF(36, middle - 10, LABELS - 44, 20), Qt.AlignmentFlag.AlignVCenter, title)
        top += height
        painter.setPen(look.colour("line"))
        painter.drawLine(QPointF(0, top - 0.5), QPointF(width, top - 0.5))
    painter.drawLine(QPointF(LABELS - 0.5, 0), QPointF(LABELS - 0.5, top))


def paint_blocks(
    painter: QPainter, shown: Composed, axis: Axis, height: int, thumbnail: Thumbnail, *, chosen: int, hovered: int
) -> None:
    """All blocks."""
    painter.save()
    painter.setClipRect(QRectF(LABELS, RULER, axis.width - LABELS, height))
    for index, block in enumerate(shown.blocks):
        left, right = box(block, axis)
        if right < LABELS or left > axis.width:
            continue
        room = QRectF(left, RULER + 4, max(right - left, 2), height - 8)
        if block.gap:
            _paint_gap(painter, room)
        else:
            picked = block.key == chosen >= 0
            _paint_block(painter, block, room, thumbnail, picked, index == hovered)
            if (picked or index == hovered) and repeatable(block, axis):
                _paint_repeats(painter, block, room)
    _paint_wraps(painter, shown, axis, height)
    painter.restore()


def _paint_gap(painter: QPainter, room: QRectF) -> None:
    look = theme.active()
    painter.setBrush(QBrush(look.colour("err", 36), Qt.BrushStyle.BDiagPattern))
    painter.setPen(QPen(look.colour("err"), 1.6, Qt.PenStyle.DashLine))
    painter.drawRoundedRect(room, 5, 5)


def _paint_block(
    painter: QPainter, block: Block, room: QRectF, thumbnail: Thumbnail, chosen: bool, hovered: bool
) -> None:
    look = theme.active()
    painter.setBrush(look.colour(block.colour, 96 if hovered else 70))
    painter.setPen(QPen(look.colour("text" if chosen else block.colour), 2.2 if chosen else 1.4))
    painter.drawRoundedRect(room, 5, 5)
    left = room.left() + 8
    if block.keys and room.width() >= 26:
        numbers = tuple(key + 1 for key in block.keys)
        paint_badge(painter, min(left + 10, room.center().x()), room.top() + min(16, room.height() / 2), numbers)
        left += 27 + 16 * (len(numbers) - 1)
    low = room.height() < 44
    face = fonts.font(fonts.CAPTION, QFont.Weight.DemiBold)
    times = f"  \N{MULTIPLICATION SIGN}{block.repeats}" if block.repeats > 1 else ""
    caption = f"{block.count} frames{times}"
    small = fonts.font(fonts.LANE)
    wide = QFontMetricsF(small).horizontalAdvance(caption)
    needed = max(QFontMetricsF(face).horizontalAdvance(block.name), wide)
    right = _paint_pictures(painter, block, room, left + needed + 8, thumbnail)
    if right - left < 18:
        return
    name = QFontMetricsF(face).elidedText(block.name, Qt.TextElideMode.ElideRight, right - left)
    painter.setFont(face)
    painter.setPen(look.colour("text"))
    painter.drawText(QRectF(left, room.top() + (3 if low else 6), right - left, 20), LEFT, name)
    covered = (chosen or hovered) and block.keys and block.cyclic and left + wide > room.right() - 3 * BUTTON - 14
    if not low and right - left >= wide and not covered:
        painter.setFont(small)
        painter.setPen(look.colour("text2"))
        painter.drawText(QRectF(left, room.top() + 25, right - left, 18), LEFT, caption)


def _paint_pictures(painter: QPainter, block: Block, room: QRectF, begin: float, thumbnail: Thumbnail) -> float:
    """The first pose after the words, the last one fainter at the end where there is room; gives where words end."""
    size = room.height() - 4
    ends = room.right() - size - 4
    if begin > ends + 12 or size < 30:
        return room.right() - 6
    sequence, first, last = block.picture
    places = [(min(begin, ends), first, 1.0)]
    if ends - places[0][0] > size + 34:
        places.append((ends, last, 0.45))
        look = theme.active()
        middle = room.center().y()
        painter.setPen(QPen(look.colour("text3"), 1))
        painter.drawLine(QPointF(places[0][0] + size + 6, middle), QPointF(ends - 6, middle))
        for side in (-4, 4):
            painter.drawLine(QPointF(ends - 6, middle), QPointF(ends - 11, middle + side))
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    for x, frame, opacity in places:
        image = thumbnail(sequence, frame)
        if image is not None and not image.isNull():
            painter.setOpacity(opacity)
            painter.drawImage(QRectF(x, room.top() + 2, size, size), image)
    painter.setOpacity(1.0)
    return places[0][0] - 4


def _paint_repeats(painter: QPainter, block: Block, room: QRectF) -> None:
    """How often it is played at least, with - and + beside."""
    look = theme.active()
    top, right = room.bottom() - BUTTON - 3, room.right()
    plate = QRectF(right - 3 * BUTTON - 12, top, 3 * BUTTON + 9, BUTTON)
    painter.setPen(QPen(look.colour("line2"), 1))
    painter.setBrush(look.colour("raised", 235))
    painter.drawRoundedRect(plate, 4, 4)
    painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.DemiBold))
    for text, x, on in (
        ("\N{MINUS SIGN}", right - 3 * BUTTON - 12, block.repeats > 1),
        (f"\N{MULTIPLICATION SIGN}{block.repeats}", right - 2 * BUTTON - 7.5, True),
        ("+", right - BUTTON - 3, True),
    ):
        painter.setPen(look.colour("text" if on else "line2"))
        painter.drawText(QRectF(x - 3, top, BUTTON + 6, BUTTON), Qt.AlignmentFlag.AlignCenter, text)


def _paint_wraps(painter: QPainter, shown: Composed, axis: Axis, height: int) -> None:
    """Where a repeated motion begins anew."""
    painter.setPen(QPen(theme.active().colour("text", 150), 1.4))
    for joint in shown.joints:
        if joint.kind == "wrap":
            x = axis.x(joint.position)
            for top in (RULER + 4, RULER + height - 13):
                painter.drawLine(QPointF(x, top), QPointF(x, top + 9))


def paint_costs(painter: QPainter, shown: Composed, axis: Axis, top: int, height: int, *, chosen: int) -> None:
    """A bar and its cost at each cut, and how far its step stands out as filmed, placed, and blended."""
    look = theme.active()
    painter.save()
    painter.setClipRect(QRectF(LABELS, top, axis.width - LABELS, height))
    base = top + height - 7.0
    painter.setPen(QPen(look.colour("line2", 120), 1))
    painter.drawLine(QPointF(axis.left, base), QPointF(axis.x(max(shown.count, 1)), base))
    cuts = [joint for joint in shown.joints if joint.kind != "wrap"]
    dear = max([joint.cost for joint in cuts], default=0.0)
    ends = [axis.x(joint.position) - (LOOPED if joint.kind == "loop" else 0) for joint in cuts[1:]]
    ends.append(float(axis.width))
    for joint, edge in zip(cuts, ends, strict=False):
        x = axis.x(joint.position) - (14 if joint.kind == "loop" else 0)
        tall = 4 + (height - 18) * min(joint.cost / dear, 1.0) if dear > 0 else 4
        bar = QRectF(x - 4.5, base - tall, 9, tall)
        painter.setPen(QPen(look.colour("text"), 1.6) if joint.number == chosen else Qt.PenStyle.NoPen)
        painter.setBrush(look.colour(tone(joint), 110 if joint.apart else 255))
        painter.drawRoundedRect(bar, 2, 2)
        if joint.apart:
            painter.setBrush(QBrush(look.colour(tone(joint)), Qt.BrushStyle.BDiagPattern))
            painter.drawRoundedRect(bar, 2, 2)
        _paint_words(painter, joint, x + 9, edge - 8, top, height)
    painter.restore()


def _paint_words(painter: QPainter, joint: Joint, left: float, right: float, top: int, height: int) -> None:
    look = theme.active()
    if joint.kind == "loop":
        left -= LOOPED - 14
    room = right - left if joint.kind != "loop" else LOOPED - 32
    for text, face, token, y in (
        (f"{joint.cost:.2f}", fonts.font(fonts.CAPTION, QFont.Weight.DemiBold), "text", top + 3.0),
        (steps(joint), fonts.font(fonts.LANE), "text3", top + 19.0),
    ):
        fits = QFontMetricsF(face).horizontalAdvance(text) <= room
        if text and (fits or y == top + 3.0) and room > 24 and y + 18 <= top + height:
            painter.setFont(face)
            painter.setPen(look.colour(token))
            painter.drawText(QRectF(left, y, max(room, 30.0), 18), LEFT, text)


def steps(joint: Joint) -> str:
    """The seam score as filmed, as placed and as blended, as far as they are known."""
    known = [value for value in (joint.before, joint.after, joint.blended) if value is not None]
    return " \N{RIGHTWARDS ARROW} ".join(f"{value:.1f}" for value in known)


def tone(joint: Joint) -> str:
    """The colour of a cut: amber where something is seen to jump; where it is a limb alone it is hatched besides."""
    if joint.score is None:
        return "accent"
    return "warn" if joint.seen or joint.apart else "ok"


def advice(joint: Joint) -> str:
    """What can be done about a cut; empty where nothing needs to be."""
    if joint.apart:
        blend = "Put" if joint.refused else "Switch Blend on, put"
        return f"The poses are far apart: a limb may jump. {blend} {OTHERWISE}."
    if joint.seen:
        longer = "Blend it longer" if joint.blended is not None else "Switch Blend on"
        return f"The step is seen. {longer}, put {OTHERWISE}."
    if joint.poor and joint.blended is not None:
        return "The poses are far apart; in-betweens bridge them: look whether they please."
    return ""


def told(joint: Joint) -> str:
    """What a cut is, for a tooltip."""
    kinds = {"cut": "Cut", "wrap": "Round", "loop": "Back to the start"}
    lines = [f"{kinds[joint.kind]}: {joint.names[0]} to {joint.names[1]}, cost {joint.cost:.2f}"]
    known = (("as filmed", joint.before), ("placed", joint.after), ("blended", joint.blended))
    words = [f"{value:.2f} {how}" for how, value in known if value is not None]
    if words:
        lines.append(f"Step {', '.join(words)}; 1 is the largest within the motions.")
    if joint.blended is not None:
        lines.append(f"{joint.frames} in-betweens.")
    if joint.hard:
        lines.append("It stays a hard cut.")
    if joint.reason:
        lines.append(joint.reason)
    if joint.kind == "cut" and (words := advice(joint)):
        lines.append(words)
    if joint.poor:
        lines.append("Nothing nearer leads there.")
    return "\n".join(lines)


def paint_insertion(painter: QPainter, x: float, height: int) -> None:
    """The line where a key motion would come to stand."""
    look = theme.active()
    painter.setPen(QPen(look.colour("accent"), 3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawLine(QPointF(x, RULER + 3), QPointF(x, RULER + height - 3))
