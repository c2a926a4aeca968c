"""The composed timeline under mouse and keys: seek, choose, reorder, repeat, drop; only the playhead is drawn anew."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QHelpEvent,
    QImage,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.window import theme
from app.window.performance import blocks, composed_paint
from app.window.performance.blocks import (
    COMPOSED,
    COSTS,
    LOW,
    LOW_COSTS,
    Composed,
    ComposedHit,
    found_at,
    key_place,
    place_x,
)
from app.window.timeline.axis import Axis
from app.window.timeline.lanes import RULER
from app.window.timeline.paint import paint_playhead, paint_ruler

SLACK = 5.0
HAND = Qt.CursorShape.PointingHandCursor
CURSORS = {"more": HAND, "fewer": HAND, "joint": HAND, "block": HAND}


class ComposedView(QWidget):
    """Ruler, blocks and costs. Places among the key motions are counted from 0, -1 is none.

    ``chosen_key`` and ``chosen_cut`` say what was clicked, ``reordered`` from where to where, ``repeated`` a place and
    a step, ``keyed`` asks that the motion of a block, by its number, becomes a key motion. ``crossing`` gives the
    number of the cut under the mouse and a global place, -1 where there is none.
    """

    sought = Signal(int)
    chosen_key = Signal(int)
    chosen_cut = Signal(int)
    reordered = Signal(int, int)
    repeated = Signal(int, int)
    keyed = Signal(int)
    menu_wanted = Signal(object, QPoint)
    moved = Signal()
    crossing = Signal(int, QPoint)

    def __init__(self) -> None:
        super().__init__()
        self.shown = Composed()
        self.axis = Axis(count=2)
        self.position = 0
        self.key, self.cut, self.hover = -1, -1, -1
        self.insertion = self.joint = -1
        self.thumbnail: Callable[[str, int], QImage | None] = lambda sequence, frame: None
        self._still: QPixmap | None = None
        self._pressed: tuple[ComposedHit, float] | None = None
        self._dragging = self._seeking = False
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.heights = (COMPOSED, COSTS)
        self.setFixedHeight(RULER + COMPOSED + COSTS)
        self.setAccessibleName("Composed performance")

    def sizeHint(self) -> QSize:
        """As high as its lanes."""
        return QSize(800, RULER + sum(self.heights))

    def show_low(self, low: bool) -> None:
        """Show lower lanes, where the window is low."""
        heights = (LOW, LOW_COSTS) if low else (COMPOSED, COSTS)
        if heights != self.heights:
            self.heights = heights
            self.setFixedHeight(RULER + sum(heights))
            self.refresh()

    # showing -----------------------------------------------------------------------------------------------------

    def show_composed(self, shown: Composed) -> None:
        """Show another performance."""
        if shown != self.shown:
            self.shown = shown
            self.axis = self.axis.sized(self.width(), shown.count + 1)
            self.refresh()

    def show_position(self, position: int) -> None:
        """Move the playhead; the lanes are not drawn again unless they have to scroll."""
        if position != self.position:
            self.position = position
            self._set_axis(self.axis.showing(position))
            self.update()

    def show_choice(self, key: int, cut: int) -> None:
        """Mark the chosen key motion and cut."""
        if (key, cut) != (self.key, self.cut):
            self.key, self.cut = key, cut
            self.refresh()

    def show_insertion(self, place: int) -> None:
        """Show where a key motion would come to stand; -1 ends it."""
        if place != self.insertion:
            self.insertion = place
            self.update()

    def refresh(self) -> None:
        """Draw the lanes anew at the next paint."""
        self._still = None
        self.update()
        self.moved.emit()

    def _set_axis(self, axis: Axis) -> None:
        if axis != self.axis:
            self.axis = axis
            self.refresh()

    def show_all(self) -> None:
        """Show the whole performance."""
        self._set_axis(self.axis.whole())

    def zoom(self, factor: float) -> None:
        """Zoom in time round the playhead."""
        self._set_axis(self.axis.showing(self.position).zoomed(factor, self.axis.x(self.position)))

    def place_at(self, where: QPoint) -> int:
        """Before which key motion a global place lies; -1 where it is not over the blocks."""
        place = self.mapFromGlobal(where)
        if not self.rect().contains(place):
            return -1
        return key_place(self.shown, self.axis, place.x())

    def cancel(self) -> bool:
        """Give up the drag under way; says whether there was one."""
        was, self._pressed, self._dragging = self._dragging, None, False
        self.show_insertion(-1)
        return was

    def changeEvent(self, event: QEvent) -> None:
        """Take another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.StyleChange:
            self.refresh()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the axis to the width."""
        self.axis = self.axis.sized(self.width(), self.shown.count + 1)
        self.refresh()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the kept picture of the lanes and the playhead over it."""
        ratio = self.devicePixelRatioF()
        if self._still is None or self._still.size() != self.size() * ratio:
            self._still = QPixmap(self.size() * ratio)
            self._still.setDevicePixelRatio(ratio)
            self._paint_still()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.insertion >= 0:
            composed_paint.paint_insertion(painter, place_x(self.shown, self.axis, self.insertion), self.heights[0])
        if self.shown.count > 1 and not any(block.gap for block in self.shown.blocks):
            paint_playhead(painter, self.axis, self.position, self.height())
        painter.end()

    def _paint_still(self) -> None:
        assert self._still is not None
        self._still.fill(theme.active().colour("panel"))
        painter = QPainter(self._still)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.shown.count:
            paint_ruler(painter, self.axis)
        composed_paint.paint_blocks(
            painter, self.shown, self.axis, self.heights[0], self.thumbnail, chosen=self.key, hovered=self.hover
        )
        top, height = RULER + self.heights[0], self.heights[1]
        composed_paint.paint_costs(painter, self.shown, self.axis, top, height, chosen=self.cut)
        composed_paint.paint_labels(painter, self.width(), self.heights)
        painter.end()

    # mouse -------------------------------------------------------------------------------------------------------

    def _find(self, x: float, y: float) -> ComposedHit:
        return found_at(self.shown, self.axis, x, y, self.heights[0])

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Seek, choose what was hit, or take hold of a key motion."""
        if event.button() != Qt.MouseButton.LeftButton or not self.shown.blocks:
            return
        found = self._find(event.position().x(), event.position().y())
        self._pressed, self._dragging = (found, event.position().x()), False
        self._seeking = found.kind in ("ruler", "empty")
        if found.kind in ("more", "fewer"):
            self.repeated.emit(self.shown.blocks[found.index].key, 1 if found.kind == "more" else -1)
            return
        if found.kind == "joint":
            self.chosen_cut.emit(found.index)
        elif found.kind == "block":
            self.chosen_key.emit(self.shown.blocks[found.index].key)
        if found.kind not in ("label", "gap"):
            self.sought.emit(found.frame)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Scrub or carry what is held; else show what could be done."""
        x, y = event.position().x(), event.position().y()
        if self._seeking:
            self.sought.emit(self._find(x, RULER / 2).frame)
            return
        if self._pressed is not None:
            found, begun = self._pressed
            key = self.shown.blocks[found.index].key if found.kind == "block" else -1
            if key >= 0 and (self._dragging or abs(x - begun) >= SLACK):
                self._dragging = True
                self.setCursor(Qt.CursorShape.ClosedHandCursor)
                self.show_insertion(key_place(self.shown, self.axis, x))
            return
        found = self._find(x, y)
        self._cross(found.index if found.kind == "joint" else -1, event.globalPosition().toPoint())
        hover = found.index if found.kind in ("block", "more", "fewer") else -1
        if hover != self.hover:
            self.hover = hover
            self._still = None
            self.update()
        self.setCursor(CURSORS.get(found.kind, Qt.CursorShape.ArrowCursor))

    def _cross(self, joint: int, where: QPoint) -> None:
        if joint != self.joint:
            self.joint = joint
            self.crossing.emit(joint, where)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go: what was carried stands at its new place."""
        pressed, dragging, place = self._pressed, self._dragging, self.insertion
        self._seeking = False
        self.cancel()
        self.setCursor(Qt.CursorShape.ArrowCursor)
        if dragging and pressed is not None and place >= 0:
            key = self.shown.blocks[pressed[0].index].key
            to = place - 1 if place > key else place
            if to != key:
                self.reordered.emit(key, to)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Make a motion on the way a key motion; on the ruler show everything."""
        found = self._find(event.position().x(), event.position().y())
        if found.kind == "ruler":
            self.show_all()
        elif found.kind in ("more", "fewer"):
            self.mousePressEvent(event)
        elif found.kind == "block" and not self.shown.blocks[found.index].keys:
            self.keyed.emit(found.index)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom in time at the mouse; scroll with Shift or sideways."""
        steps, sideways = event.angleDelta().y(), event.angleDelta().x()
        if sideways or event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._set_axis(self.axis.scrolled(-(sideways or steps) / 2))
        else:
            self._set_axis(self.axis.zoomed(1.0015**steps, event.position().x()))
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse any more."""
        self._cross(-1, QPoint())
        if self.hover >= 0:
            self.hover = -1
            self.refresh()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of what was hit."""
        self.menu_wanted.emit(self._find(event.pos().x(), event.pos().y()), event.globalPos())

    def event(self, event: QEvent) -> bool:
        """Say what a block is."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            found = self._find(event.pos().x(), event.pos().y())
            QToolTip.showText(event.globalPos(), self._of_block(found), self)
            return True
        return super().event(event)

    def _of_block(self, found: ComposedHit) -> str:
        if found.kind not in ("block", "more", "fewer"):
            return ""
        block = self.shown.blocks[found.index]
        what = f"{block.name}: {block.count} frames"
        if block.keys:
            return f"{what}. Drag it to another place; Delete removes it."
        return f"{what}, on the way. Double-click makes it a key motion."

    def gap_room(self) -> tuple[float, float] | None:
        """Left and right end of the gap in pixels, None where there is none."""
        gaps = [block for block in self.shown.blocks if block.gap]
        return blocks.box(gaps[0], self.axis) if gaps else None
