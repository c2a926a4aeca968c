"""The lanes as a widget: seek by the ruler, choose by click, zoom by the wheel; only the playhead is drawn anew."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPixmap, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import theme
from app.window.timeline import paint
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.drags import LaneDrag, LaneEdit, drag_from
from app.window.timeline.lanes import RULER, Lane, Placed, TimelineHit, fitted, hit, layout, total_height
from app.window.timeline.summary import summaries

HAND, SIDEWAYS = Qt.CursorShape.PointingHandCursor, Qt.CursorShape.SizeHorCursor
CURSORS = {"diamond": HAND, "label": HAND, "first": SIDEWAYS, "last": SIDEWAYS, "in": SIDEWAYS, "out": SIDEWAYS}


class LaneView(QWidget):
    """Ruler and lanes.

    ``sought`` asks for a frame, ``clicked``, ``chosen_twice`` (a double click) and ``menu_wanted`` say what was hit,
    ``edited`` gives a ``LaneEdit`` at the end of a drag.
    """

    sought = Signal(int)
    clicked = Signal(object)
    chosen_twice = Signal(object)
    edited = Signal(object)
    menu_wanted = Signal(object, object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.axis = Axis()
        self.frame = 0
        self.range: tuple[int, int] | None = None
        self.lanes: tuple[Lane, ...] = ()
        self.placed: tuple[Placed, ...] = ()
        self.thumbnail: paint.Thumbnail | None = None
        self.compact = False
        self.room = 10_000
        self._scrolled: dict[str, int] = {}
        self._still: QPixmap | None = None
        self._outdated: set[int] = set()
        self._seeking = False
        self._drag: LaneDrag | None = None
        self.preview: LaneEdit | None = None
        self.still_paints = 0
        self.lane_paints = 0
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)

    def show_lanes(self, lanes: Sequence[Lane], count: int) -> None:
        """Show other lanes of a clip of so many frames."""
        lanes = tuple(lanes)
        if lanes == self.lanes and count == self.axis.count:
            return
        self.lanes = lanes
        axis, self.axis = self.axis, self.axis.sized(self.width(), count)
        if axis != self.axis:
            self._still = None
        self._place()

    def show_compact(self, on: bool) -> None:
        """Show every lane in one line, or in full."""
        if on != self.compact:
            self.compact = on
            self._place()

    def show_room(self, room: int) -> None:
        """Show fewer rows of the lanes where they have less room, pixels, than they want."""
        if room != self.room:
            self.room = room
            self._place()

    def _place(self) -> None:
        before, lanes = self.placed, summaries(self.lanes) if self.compact else fitted(self.lanes, self.room)
        self.placed = layout(lanes, None if self.compact else self._scrolled)
        if self._still is not None and _alike(before, self.placed):
            self._renew({number for number, each in enumerate(self.placed) if each != before[number]})
            return
        if total_height(self.placed) != self.minimumHeight():
            self.setMinimumHeight(total_height(self.placed))
            self.updateGeometry()
        self.refresh()

    def _renew(self, numbers: set[int]) -> None:
        """Draw some lanes anew: while motion is solved one of them changes many times a second."""
        self._outdated |= numbers
        for number in numbers:
            self.update(0, self.placed[number].top, self.width(), self.placed[number].height)

    def show_frame(self, frame: int) -> None:
        """Move the playhead; the lanes are not drawn again unless they have to scroll."""
        if frame == self.frame:
            return
        self.frame = frame
        axis = self.axis.showing(frame)
        if axis != self.axis:
            self._set_axis(axis)
        self.update()

    def show_range(self, range_: tuple[int, int] | None) -> None:
        """Show the in and out frames."""
        if range_ != self.range:
            self.range = range_
            self.refresh()

    def refresh(self) -> None:
        """Draw the lanes anew at the next paint."""
        self._still = None
        self._outdated.clear()
        self.update()

    def _set_axis(self, axis: Axis) -> None:
        if axis != self.axis:
            self.axis = axis
            self.refresh()

    def show_all(self) -> None:
        """Show the whole clip."""
        self._set_axis(self.axis.whole())

    def sizeHint(self) -> QSize:
        """As high as the lanes."""
        return QSize(800, total_height(self.placed))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the axis to the width."""
        self.axis = self.axis.sized(self.width(), self.axis.count)
        self.refresh()

    def _find(self, event: QMouseEvent) -> TimelineHit | None:
        return hit(self.placed, self.axis, event.position().x(), event.position().y(), range_=self._ends())

    def _ends(self) -> tuple[int, int]:
        return self.range or (0, self.axis.count - 1)

    def cancel(self) -> bool:
        """Give up the drag under way; says whether there was one."""
        was, self._drag, self.preview = self._drag, None, None
        if was is not None:
            self.update()
        return was is not None

    def zoom(self, factor: float) -> None:
        """Zoom in time round the present frame."""
        self._set_axis(self.axis.showing(self.frame).zoomed(factor, self.axis.x(self.frame)))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Seek by the ruler or an empty place, choose what was hit."""
        found = self._find(event)
        if found is None:
            return
        if event.button() == Qt.MouseButton.RightButton:
            self.menu_wanted.emit(found, event.globalPosition().toPoint())
            return
        if event.button() != Qt.MouseButton.LeftButton:
            return
        self._drag = drag_from(found, self.placed, self._ends())
        self._seeking = self._drag is None and found.kind not in ("label", "diamond")
        if found.kind not in ("label", "in", "out"):
            self.sought.emit(found.frame)
        self.clicked.emit(found)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Scrub while the button is down; show that a diamond can be clicked."""
        if self._drag is not None:
            frame = self.axis.frame(event.position().x())
            self.preview = self._drag.edit(frame)
            if self._drag.kind != "range":
                self.sought.emit(frame)
            self.update()
            return
        if self._seeking:
            self.sought.emit(self.axis.frame(event.position().x()))
            return
        found = self._find(event)
        kind = found.kind if found is not None else ""
        self.setCursor(CURSORS.get(kind, Qt.CursorShape.ArrowCursor))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End scrubbing, or the drag: its change is asked for."""
        self._seeking = False
        edit = self.preview
        if self.cancel() and edit is not None:
            self.edited.emit(edit)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Show the whole clip by a double click on the ruler; elsewhere say what was chosen."""
        if event.position().y() < RULER:
            self.show_all()
        elif (found := self._find(event)) is not None:
            self.chosen_twice.emit(found)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom in time at the mouse; scroll with Shift or sideways; over many tracks scroll their rows."""
        steps, sideways = event.angleDelta().y(), event.angleDelta().x()
        x, y = event.position().x(), event.position().y()
        if sideways or event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._set_axis(self.axis.scrolled(-(sideways or steps) / 2))
        elif x < LABELS:
            self._scroll_rows(y, -1 if steps > 0 else 1)
        else:
            self._set_axis(self.axis.zoomed(1.0015**steps, x))
        event.accept()

    def _scroll_rows(self, y: float, step: int) -> None:
        for each in self.placed:
            lane = each.lane
            if each.top <= y < each.top + each.height and len(lane.rows) > lane.shown_rows:
                latest = len(lane.rows) - lane.shown_rows
                first = min(self._scrolled.get(lane.id, 0), latest)
                self._scrolled[lane.id] = min(max(first + step, 0), latest)
                self._place()

    def show_row(self, lane_id: str, row_id: str) -> None:
        """Scroll a lane so that a row is seen."""
        for lane in (each.lane for each in self.placed):
            index = next((number for number, row in enumerate(lane.rows) if row.id == row_id), None)
            if lane.id != lane_id or index is None:
                continue
            first = self._scrolled.get(lane_id, 0)
            if not first <= index < first + lane.shown_rows:
                self._scrolled[lane_id] = max(min(index, len(lane.rows) - lane.shown_rows), 0)
                self._place()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Leave the keys to the window."""
        event.ignore()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the kept picture of the lanes and the playhead over it."""
        ratio = self.devicePixelRatioF()
        if ratio % 1 and self._outdated:
            self._still = None  # where lanes end between pixels, one alone would leave seams
        if self._still is None or self._still.size() != self.size() * ratio:
            self._still = QPixmap(self.size() * ratio)
            self._still.setDevicePixelRatio(ratio)
            painter = QPainter(self._still)
            self._paint_still(painter, self.placed, ruler=True)
            painter.end()
            self.still_paints += 1
        elif self._outdated:
            painter = QPainter(self._still)
            for each in (self.placed[number] for number in sorted(self._outdated)):
                painter.setClipRect(0, each.top, self.width(), each.height)
                self._paint_still(painter, (each,))
                self.lane_paints += 1
            painter.end()
        self._outdated.clear()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.preview is not None:
            paint.paint_preview(painter, self.axis, self.placed, self.preview)
        if self.axis.count > 1:
            paint.paint_playhead(painter, self.axis, self.frame, min(total_height(self.placed), self.height()))
        painter.end()

    def _paint_still(self, painter: QPainter, placed: Sequence[Placed], *, ruler: bool = False) -> None:
        painter.fillRect(self.rect(), theme.active().colour("panel"))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint.paint_lanes(painter, self.axis, placed, self.thumbnail)
        if ruler:
            paint.paint_ruler(painter, self.axis)
        self._paint_range(painter)

    def _paint_range(self, painter: QPainter) -> None:
        if self.axis.count > 1:
            paint.paint_handles(painter, self.axis, self._ends(), self.range is not None)
        if self.range is None:
            return
        shade = theme.active().colour("canvas", 150)
        first, last = self.axis.x(self.range[0]), self.axis.x(self.range[1])
        painter.fillRect(LABELS, RULER, max(int(first) - LABELS, 0), self.height(), shade)
        painter.fillRect(int(last), RULER, max(self.width() - int(last), 0), self.height(), shade)


def _alike(before: Sequence[Placed], after: Sequence[Placed]) -> bool:
    """Whether the same lanes stand in the same places."""
    return [(each.lane.id, each.top, each.height) for each in before] == [
        (each.lane.id, each.top, each.height) for each in after
    ]
