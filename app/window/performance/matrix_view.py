"""The self-similarity matrix under the mouse: look up two moments, seek, drag a boundary along either side."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFont, QImage, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QSizePolicy

from app.window import fonts, theme
from app.window.canvas import marks
from app.window.performance.keyed_view import PLAIN, SHIFT, KeyedView
from app.window.performance.strip import BoundaryDrag, Strip, drag_of

UNDER = QColor(13, 15, 18, 110)
EDGE, MARGIN, GRAB = 12.0, 10.0, 5.0
MARK, HELD = "#FFFFFF", "#FFA94D"
"""Boundaries are drawn over the matrix's own colours, whatever the look."""
ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, -1),
    Qt.Key.Key_Down: (0, 1),
}


@dataclass(frozen=True)
class Window:
    """Which square of the matrix is seen: frames from ``first`` on, so many of them; and where it lies (left, top,
    side in pixels).
    """

    first: tuple[float, float] = (0.0, 0.0)
    many: float = 1.0
    left: float = 0.0
    top: float = 0.0
    side: float = 1.0

    def place(self, frame: float, axis: int) -> float:
        """Where a frame begins: axis 0 across, 1 down."""
        return (self.left, self.top)[axis] + (frame - self.first[axis]) * self.side / self.many

    def frame(self, place: float, axis: int) -> float:
        """The frame at a place, with its fraction."""
        return self.first[axis] + (place - (self.left, self.top)[axis]) * self.many / self.side

    @property
    def box(self) -> QRectF:
        """The square on the widget."""
        return QRectF(self.left, self.top, self.side, self.side)


def window_of(size: tuple[int, int], count: int, first: tuple[float, float], many: float) -> Window:
    """The largest square that fits a widget, with room for the motions' colours at its left and top."""
    side = max(min(size[0], size[1]) - EDGE - 2 * MARGIN, 20.0)
    left, top = (size[0] - side + EDGE) / 2, (size[1] - side + EDGE) / 2
    many = min(max(many, min(8.0, count)), max(count, 1))
    latest = count - many
    x, y = (min(max(value, 0.0), latest) for value in first)
    return Window((x, y), many, left, top, side)


