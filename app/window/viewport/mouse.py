"""What the mouse does in the 3D view: take a vertex or the gizmo, turn the view, say what lies under it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent

from app.window.viewport.drag import Mode, VertexDrag, VertexReleased, held_mode
from app.window.viewport.gizmo import GizmoDrag, GizmoReleased, Part
from app.window.viewport.handles import axis_tips
from app.window.viewport.picking import on_mesh, pick_vertex

if TYPE_CHECKING:
    from app.window.viewport.widget import Viewport

AXIS_KEYS: dict[int, Mode] = {Qt.Key.Key_X: "x", Qt.Key.Key_Y: "y", Qt.Key.Key_Z: "z"}
REACH, TIP = 10, 7
SHIFT, CONTROL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier


class Mouse:
    """The hand of one viewport; tells what it means by the viewport's ``happened``."""

    def __init__(self, view: Viewport) -> None:
        self.view = view
        self.drag: VertexDrag | GizmoDrag | None = None
        self.hover = -1
        self.part: Part | None = None
        self.turn: tuple[QPointF, bool] | None = None

    # what lies under it ------------------------------------------------------------------------------------------

    def vertex_at(self, place: tuple[float, float]) -> int:
        """The vertex at a widget place: that of a handle first, else the nearest visible one; -1 for none."""
        found = self.handle_at(place)
        view = self.view
        if found >= 0 or not len(view.vertices):
            return found
        picked = pick_vertex(view.lens().camera, view.vertices, view.faces, place)
        return -1 if picked is None else picked

    def handle_at(self, place: tuple[float, float]) -> int:
        """The vertex of the handle at a widget place, -1 for none."""
        handles = self.view.handles
        if not handles:
            return -1
        places = self.view.lens().to_widget(np.array([handle.place for handle in handles]))
        away = np.nan_to_num(np.hypot(*(places - place).T), nan=np.inf)
        return handles[int(np.argmin(away))].vertex if away.min() <= REACH else -1

    def _part_at(self, place: tuple[float, float]) -> Part | None:
        """The part of the gizmo at a widget place; the character itself moves and turns with its body."""
        view, gizmo = self.view, self.view.gizmo
        assert gizmo is not None
        camera = view.lens().camera
        found = gizmo.part_at(camera, place)
        if found is None and gizmo.mode == "move" and on_mesh(camera, view.vertices, view.faces, place):
            return "body"
        return found

    def _grip(self, place: tuple[float, float]) -> tuple[int, Mode]:
        """The vertex that a press takes hold of, and the axis where it is the end of one of the selected vertex."""
        chosen = next((handle for handle in self.view.handles if handle.selected), None)
        if chosen is not None and self.handle_at(place) < 0:
            for name, tip in axis_tips(self.view.lens(), chosen).items():
                if math.dist(place, tip) <= TIP:
                    return chosen.vertex, name  # type: ignore[return-value]
        return self.vertex_at(place), "plane"

    # pressing, moving, letting go --------------------------------------------------------------------------------

    def press(self, event: QMouseEvent) -> None:
        """Take a part of the gizmo or a vertex, or begin to turn the view."""
        place = (event.position().x(), event.position().y())
        keys = event.modifiers()
        left = event.button() == Qt.MouseButton.LeftButton and not keys & Qt.KeyboardModifier.AltModifier
        if left and self.drag is None and self._take(place, keys):
            return
        panning = event.button() == Qt.MouseButton.MiddleButton or bool(keys & SHIFT)
        self.turn = (event.position(), panning)

    def _take(self, place: tuple[float, float], keys: Qt.KeyboardModifier) -> bool:
        view = self.view
        if view.gizmo is not None:
            part = self._part_at(place)
            if part is not None:
                self.drag = GizmoDrag(view.lens().camera, view.gizmo, part)
        elif view.grabbing:
            vertex, locked = self._grip(place)
            if vertex >= 0:
                mode = held_mode(locked, shift=bool(keys & SHIFT), control=bool(keys & CONTROL))
                start = view.vertices[vertex].copy()
                self.drag = VertexDrag(view.lens().camera, vertex, start, mode, locked=locked)
        if self.drag is None:
            return False
        self.drag.press(place)
        return True

    def move(self, event: QMouseEvent) -> None:
        """Go on with the drag or the turn, or say which vertex the mouse is over."""
        place = (event.position().x(), event.position().y())
        if self.drag is not None:
            self.drag.hold(shift=bool(event.modifiers() & SHIFT), control=bool(event.modifiers() & CONTROL))
            self._tell(self.drag.move(place))
        elif self.turn is not None:
            self._move_view(event.position())
        else:
            self._look_under(place)

    def _look_under(self, place: tuple[float, float]) -> None:
        view = self.view
        if view.gizmo is not None:
            part = view.gizmo.part_at(view.lens().camera, place)
            if part != self.part:
                self.part = part
                view.repaint_over()
        elif view.handles:
            self.hover_over(self.handle_at(place))

    def hover_over(self, vertex: int) -> None:
        """Say which vertex's handle the mouse is over, -1 for none."""
        if vertex != self.hover:
            self.hover = vertex
            self.view.hovered.emit(vertex)
            self.view.repaint_over()

    def _move_view(self, position: QPointF) -> None:
        if self.turn is not None:
            before, panning = self.turn
            step = position - before
            self.turn = (position, panning)
            self.view.move_view(step.x(), step.y(), panning=panning)

    def release(self, event: QMouseEvent) -> None:
        """End the drag or the turn."""
        if self.drag is not None and event.button() == Qt.MouseButton.LeftButton:
            drag, self.drag = self.drag, None
            drag.hold(shift=bool(event.modifiers() & SHIFT), control=bool(event.modifiers() & CONTROL))
            self._tell(drag.release((event.position().x(), event.position().y())))
        self.turn = None

    def wants(self, event: QKeyEvent) -> bool:
        """Whether a key belongs to the drag under way and to nothing else."""
        return self.drag is not None and event.key() in (*AXIS_KEYS, Qt.Key.Key_Escape)

    def key(self, event: QKeyEvent) -> bool:
        """Give up a drag, or hold it to an axis; says whether the key was one of these."""
        if self.drag is None or not self.wants(event):
            return False
        if event.key() == Qt.Key.Key_Escape:
            self.cancel()
        else:
            self._tell(self.drag.lock(AXIS_KEYS[event.key()]))
        return True

    def cancel(self) -> bool:
        """Give up the drag under way; says whether there was one."""
        drag, self.drag = self.drag, None
        if drag is None:
            return False
        given_up = GizmoReleased() if isinstance(drag, GizmoDrag) else VertexReleased(drag.vertex)
        self._tell(drag.cancel() or given_up)
        return True

    def _tell(self, event: object | None) -> None:
        if event is not None:
            self.view.happened.emit(event)
