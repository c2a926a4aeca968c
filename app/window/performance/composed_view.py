"""The composed timeline under mouse and keys: seek, choose, reorder, repeat, drop; only the playhead is drawn anew."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QImage, QMouseEvent, QPainter, QResizeEvent

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
from app.window.performance.keyed_view import PLAIN
from app.window.performance.time_view import TimeView
from app.window.timeline.lanes import RULER
from app.window.timeline.paint import paint_playhead, paint_ruler

SLACK = 5.0
HAND = Qt.CursorShape.PointingHandCursor
CURSORS = {"more": HAND, "fewer": HAND, "joint": HAND, "block": HAND}


class ComposedView(TimeView):
    """Ruler, blocks and costs. Places among the key motions are counted from 0, -1 is none.

    ``chosen`` gives the block, ``chosen_cut`` the cut that was clicked or reached by Up and Down, ``reordered`` from
    where to where, ``repeated`` a place and a step, ``keyed`` asks that the motion of a block, by its number, becomes a
    key motion. ``crossing`` gives the number of the cut under the mouse and a global place, -1 where there is none.
    """

    chosen = Signal(int)
    chosen_cut = Signal(int)
    reordered = Signal(int, int)
    repeated = Signal(int, int)
    keyed = Signal(int)
    menu_wanted = Signal(object, QPoint)
    moved = Signal()
    crossing = Signal(int, QPoint)

    def __init__(self) -> None:
        super().__init__("Composed performance")
        self.shown = Composed()
        self.frame = 0
        self.key, self.cut, self.hover = -1, -1, -1
        self.insertion = self.joint = -1
        self.thumbnail: Callable[[str, int], QImage | None] = lambda sequence, frame: None
        self._pressed: tuple[ComposedHit, float] | None = None
        self._dragging = self._seeking = False
        self.heights = (COMPOSED, COSTS)
        self.setFixedHeight(RULER + COMPOSED + COSTS)
        self.keys[PLAIN, Qt.Key.Key_Up] = lambda: self._next_block(-1)
        self.keys[PLAIN, Qt.Key.Key_Down] = lambda: self._next_block(1)
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.keys[PLAIN, key] = self._make_key

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
        super().refresh()
        self.moved.emit()

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

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the axis to the width."""
        self.axis = self.axis.sized(self.width(), self.shown.count + 1)
        super().resizeEvent(event)

    def paint_over(self, painter: QPainter) -> None:
        """Draw where something would be dropped, and the playhead."""
        if self.insertion >= 0:
            composed_paint.paint_insertion(painter, place_x(self.shown, self.axis, self.insertion), self.heights[0])
        if self.shown.count > 1 and not any(block.gap for block in self.shown.blocks):
            paint_playhead(painter, self.axis, self.frame, self.height())

    def paint_still(self, painter: QPainter) -> None:
        """Draw ruler, blocks and costs."""
        if self.shown.count:
            paint_ruler(painter, self.axis)
        composed_paint.paint_blocks(
            painter, self.shown, self.axis, self.heights[0], self.thumbnail, chosen=self.key, hovered=self.hover
        )
        top, height = RULER + self.heights[0], self.heights[1]
        composed_paint.paint_costs(painter, self.shown, self.axis, top, height, chosen=self.cut)
        composed_paint.paint_labels(painter, self.width(), self.heights)

    # keys --------------------------------------------------------------------------------------------------------

    def _block_here(self) -> int:
        """The block that the keys mean: under the playhead; without a path that of the chosen key motion."""
        order = self.shown.blocks
        if any(block.gap for block in order):
            return next((k for k, block in enumerate(order) if self.key in block.keys), -1)
        return next((k for k, block in enumerate(order) if block.first <= self.frame < block.first + block.count), -1)

    def _next_block(self, step: int) -> None:
        """Choose the block before or after, and the cut that leads into it."""
        here, order = self._block_here(), self.shown.blocks
        to = here if step < 0 <= here and order[here].first < self.frame else here + step
        while 0 <= to < len(order) and order[to].gap:
            to += step
        if 0 <= to < len(order):
            self.sought.emit(order[to].first)
            self.chosen.emit(to)
            cuts = [
                each.number for each in self.shown.joints if each.kind == "cut" and each.position == order[to].first
            ]
            self.chosen_cut.emit(cuts[0] if cuts else -1)

    def _make_key(self) -> None:
        """Make the motion under the playhead a key motion where it is only on the way."""
        here = self._block_here()
        if here >= 0 and not self.shown.blocks[here].keys:
            self.keyed.emit(here)

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
            self.chosen.emit(found.index)
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
            super().refresh()
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

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse any more."""
        self._cross(-1, QPoint())
        if self.hover >= 0:
            self.hover = -1
            self.refresh()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of what was hit; by the keyboard that of the block under the playhead."""
        if event.reason() != QContextMenuEvent.Reason.Keyboard:
            self.menu_wanted.emit(self._find(event.pos().x(), event.pos().y()), event.globalPos())
            return
        here = self._block_here()
        if here >= 0:
            left, _ = blocks.box(self.shown.blocks[here], self.axis)
            place = QPoint(round(left) + 12, RULER + self.heights[0] // 2)
            self.menu_wanted.emit(ComposedHit("block", self.frame, here), self.mapToGlobal(place))

    def words_at(self, place: QPoint) -> str:
        """Say what a block is, and what can be done with it."""
        found = self._find(place.x(), place.y())
        if found.kind not in ("block", "more", "fewer"):
            return ""
        block = self.shown.blocks[found.index]
        what = f"{block.name}: {block.count} frames"
        if block.keys:
            return f"{what}. Drag it to another place; Delete removes it."
        return f"{what}, on the way. Double-click or Enter makes it a key motion."

    def gap_room(self) -> tuple[float, float] | None:
        """Left and right end of the gap in pixels, None where there is none."""
        gaps = [block for block in self.shown.blocks if block.gap]
        return blocks.box(gaps[0], self.axis) if gaps else None
