"""The structure of a sequence under the mouse: seek, choose, drag a boundary; only the playhead is drawn anew."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QHelpEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.window import theme
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
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.paint import paint_playhead, paint_ruler

SLACK = 3.0
SIDEWAYS, HAND = Qt.CursorShape.SizeHorCursor, Qt.CursorShape.PointingHandCursor


class StripView(QWidget):
    """``sought`` asks for a frame, ``chosen`` gives what was clicked, ``chosen_twice`` a texton clicked twice,
    ``moved`` a boundary's old and new frame at the end of a drag.
    """

    sought = Signal(int)
    chosen = Signal(object)
    chosen_twice = Signal(object)
    moved = Signal(int, int)
    menu_wanted = Signal(object, QPoint)

    def __init__(self) -> None:
        super().__init__()
        self.strip = Strip()
        self.axis = Axis(count=2)
        self.frame = -1
        self.boundary = -1
        self.span: Span | None = None
        self.drag: BoundaryDrag | None = None
        self._grab: float | None = None
        self._seeking = False
        self._still: QPixmap | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(HEIGHT)
        self.setAccessibleName("Structure of the sequence")

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

    def show_frame(self, frame: int) -> None:
        """Move the playhead, -1 for none; the lanes are not drawn again unless they have to scroll."""
        if frame == self.frame:
            return
        self.frame = frame
        if frame >= 0:
            self._set_axis(self.axis.showing(frame))
        self.update()

    def show_span(self, span: Span | None) -> None:
        """Mark the texton that is chosen."""
        self.span = span
        self.update()

    def refresh(self) -> None:
        """Draw the lanes anew at the next paint."""
        self._still = None
        self.update()

    def show_all(self) -> None:
        """Show the whole sequence."""
        self._set_axis(self.axis.whole())

    def zoom(self, factor: float) -> None:
        """Zoom in time round the playhead."""
        frame = max(self.frame, 0)
        self._set_axis(self.axis.showing(frame).zoomed(factor, self.axis.x(frame)))

    def _set_axis(self, axis: Axis) -> None:
        if axis != self.axis:
            self.axis = axis
            self.refresh()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the axis to the width."""
        self.axis = self.axis.sized(self.width(), self.axis.count)
        self.refresh()

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
        """Ask for what can be done here."""
        if self.strip.count and event.pos().x() >= LABELS:
            self.menu_wanted.emit(self.find(event.pos()), event.globalPos())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom in time at the mouse; scroll with Shift or sideways."""
        steps, sideways = event.angleDelta().y(), event.angleDelta().x()
        if sideways or event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._set_axis(self.axis.scrolled(-(sideways or steps) / 2))
        else:
            self._set_axis(self.axis.zoomed(1.0015**steps, event.position().x()))
        event.accept()

    def event(self, event: QEvent) -> bool:
        """Say why a motion is one."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self.words_at(event.pos()), self)
            return True
        return super().event(event)

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

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the kept picture of the lanes, and over it what moves."""
        ratio = self.devicePixelRatioF()
        if self._still is None or self._still.size() != self.size() * ratio:
            self._still = QPixmap(self.size() * ratio)
            self._still.setDevicePixelRatio(ratio)
            self._still.fill(theme.active().colour("panel"))
            painter = QPainter(self._still)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            paint_strip(painter, self.axis, self.strip)
            if self.strip.count:
                paint_ruler(painter, self.axis)
            painter.end()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.span is not None:
            paint_span(painter, self.axis, self.span)
        if self.boundary >= 0 and self.drag is None:
            paint_boundary(painter, self.axis, self.boundary, "accent")
        if self.drag is not None:
            paint_boundary(painter, self.axis, self.drag.new, "edit")
        if self.frame >= 0 and self.strip.count:
            paint_playhead(painter, self.axis, self.frame, HEIGHT)
        painter.end()
