"""The 3D view as a widget: a host that draws the scene, and over it a surface with the handles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window.canvas.view import View, fitted
from app.window.viewport.drag import VertexDrag
from app.window.viewport.gizmo import Gizmo, GizmoDrag
from app.window.viewport.gizmo_paint import paint_gizmo
from app.window.viewport.handles import Handle, paint_handles
from app.window.viewport.hosts import Choice, choose, make_host
from app.window.viewport.layers import IN_SCENE, Layers
from app.window.viewport.lens import Lens, clipped, framed
from app.window.viewport.mouse import Mouse
from app.window.viewport.orbit import Orbit, around, beside, facing
from imitation.geometry import Camera

Looking = Literal["orbit", "camera", "side"]
IDLE = 250
CORNERS = np.array([[corner >> axis & 1 for axis in range(3)] for corner in range(8)], bool)
"""Of a box, by whether a corner lies at the far end of each axis."""


class Surface(QWidget):
    """The transparent layer over the picture."""

    def __init__(self, parent: Viewport) -> None:
        super().__init__(parent)
        self.view3d = parent
        self.setMouseTracking(True)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the handles."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.view3d.paint_over(painter)
        painter.end()


class Viewport(QWidget):
    """Shows a mesh, lets a vertex be chosen and dragged. Events come by ``happened``, with plain values.

    Attributes
    ----------
    gizmo : what places the whole character; while it is shown no vertex can be taken.
    grabbing : whether vertices can be taken.
    highlighted : a vertex that is pointed at elsewhere, -1 for none.
    taken : pixels at the right that notes lie over: names of handles keep out of them.
    """

    happened = Signal(object)
    hovered = Signal(int)
    view_moved = Signal()

    def __init__(self, choice: Choice = "auto", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.host: Any = make_host(choose(choice), self)
        self.scene = self.host.scene
        self.surface = Surface(self)
        self.looking: Looking = "orbit"
        self.orbit = Orbit()
        self.camera: Camera | None = None
        self.picture: QImage | None = None
        self.mesh_opacity = 1.0
        self.layers = Layers()
        self.view = View()
        self._fit = True
        self.vertices: NDArray[np.float64] = np.zeros((0, 3))
        self.faces: NDArray[np.int32] = np.zeros((0, 3), np.int32)
        self._painted = False
        self.handles: tuple[Handle, ...] = ()
        self.notes: Sequence[Callable[[QPainter, Lens], None]] = ()
        self.calm: Callable[[], bool] = lambda: True
        self.gizmo: Gizmo | None = None
        self.grabbing = True
        self.highlighted = -1
        self.taken = 0
        self.mouse = Mouse(self)
        self._idle = QTimer(self)
        self._idle.setSingleShot(True)
        self._idle.setInterval(IDLE)
        self._idle.timeout.connect(self._refine)
        self._dirty = True
        self._lens: Lens | None = None
        # The host fills it: nothing below need be painted, and what lies over it is painted with it, once.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(240, 160)

    # what is shown -----------------------------------------------------------------------------------------------

    def show_mesh(
        self, vertices: NDArray[np.float64], faces: NDArray[np.int32], colours: NDArray[np.uint8] | None
    ) -> None:
        """Show another mesh."""
        self.vertices, self.faces, self._painted = np.asarray(vertices, np.float64), faces, False
        self.scene.set_mesh(vertices, faces, colours)
        self.redraw()

    def paint(self, colours: NDArray[np.uint8] | None) -> None:
        """Give the vertices (v, 3) other colours for now; None gives them their own again."""
        if colours is not None or self._painted:
            self._painted = colours is not None
            self.scene.paint_mesh(colours)
            self.redraw()

    def move_mesh(self, vertices: NDArray[np.float64]) -> None:
        """Bring the mesh to other places."""
        self.vertices = np.asarray(vertices, np.float64)
        self.scene.move_mesh(self.vertices)
        self.redraw()

    def clear_mesh(self) -> None:
        """Show no mesh."""
        self.vertices, self.faces = np.zeros((0, 3)), np.zeros((0, 3), np.int32)
        self.scene.clear_mesh()
        self.redraw()

    def show_handles(self, handles: Sequence[Handle]) -> None:
        """Show other handles."""
        self.handles = tuple(handles)
        self.repaint_over()

    def show_gizmo(self, gizmo: Gizmo | None) -> None:
        """Show the gizmo, or none; one that is held stays where the hand has it."""
        if gizmo != self.gizmo:
            self.gizmo = gizmo
            self.repaint_over()

    def highlight(self, vertex: int) -> None:
        """Show the handle of a vertex that is pointed at elsewhere, -1 for none."""
        if vertex != self.highlighted:
            self.highlighted = vertex
            self.repaint_over()

    def show_camera(self, camera: Camera | None, picture: QImage | None) -> None:
        """Take the frame's camera and its picture."""
        before = self.through_camera
        self.camera, self.picture = camera, picture
        if self.through_camera != before:
            self.show_layers()
        elif self.looking == "camera":
            self.redraw()

    def look(self, looking: Looking) -> None:
        """Orbit, look through the recovered camera, or look from its side."""
        self.looking = looking
        if looking == "side" and self.camera is not None:
            middle = self.vertices.mean(0) if len(self.vertices) else np.zeros(3)
            self.orbit = beside(self.camera, middle, around(self._subject(), self.orbit, aspect=self._aspect()))
        self.show_layers()

    def shows(self, name: str) -> bool:
        """Whether a layer is on in the present look."""
        return self.layers.on(name, over_film=self.through_camera)

    def show_layer(self, name: str, on: bool) -> None:
        """Show or hide a layer, from now on whenever one looks about in space, or over the film."""
        self.layers.switch(name, on, over_film=self.through_camera)
        self.show_layers()

    def show_layers(self) -> None:
        """Show the layers of the present look."""
        for name in IN_SCENE:
            self.scene.show(name, self.shows(name))
        self.redraw()

    def carry(self, shift: NDArray[np.float64]) -> None:
        """Let the orbit go along with the subject by a step (3,), world."""
        x, y, z = (float(value) for value in np.add(self.orbit.target, shift))
        self.orbit = replace(self.orbit, target=(x, y, z))
        self.redraw()

    def look_like(self, other: Viewport) -> None:
        """Look from where another view looks."""
        self.looking, self.orbit, self.view, self._fit = other.looking, other.orbit, other.view, other._fit
        self.show_layers()

    def orbit_from(self, camera: Camera) -> None:
        """Orbit from about the side that the recovered camera is on, and show everything."""
        self.orbit = facing(camera, self._subject().mean(0), self.orbit)
        self.fit()

    def fit(self) -> None:
        """Show the whole mesh, or the whole picture."""
        self._fit = True
        self.orbit = around(self._subject(), self.orbit, aspect=self._aspect())
        self.redraw()

    def _subject(self) -> NDArray[np.float64]:
        return self.vertices if len(self.vertices) else self.scene.extent

    def _aspect(self) -> float:
        return self.width() / max(self.height(), 1)

    @property
    def through_camera(self) -> bool:
        """Whether the picture is seen through the frame's camera."""
        return self.looking == "camera" and self.camera is not None

    # drawing -----------------------------------------------------------------------------------------------------

    def lens(self) -> Lens:
        """What is looked through now."""
        size = (max(self.width(), 2), max(self.height(), 2))
        if self.through_camera and self.camera is not None:
            if self._fit and self.picture is not None:
                self.view = fitted((self.picture.width(), self.picture.height()), size)
            camera = framed(self.camera, self.view)
        else:
            camera = self.orbit.camera(size)
        low, high = self.scene.seen_extent
        return clipped(camera, size, np.where(CORNERS, high, low))

    def redraw(self) -> None:
        """Draw soon: however many changes come before the next paint, the scene is drawn once."""
        self._dirty = True
        self.repaint_over()

    def repaint_over(self) -> None:
        """Paint soon what lies over the picture, which itself stays unless it has changed."""
        self.update()
        if self.surface.internalWinId():
            self.surface.update()  # over a host with a window of its own it has one too, and is painted by itself

    def _draw(self, *, fine: bool) -> None:
        lens = self._lens = self.lens()
        behind = self.picture if self.through_camera and self.shows("film") else None
        opacity = self.mesh_opacity if self.through_camera else 1.0
        self.host.background.show(behind, self.view, mesh_opacity=opacity)
        self.host.draw(lens, fine=fine)
        self._dirty = False

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the scene where it has changed, and once more finely when it rests."""
        if self._dirty:
            self._draw(fine=False)
            self._idle.start()

    def _refine(self) -> None:
        if not self.calm():
            # The fine picture takes several times as long: it waits for the end of the work under way.
            self._idle.start()
            return
        if self.isVisible() and not self._dirty and self.mouse.drag is None and self.mouse.turn is None:
            self._draw(fine=True)
            self.update()

    def paint_over(self, painter: QPainter) -> None:
        """Draw handles and notes over the picture, by the lens it was drawn by."""
        lens = self.lens() if self._dirty or self._lens is None else self._lens
        if self.gizmo is not None:
            paint_gizmo(painter, lens, self.gizmo, getattr(self._drag, "part", self.mouse.part))
        else:
            paint_handles(painter, lens, self.handles, (self.mouse.hover, self.highlighted), taken=self.taken)
        for note in self.notes:
            note(painter, lens)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep host and surface as large as the view."""
        self.host.setGeometry(self.rect())
        self.surface.setGeometry(self.rect())
        self.redraw()

    # mouse and keys ----------------------------------------------------------------------------------------------

    @property
    def _drag(self) -> VertexDrag | GizmoDrag | None:
        return self.mouse.drag

    @property
    def dragging(self) -> bool:
        """Whether a vertex or the gizmo is held."""
        return self.mouse.drag is not None

    @property
    def carrying(self) -> bool:
        """Whether what is held is being moved."""
        return self.mouse.drag is not None and self.mouse.drag.dragging

    def vertex_at(self, place: tuple[float, float]) -> int:
        """The vertex at a widget place: that of a handle first, else the nearest visible one; -1 for none."""
        return self.mouse.vertex_at(place)

    def cancel(self) -> bool:
        """Give up the drag under way; says whether there was one."""
        return self.mouse.cancel()

    def move_view(self, dx: float, dy: float, *, panning: bool) -> None:
        """Turn or shift the view by mouse pixels."""
        if self.through_camera:
            if panning:
                self._fit, self.view = False, self.view.panned(dx, dy)
        elif panning:
            self.orbit = self.orbit.shifted(dx, dy, self.height())
        else:
            self.orbit = self.orbit.turned(dx, dy)
        self.view_moved.emit()
        self.redraw()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a vertex or the gizmo, or turn the view; the keys go here then."""
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        self.mouse.press(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with the drag or the turn, or say which vertex the mouse is over."""
        self.mouse.move(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag or the turn."""
        self.mouse.release(event)
        self._idle.start()

    def leaveEvent(self, event: QEvent) -> None:
        """The mouse is over nothing any more."""
        self.mouse.hover_over(-1)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Show everything, unless a vertex was meant."""
        if self.vertex_at((event.position().x(), event.position().y())) < 0:
            self.fit()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Go nearer or away."""
        factor = 1.0015 ** event.angleDelta().y()
        if self.through_camera:
            self._fit, self.view = False, self.view.zoomed(factor, event.position().x(), event.position().y())
        else:
            self.orbit = self.orbit.closer(factor)
        self.view_moved.emit()
        self.redraw()
        event.accept()

    def event(self, event: QEvent) -> bool:
        """Keep the keys of a drag from being taken as commands of the window."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self.mouse.wants(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Give up a drag, or hold it to an axis."""
        if not self.mouse.key(event):
            super().keyPressEvent(event)

    # the end -----------------------------------------------------------------------------------------------------

    def finish(self) -> None:
        """Close the render window; called by the window that closes, and once more by Qt does no harm."""
        self._idle.stop()
        self._dirty = False
        self.host.finish()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close the render window with the widget."""
        self.finish()
        super().closeEvent(event)
