"""The structure of a sequence under the mouse: seek, choose, drag a boundary; only the playhead is drawn anew."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QMouseEvent, QPainter

from app.window.performance.keyed_view import PLAIN
from app.window.performance.strip import (
    HEIGHT,
    BoundaryDrag,
    Span,
    Strip,
    StripHit,
    boundary_frame,
    drag_of,
    found_at,
)
from app.window.performance.strip_paint import paint_boundary, paint_span, paint_strip
from app.window.performance.time_view import TimeView
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER
from app.window.timeline.paint import paint_playhead, paint_ruler

SLACK = 3.0
SIDEWAYS, HAND = Qt.CursorShape.SizeHorCursor, Qt.CursorShape.PointingHandCursor


class StripView(TimeView):
    """Lanes of motions and textons. ``chosen`` gives what was clicked, ``chosen_twice`` a texton clicked twice,
    ``moved`` a boundary's old and new frame at the end of a drag.
    """

    chosen = Signal(object)
    chosen_twice = Signal(object)
    moved = Signal(int, int)
    menu_wanted = Signal(object, QPoint)

    def __init__(self) -> None:
        super().__init__("Structure of the sequence")
        self.strip = Strip()
        self.boundary = -1
        self.span: Span | None = None
        self.drag: BoundaryDrag | None = None
        self._grab: float | None = None
        self._seeking = False
        self.setFixedHeight(HEIGHT)
        for step, texton, boundary in (
            (-1, Qt.Key.Key_Up, Qt.Key.Key_PageUp),
            (1, Qt.Key.Key_Down, Qt.Key.Key_PageDown),
        ):
            self.keys[PLAIN, texton] = lambda step=step: self._next_texton(step)  # type: ignore[misc]
            self.keys[PLAIN, boundary] = lambda step=step: self.next_boundary(step)  # type: ignore[misc]
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.keys[PLAIN, key] = lambda: self.chosen_twice.emit(self._here("texton"))

    def sizeHint(self) -> QSize:
        """As high as its lanes."""
        return QSize(800, HEIGHT)

    # showing -----------------------------------------------------------------------------------------------------

    def show_strip(self, strip: Strip) -> None:
        """Show another structure; the axis stays where the length does."""
        self.strip = strip
        if strip.count + 1 != self.axis.count:
            self.axis = Axis().sized(self.width(), strip.count + 1)
        if self.boundary not in strip.boundaries:
            self.boundary = -1
        self.drag = None
        self.refresh()

    def show_span(self, span: Span | None) -> None:
        """Mark the texton that is chosen."""
        self.span = span
        self.update()

    # keys --------------------------------------------------------------------------------------------------------

    def _here(self, kind: Literal["texton", "boundary"]) -> StripHit:
        """What the keys mean: the boundary that is chosen, or the texton under the playhead."""
        frame = self.boundary if kind == "boundary" else max(self.frame, 0)
        motion = self.strip.motion_at(frame)
        texton = self.strip.motions[motion].texton_at(frame) if motion >= 0 else -1
        return StripHit(kind if kind == "boundary" or texton >= 0 else "motion", frame, motion, texton)

    def _next(self, frames: Sequence[int], here: int, step: int) -> int | None:
        beyond = [frame for frame in frames if (frame - here) * step > 0]
        return (min(beyond) if step > 0 else max(beyond)) if beyond else None

    def _next_texton(self, step: int) -> None:
        """Choose the texton that begins next, or the one before."""
        starts = [first for motion in self.strip.motions for first, _ in motion.textons]
        found = self._next(starts, self.frame, step)
        if found is not None:
            self.boundary = -1
            self.sought.emit(found)
            self.chosen.emit(self._here("texton"))
            self.update()

    def next_boundary(self, step: int) -> None:
        """Choose the next boundary, or the one before: Ctrl with the arrows moves it then, Delete takes it away."""
        found = self._next(self.strip.boundaries, self.boundary if self.boundary >= 0 else self.frame, step)
        if found is not None:
            self.boundary = found
            self.sought.emit(found)
            self.chosen.emit(self._here("boundary"))
            self.update()

    # mouse -------------------------------------------------------------------------------------------------------

    def find(self, place: QPoint) -> StripHit:
        """What lies at a place."""
        return found_at(self.strip, self.axis, float(place.x()), float(place.y()))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of a boundary, or seek."""
        if not self.strip.count or event.button() != Qt.MouseButton.LeftButton:
            return
        found = self.find(event.position().toPoint())
        if found.kind == "label":
            return
        self.boundary = found.frame if found.kind == "boundary" else -1
        if found.kind == "boundary":
            self._grab = event.position().x()
        else:
            self._seeking = True
            self.sought.emit(found.frame)
        self.chosen.emit(found)
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Carry the boundary along, scrub, or say what can be taken hold of."""
        x = event.position().x()
        if self._grab is not None:
            if self.drag is None and abs(x - self._grab) >= SLACK:
                self.drag = drag_of(self.strip, self.boundary)
            if self.drag is not None:
                self.drag = self.drag.to(boundary_frame(self.axis, x))
                self.update()
        elif self._seeking:
            self.sought.emit(found_at(self.strip, self.axis, max(x, LABELS), 0).frame)
        else:
            kind = self.find(event.position().toPoint()).kind if self.strip.count else "label"
            cursor = SIDEWAYS if kind == "boundary" else HAND if kind == "texton" else Qt.CursorShape.ArrowCursor
            self.setCursor(cursor)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Put the boundary down."""
        drag, self._grab, self._seeking = self.drag, None, False
        if drag is not None and drag.new != drag.old:
            self.boundary = drag.new
            self.moved.emit(drag.old, drag.new)
        elif drag is not None:
            self.drag = None
            self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Keep another texton; the whole sequence by the ruler."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        found = self.find(event.position().toPoint())
        if found.kind == "ruler":
            self.show_all()
        elif found.texton >= 0:
            self.chosen_twice.emit(found)

    def cancel(self) -> bool:
        """Let the boundary that is held go back; says whether there was one."""
        was = self._grab is not None
        self.drag = self._grab = None
        self.update()
        return was

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for what can be done here; by the keyboard with the boundary that is chosen, or under the playhead."""
        if not self.strip.count:
            return
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            found = self._here("boundary" if self.boundary >= 0 else "texton")
            place = QPoint(round(self.axis.x(found.frame)), RULER + 20)
            self.menu_wanted.emit(found, self.mapToGlobal(place))
        elif event.pos().x() >= LABELS:
            self.menu_wanted.emit(self.find(event.pos()), event.globalPos())

    def words_at(self, place: QPoint) -> str:
        """What is to be said of what lies at a place; empty for nothing."""
        if not self.strip.count:
            return ""
        found = self.find(place)
        if found.motion < 0:
            return ""
        motion = self.strip.motions[found.motion]
        if found.kind == "boundary":
            return f"{motion.name} begins at frame {motion.first}. {motion.reason} Drag to move it."
        lines = [f"{motion.name}: frames {motion.first} to {motion.last}. {motion.reason}"]
        if found.texton >= 0 and found.kind == "texton":
            first, last = motion.textons[found.texton]
            kept = "kept in the database" if found.texton == motion.kept else "double-click to keep this one"
            lines.append(f"Texton {found.texton + 1} of {len(motion.textons)}: frames {first} to {last}, {kept}.")
        elif found.kind == "curve" and self.strip.curve is not None:
            value = float(self.strip.curve[found.frame])
            lines = [f"Frame {found.frame}: {value:.3f} from the first atom of its texton."]
        return "\n".join(lines)

    # drawing -----------------------------------------------------------------------------------------------------

    def paint_still(self, painter: QPainter) -> None:
        """Draw ruler and lanes."""
        paint_strip(painter, self.axis, self.strip)
        if self.strip.count:
            paint_ruler(painter, self.axis)

    def paint_over(self, painter: QPainter) -> None:
        """Draw what is chosen or held, and the playhead."""
        if self.span is not None:
            paint_span(painter, self.axis, self.span)
        if self.boundary >= 0 and self.drag is None:
            paint_boundary(painter, self.axis, self.boundary, "accent")
        if self.drag is not None:
            paint_boundary(painter, self.axis, self.drag.new, "edit")
        if self.frame >= 0 and self.strip.count:
            paint_playhead(painter, self.axis, self.frame, HEIGHT)
