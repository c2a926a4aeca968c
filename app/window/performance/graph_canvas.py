"""The motion graph under mouse and keys: choose, append, forbid, move and carry nodes, zoom and pan."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QContextMenuEvent, QImage, QMouseEvent, QPainter, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy

from app.window.performance import graph_paint as paint
from app.window.performance.graph_view import Lens, Picture, edge_at, fitted, following, neighbour, node_at
from app.window.performance.keyed_view import PLAIN, KeptView

SLACK = 4.0
BEAT = 80
"""Milliseconds a picture of a node that plays under the mouse."""
ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, -1),
    Qt.Key.Key_Down: (0, 1),
}


class GraphCanvas(KeptView):
    """Shows a ``Picture``; ``thumbnail(node, step)`` gives the picture of a node, ``step`` counts while it plays.

    ``carried`` and ``dropped`` give a node and a global place outside of the canvas, ``crossing`` the nodes of the
    transition under the mouse and its global place, -1 where there is none.
    """

    chosen = Signal(int)
    appended = Signal(int)
    hovered = Signal(int)
    crossing = Signal(int, int, QPoint)
    moved = Signal(int, float, float)
    carried = Signal(int, QPoint)
    dropped = Signal(int, QPoint)
    menu_wanted = Signal(int, QPoint)

    def __init__(self) -> None:
        super().__init__("Motion graph")
        self.picture = Picture()
        self.lens = Lens()
        self.node = self.hover = -1
        self.edge = (-1, -1)
        self.step = 0
        self._names: dict[int, QRectF] = {}
        self.thumbnail: Callable[[int, int], QImage | None] = lambda node, step: None
        self.told: Callable[[int, int], str] = lambda start, goal: ""
        self._fitting = True
        self._grabbed = -1
        self._panning = False
        self._pressed = QPointF()
        self._origin = (0.0, 0.0)
        self._dragging = False
        self._beat = QTimer(self)
        self._beat.setInterval(BEAT)
        self._beat.timeout.connect(self._play)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(240, 120)
        for key, way in ARROWS.items():
            self.keys[PLAIN, key] = lambda way=way: self.chosen.emit(neighbour(self.picture, self.node, *way))  # type: ignore[misc]
        self.keys[PLAIN, Qt.Key.Key_PageDown] = self.choose_next
        self.keys[PLAIN, Qt.Key.Key_PageUp] = lambda: self.choose_next(-1)
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.keys[PLAIN, key] = lambda: self.node >= 0 and self.appended.emit(self.node)

    def sizeHint(self) -> QSize:
        """As large as there is room."""
        return QSize(640, 400)

    # showing -----------------------------------------------------------------------------------------------------

    def show_picture(self, picture: Picture) -> None:
        """Show another picture of the graph."""
        if picture != self.picture:
            grown = {mark.node for mark in picture.nodes} != {mark.node for mark in self.picture.nodes}
            self.picture = picture
            if grown or (self._fitting and not self._dragging):
                self.fit()
        self.refresh()

    def show_node(self, node: int) -> None:
        """Mark a node as chosen, or none."""
        if node != self.node:
            self.node = node
            self.refresh()

    def fit(self) -> None:
        """Show everything."""
        self._fitting = True
        self.lens = fitted(self.picture, self.width(), self.height())
        self.refresh()

    def stop(self) -> None:
        """Let nothing play."""
        self._beat.stop()
        self._set_hover(-1)

    def cancel(self) -> bool:
        """Give up the drag under way; says whether there was one."""
        if self._grabbed < 0 or not self._dragging:
            return False
        node, self._grabbed, self._dragging = self._grabbed, -1, False
        self.moved.emit(node, *self._origin)
        self.unsetCursor()
        return True

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the whole graph in sight until the user has zoomed."""
        if self._fitting:
            self.fit()
        self.refresh()

    def paint_over(self, painter: QPainter) -> None:
        """Draw the node under the mouse, which may play."""
        mark = self.picture.mark(self.hover)
        if mark is not None:
            image = self.thumbnail(mark.node, self.step) or self.thumbnail(mark.node, 0)
            alone = replace(self.picture, nodes=(mark,))
            plate = self._names.get(mark.node) or paint.name_plates(alone, self.lens, mark.node)[mark.node]
            self._paint_mark(painter, mark, image, plate)

    def paint_still(self, painter: QPainter) -> None:
        """Draw the graph."""
        paint.paint_ground(painter, self.width(), self.height(), self.lens)
        paint.paint_groups(painter, self.picture.groups, self.lens)
        paint.paint_edges(painter, self.picture, self.lens, self.node)
        self._names = paint.name_plates(self.picture, self.lens, self.node)
        for mark in self.picture.nodes:
            image = self.thumbnail(mark.node, 0) if self.lens.size >= paint.PICTURED else None
            self._paint_mark(painter, mark, image, self._names.get(mark.node))
        paint.paint_group_names(painter, self.picture.groups, self.lens)
        paint.paint_costs(painter, self.picture, self.lens, self._names)

    def _paint_mark(self, painter: QPainter, mark: paint.NodeMark, image: QImage | None, name: QRectF | None) -> None:
        chosen, hovered = mark.node == self.node, mark.node == self.hover
        focus = self.hasFocus()
        paint.paint_node(painter, mark, self.lens, image, chosen=chosen, hovered=hovered, focus=focus, name=name)

    def _play(self) -> None:
        self.step += 1
        self.update()

    def _set_hover(self, node: int) -> None:
        if node == self.hover:
            return
        self.hover, self.step = node, 0
        self._beat.start() if node >= 0 else self._beat.stop()
        self.hovered.emit(node)
        self.update()

    # mouse -------------------------------------------------------------------------------------------------------

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a node and take hold of it; elsewhere take hold of the surface."""
        place = event.position()
        self._pressed, self._dragging = place, False
        mark = node_at(self.picture, self.lens, place.x(), place.y())
        if event.button() == Qt.MouseButton.LeftButton and mark is not None:
            self._grabbed, self._origin = mark.node, (mark.x, mark.y)
            self.chosen.emit(mark.node)
        elif event.button() in (Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton):
            self._panning = True

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move what is held; else play what is under the mouse."""
        place = event.position()
        if self._grabbed >= 0 or self._panning:
            if not self._dragging and (place - self._pressed).manhattanLength() < SLACK:
                return
            self._drag(place, event.globalPosition().toPoint())
            return
        mark = node_at(self.picture, self.lens, place.x(), place.y())
        self._set_hover(mark.node if mark is not None else -1)
        self._cross(place, mark is None, event.globalPosition().toPoint())
        self.setCursor(Qt.CursorShape.PointingHandCursor if mark is not None else Qt.CursorShape.ArrowCursor)

    def _cross(self, place: QPointF, free: bool, where: QPoint) -> None:
        """Say which transition is under the mouse."""
        found = edge_at(self.picture, self.lens, place.x(), place.y()) if free else None
        edge = (found.start, found.goal) if found is not None else (-1, -1)
        if edge != self.edge:
            self.edge = edge
            self.crossing.emit(*edge, where)

    def _drag(self, place: QPointF, where: QPoint) -> None:
        if self._panning:
            before = self._pressed
            self._pressed, self._dragging, self._fitting = place, True, False
            self.lens = self.lens.moved(place.x() - before.x(), place.y() - before.y())
            self.refresh()
            return
        self._dragging = True
        self._set_hover(-1)
        if self.rect().contains(place.toPoint()):
            dx, dy = place.x() - self._pressed.x(), place.y() - self._pressed.y()
            self.moved.emit(
                self._grabbed, self._origin[0] + dx / self.lens.across, self._origin[1] + dy / self.lens.down
            )
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
        else:
            self.moved.emit(self._grabbed, *self._origin)
            self.setCursor(Qt.CursorShape.DragCopyCursor)
        self.carried.emit(self._grabbed, where)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go; a node that was carried out of the canvas is dropped where the mouse is."""
        node, dragged = self._grabbed, self._dragging
        self._grabbed, self._panning, self._dragging = -1, False, False
        self.setCursor(Qt.CursorShape.ArrowCursor)
        if node >= 0 and dragged:
            self.dropped.emit(node, event.globalPosition().toPoint())
        elif node < 0 and not dragged and event.button() == Qt.MouseButton.LeftButton:
            self.chosen.emit(-1)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Append a key motion; on the surface show everything."""
        place = event.position()
        mark = node_at(self.picture, self.lens, place.x(), place.y())
        if event.button() != Qt.MouseButton.LeftButton:
            return
        if mark is not None:
            self.appended.emit(mark.node)
        else:
            self.fit()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom at the mouse."""
        place = event.position()
        self._fitting = False
        self.lens = self.lens.zoomed(1.0015 ** event.angleDelta().y(), place.x(), place.y())
        self.refresh()
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing plays any more."""
        self._set_hover(-1)
        self._cross(QPointF(), False, QPoint())

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of a node; by the keyboard that of the chosen one."""
        place = QPointF(event.pos())
        mark = node_at(self.picture, self.lens, place.x(), place.y())
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            mark = self.picture.mark(self.node)
        if mark is not None:
            self.menu_wanted.emit(mark.node, event.globalPos())

    # keys --------------------------------------------------------------------------------------------------------

    def words_at(self, place: QPoint) -> str:
        """Say what a motion is."""
        over = node_at(self.picture, self.lens, place.x(), place.y())
        return self.told(over.node, -1) if over is not None else ""

    def choose_next(self, step: int = 1) -> None:
        """Choose the node after the chosen one, or before it."""
        if self.picture.nodes:
            self.chosen.emit(following(self.picture, self.node, step))