class MatrixView(KeyedView):
    """``sought`` asks for a frame, ``moved`` gives a boundary's old and new frame at the end of a drag, ``stepped``
    asks for the next boundary (1) or the one before (-1).

    boundary : the one that is chosen, -1 for none.
    """

    sought = Signal(int)
    stepped = Signal(int)
    moved = Signal(int, int)

    def __init__(self) -> None:
        super().__init__("Self-similarity of the sequence")
        self.strip = Strip()
        self.picture = QImage()
        self.frame = self.boundary = -1
        self.drag: BoundaryDrag | None = None
        self.distance = lambda one, other: float("nan")
        self._first, self._many = (0.0, 0.0), 1e9
        self._grab: tuple[int, int] | None = None
        self._pan: QPointF | None = None
        self._mouse: tuple[int, int] | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(200, 200)
        for held, frames in ((PLAIN, 1), (SHIFT, 10)):
            for key, (across, down) in ARROWS.items():
                step = (across * frames, down * frames)
                self.keys[held, key] = lambda step=step: self._point(*step)  # type: ignore[misc]
        self.keys[PLAIN, Qt.Key.Key_PageUp] = lambda: self.stepped.emit(-1)
        self.keys[PLAIN, Qt.Key.Key_PageDown] = lambda: self.stepped.emit(1)
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.keys[PLAIN, key] = lambda: self._mouse is not None and self.sought.emit(self._mouse[0])

    @property
    def window_(self) -> Window:
        """What is seen now."""
        return window_of((self.width(), self.height()), max(self.strip.count, 1), self._first, self._many)

    def show_matrix(self, picture: QImage, strip: Strip) -> None:
        """Show another matrix, or other motions over the same one."""
        if strip.count != self.strip.count:
            self.show_all()
        self.picture, self.strip, self.drag = picture, strip, None
        self.update()

    def show_frame(self, frame: int) -> None:
        """Mark the playhead, -1 for none."""
        if frame != self.frame:
            self.frame = frame
            self.update()

    def show_boundary(self, boundary: int) -> None:
        """Mark the boundary that is chosen, -1 for none."""
        if boundary != self.boundary:
            self.boundary = boundary
            self.update()

    def _point(self, across: int, down: int) -> None:
        """Look two moments up by the keys, from the playhead on."""
        last = self.strip.count - 1
        if last >= 0:
            one, other = self._mouse or (max(self.frame, 0), max(self.frame, 0))
            self._mouse = (min(max(one + across, 0), last), min(max(other + down, 0), last))
            self.update()

    def show_all(self) -> None:
        """Show the whole matrix."""
        self._first, self._many = (0.0, 0.0), 1e9
        self.update()

    # mouse -------------------------------------------------------------------------------------------------------

    def boundary_at(self, x: float, y: float) -> tuple[int, int] | None:
        """A boundary's frame and the axis along which it is held; None for none within reach."""
        seen = self.window_
        near = [
            (abs(seen.place(frame, axis) - (x, y)[axis]), frame, axis)
            for frame in self.strip.boundaries
            for axis in (0, 1)
        ]
        best = min(near, default=None)
        inside = seen.box.adjusted(-EDGE, -EDGE, GRAB, GRAB).contains(QPointF(x, y))
        return (best[1], best[2]) if best is not None and best[0] <= GRAB and inside else None

    def frames_at(self, x: float, y: float) -> tuple[int, int] | None:
        """The two moments at a place: across and down."""
        seen = self.window_
        if not self.strip.count or not seen.box.contains(QPointF(x, y)):
            return None
        last = self.strip.count - 1
        return min(int(seen.frame(x, 0)), last), min(int(seen.frame(y, 1)), last)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of a boundary, seek, or move what is seen."""
        x, y = event.position().x(), event.position().y()
        if event.button() == Qt.MouseButton.MiddleButton:
            self._pan = event.position()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._grab = self.boundary_at(x, y)
            found = self.frames_at(x, y)
            if self._grab is not None:
                self.drag = drag_of(self.strip, self._grab[0])
            elif found is not None:
                self.sought.emit(found[0])
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Carry the boundary along, or look two moments up."""
        place = event.position()
        if self._pan is not None:
            step, self._pan = place - self._pan, place
            seen = self.window_
            share = seen.many / seen.side
            self._first = (seen.first[0] - step.x() * share, seen.first[1] - step.y() * share)
        elif self._grab is not None and self.drag is not None:
            axis = self._grab[1]
            self.drag = self.drag.to(round(self.window_.frame((place.x(), place.y())[axis], axis)))
        else:
            held = self.boundary_at(place.x(), place.y())
            shapes = (Qt.CursorShape.SizeHorCursor, Qt.CursorShape.SizeVerCursor)
            self.setCursor(Qt.CursorShape.CrossCursor if held is None else shapes[held[1]])
            self._mouse = self.frames_at(place.x(), place.y())
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Put the boundary down."""
        drag, self._grab, self._pan = self.drag, None, None
        if drag is not None and drag.new != drag.old:
            self.moved.emit(drag.old, drag.new)
        else:
            self.drag = None
        self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Show the whole matrix."""
        self.show_all()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom at the mouse."""
        seen, place = self.window_, event.position()
        at = seen.frame(place.x(), 0), seen.frame(place.y(), 1)
        many = min(max(seen.many / 1.0015 ** event.angleDelta().y(), 8.0), float(max(self.strip.count, 1)))
        share = many / seen.side
        self._first = (at[0] - (place.x() - seen.left) * share, at[1] - (place.y() - seen.top) * share)
        self._many = many
        self._first = self.window_.first
        self.update()
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse."""
        self._mouse = None
        self.update()

    def cancel(self) -> bool:
        """Let the boundary that is held go back; says whether there was one."""
        was = self._grab is not None
        self.drag = self._grab = None
        self.update()
        return was

    def words_at(self, place: QPoint) -> str:
        """What is to be said of a place; empty for nothing."""
        found = self.frames_at(place.x(), place.y())
        if found is None:
            return ""
        one, other = found
        lines = [f"Frames {one} and {other}: {self.distance(one, other):.3f} apart."]
        for frame in dict.fromkeys((one, other)):
            number = self.strip.motion_at(frame)
            if number >= 0 and all(self.strip.motions[number].name not in line for line in lines):
                motion = self.strip.motions[number]
                lines.append(f"{motion.name}, frames {motion.first} to {motion.last}: {motion.reason}")
        return "\n".join(lines)

    # drawing -----------------------------------------------------------------------------------------------------

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the matrix, the motions' colours at its sides, boundaries, playhead, and what the mouse points at."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        seen, count = self.window_, self.strip.count
        if not count or self.picture.isNull():
            painter.end()
            return
        scale = self.picture.width() / count
        source = QRectF(seen.first[0] * scale, seen.first[1] * scale, seen.many * scale, seen.many * scale)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, seen.side < source.width())
        painter.drawImage(seen.box, self.picture, source)
        painter.setClipRect(seen.box.adjusted(-EDGE, -EDGE, 0, 0))
        self._motions(painter, seen)
        for frame in self.strip.boundaries:
            held = self.drag is not None and self.drag.old == frame
            shown = self.drag.new if held and self.drag is not None else frame
            token = HELD if held else "accent" if frame == self.boundary else MARK
            self._lines(painter, seen, shown, QPen(theme.active().colour(token), 1.2 if token == MARK else 2.0))
        if self.frame >= 0:
            self._lines(painter, seen, self.frame + 0.5, QPen(theme.active().colour("accent"), 1.4))
        painter.setClipping(False)
        if self.drag is not None:
            self._plate(painter, seen, f"frame {self.drag.new}")
        elif self._mouse is not None:
            one, other = self._mouse
            self._plate(painter, seen, f"{one} and {other}: {self.distance(one, other):.3f}")
            if self.ringed:
                self._cross(painter, seen, one, other)
        self.paint_ring(painter)
        painter.end()

    def _cross(self, painter: QPainter, seen: Window, one: int, other: int) -> None:
        """Where the keys point."""
        place = QPointF(seen.place(one + 0.5, 0), seen.place(other + 0.5, 1))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for pen in (QPen(UNDER, 4.0), QPen(theme.active().colour(MARK), 1.6)):
            painter.setPen(pen)
            painter.drawEllipse(place, 5.0, 5.0)

    def _motions(self, painter: QPainter, seen: Window) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        for motion in self.strip.motions:
            painter.setBrush(theme.active().colour(motion.colour))
            x, y = seen.place(motion.first, 0), seen.place(motion.first, 1)
            length = (motion.last + 1 - motion.first) * seen.side / seen.many
            painter.drawRect(QRectF(x, seen.top - EDGE, length - 1, EDGE - 4))
            painter.drawRect(QRectF(seen.left - EDGE, y, EDGE - 4, length - 1))

    def _lines(self, painter: QPainter, seen: Window, frame: float, pen: QPen) -> None:
        x, y = seen.place(frame, 0), seen.place(frame, 1)
        for each in (QPen(UNDER, pen.widthF() + 1.6), pen):
            painter.setPen(each)
            painter.drawLine(QPointF(x, seen.top - EDGE), QPointF(x, seen.box.bottom()))
            painter.drawLine(QPointF(seen.left - EDGE, y), QPointF(seen.box.right(), y))

    def _plate(self, painter: QPainter, seen: Window, text: str) -> None:
        face = fonts.font(fonts.CAPTION, QFont.Weight.Medium)
        painter.setFont(face)
        marks.plate(
            painter, seen.box.right() - 8, seen.box.bottom() - 16, text, theme.active().colour("#E8EBEF"), align="right"
        )
