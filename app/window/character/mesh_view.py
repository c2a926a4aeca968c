"""The panel of the 3D view: how one looks at the character, and what is drawn around it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Signal
from PySide6.QtGui import QImage, QResizeEvent

from app.actions.heat import Heat
from app.window.character.empty import Empty
from app.window.character.mesh_header import MeshHeader
from app.window.character.over_panes import OverPanes
from app.window.character.overlays import HEAT_WIDTH
from app.window.character.panes import SPLIT, Pane, Panes
from app.window.character.surroundings import Surroundings
from app.window.controls import ErrorBar, Panel
from app.window.lazy_view import FAILED, Libraries
from app.window.picture_notes import PictureNotes
from app.window.viewport import Gizmo, Handle, Viewport
from app.window.viewport.hosts import Choice
from imitation.geometry import Camera

SPOKEN = 700
"""Pixels of width from which the header has room for a caption."""
Array = NDArray[np.float64]


class MeshView(Panel):
    """Holds the viewports, which are made when they are first shown, because the 3D libraries load slowly."""

    happened = Signal(object)
    pointed = Signal(int)
    made = Signal()
    loaded = Signal()
    wanted = Signal(str)

    def __init__(self, choice: Choice) -> None:
        super().__init__("Character", " ")
        self._libraries = Libraries(self)
        self._libraries.loaded.connect(self.loaded)
        self._libraries.failed.connect(self._not_loaded)
        self.over = OverPanes()
        self.calm: Callable[[], bool] = lambda: True
        self._mesh: tuple[int, int] = (0, 0)
        self._frame = 0
        self._scene: Surroundings | None = None
        self._background: tuple[Array, NDArray[np.int32], NDArray[np.uint8]] | None = None
        self._faced = False
        self.bar = MeshHeader()
        self.header.row.addWidget(self.bar)
        self.look_buttons, self.opacity = self.bar.look_buttons, self.bar.opacity
        self.ghost_button, self.split_button = self.bar.ghost_button, self.bar.split_button
        self.bar.looked.connect(self.look)
        self.bar.faded.connect(self._fade)
        self.bar.ghosted.connect(self._ghost)
        self.bar.parted.connect(self.part)
        self.bar.layer.connect(self._layer)
        self.bar.fitted.connect(self.fit)
        self.errors = ErrorBar()
        self.column.addWidget(self.errors)
        self.panes = Panes(choice)
        self.waiting = self.panes.waiting
        self.empty = Empty()
        self.empty.wanted.connect(self.wanted)
        self.column.addWidget(self.empty, 1)
        self.column.addWidget(self.panes, 1)
        self.empty.hide()
        self.panes.happened.connect(self.happened)
        self.panes.hovered.connect(self.pointed)
        self.look_buttons["orbit"].setChecked(True)
        self.opacity.hide()

    @property
    def heat(self) -> Heat | None:
        """What the colours of the mesh stand for now, None for the character's own."""
        return self.over.heat

    @property
    def viewport(self) -> Viewport | None:
        """The main view, once there is one."""
        return self.panes.main.view if self.panes.main is not None else None

    @property
    def notes(self) -> PictureNotes | None:
        """The notes over the main view."""
        return self.panes.main.notes if self.panes.main is not None else None

    @property
    def looking(self) -> str:
        """How one looks: "orbit", "camera" or "side"."""
        return next(name for name, each in self.look_buttons.items() if each.isChecked())

    def ready(self) -> bool:
        """Whether the viewport can be made at once; else the 3D libraries are loaded, and ``loaded`` says when."""
        return self.viewport is not None or self._libraries.ready()

    def _not_loaded(self, sentence: str, trace: str) -> None:
        self.waiting.setText(FAILED)
        self.errors.tell(sentence, trace)

    def make(self, kind: str = "main") -> Pane:
        """Give a pane, made now where there is none yet."""
        fresh = kind not in self.panes.panes
        pane = self.panes.make(kind)
        if fresh:
            self._equip(pane)
            if kind == "main":
                self.made.emit()
        return pane

    def _equip(self, pane: Pane) -> None:
        """Give a new pane what all share: layers, overlays, opacity."""
        view = pane.view
        view.calm = lambda: self.calm()
        view.layers = self.bar.layers
        view.mesh_opacity = self.opacity.value() / 100
        if pane.own:
            view.notes = self.over.notes(pane)
        if self._background is not None:
            view.scene.set_background(*self._background)
        if self._scene is not None:
            self._lay(pane)
        view.show_layers()

    # looking -----------------------------------------------------------------------------------------------------

    def look(self, name: str) -> None:
        """Orbit, look through the camera or from its side."""
        self.look_buttons[name].setChecked(True)
        self.opacity.setVisible(name == "camera")
        if self.viewport is not None:
            self.viewport.look(name)  # type: ignore[arg-type]
            self.bar.over_film = self.viewport.through_camera
            self.panes.follow()

    def part(self, on: bool) -> None:
        """Show camera and side at once, or the main view alone."""
        self.split_button.blockSignals(True)
        self.split_button.setChecked(on)
        self.split_button.blockSignals(False)
        main = self.viewport
        if main is None:
            return
        others = [pane.kind for pane in self.panes.compared]
        if on:
            self.look("camera" if main.camera is not None else "orbit")
        self.show_panes([SPLIT, *others] if on else others)
        if on:
            view = self.panes.panes[SPLIT].view
            view.show_mesh(main.vertices, main.faces, self._colours)
            view.show_handles(main.handles)
            view.show_gizmo(main.gizmo)
            view.camera, view.picture = main.camera, main.picture
            view.look("side")
            view.fit()
            self.panes.panes[SPLIT].notes.show_right("from the side")

    def show_panes(self, kinds: list[str]) -> None:
        """Show these panes beside the main one."""
        known = set(self.panes.panes)
        self.panes.want(kinds)
        for kind, pane in self.panes.panes.items():
            if kind not in known:
                self._equip(pane)
        self.panes.follow()
        self.changed_size()

    def fit(self) -> None:
        """Show everything."""
        for pane in self.panes.own:
            pane.view.fit()
        self.panes.follow()

    def changed_size(self) -> None:
        """Fit the buttons into the header."""
        self.bar.fit_width(self.width())
        self.header.caption.setMaximumWidth(16777215 if self.width() >= SPOKEN else 0)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the buttons into the header."""
        super().resizeEvent(event)
        self.changed_size()

    # what is shown -----------------------------------------------------------------------------------------------

    def show_mesh(
        self, vertices: Array, faces: NDArray[np.int32], colours: NDArray[np.uint8] | None, frame: int = 0
    ) -> None:
        """Show the pose of a frame; the mesh is made anew only where it is another one.

        In another frame the view in space goes along with the character, unless it shall stand still.
        """
        main = self.make()
        self._show_empty(False)
        self._colours = colours
        mesh = (id(faces), len(vertices))
        step = vertices.mean(axis=0) - main.view.vertices.mean(axis=0) if mesh == self._mesh else np.zeros(3)
        if frame != self._frame and self.bar.following and step.any():
            for pane in self.panes.own:
                pane.view.carry(step)
            self.panes.follow()
        self._frame = frame
        for pane in self.panes.own:
            if mesh != self._mesh:
                pane.view.show_mesh(vertices, faces, colours)
                pane.view.fit()
            else:
                pane.view.move_mesh(vertices)
        self._mesh, self._faces = mesh, faces

    def move_mesh(self, vertices: Array) -> None:
        """Show the pose that follows the mouse."""
        for pane in self.panes.own:
            pane.view.move_mesh(vertices)

    def show_compared(
        self, kind: str, vertices: Array | None, faces: NDArray[np.int32], colours: object, title: str, token: str
    ) -> None:
        """Show a pose in a pane that compares, with what it is."""
        pane = self.panes.panes.get(kind)
        if pane is None:
            return
        pane.notes.show_right(title, token)
        if vertices is None:
            pane.view.clear_mesh()
            pane.faces = None
        elif pane.faces is not faces or len(pane.view.vertices) != len(vertices):
            pane.view.show_mesh(vertices, faces, colours)  # type: ignore[arg-type]
            pane.faces = faces
        else:
            pane.view.move_mesh(vertices)

    def clear(self) -> None:
        """Show no mesh."""
        self._mesh, self._faced = (0, 0), False
        for pane in self.panes.panes.values():
            pane.view.clear_mesh()
            pane.view.show_handles(())
            pane.view.show_gizmo(None)

    def show_empty(self, characters: bool, tracks: bool) -> None:
        """Say what is missing before anything can be shown."""
        self.empty.show_missing(characters, tracks)
        self._show_empty(not characters)

    def _show_empty(self, on: bool) -> None:
        self.empty.setVisible(on)
        self.panes.setVisible(not on)

    def show_scene(self, points: Array, centres: Array, ground: float) -> None:
        """Show the background of the character: points, the camera's path, the ground's height."""
        main = self.make()
        extent = main.view.scene.extent
        middle = extent.mean(0)
        radius = 2.2 * float(np.linalg.norm(extent[1] - extent[0]))
        if self._scene is not None and self._scene.serves(points, centres, ground, middle, radius):
            return
        near = np.linalg.norm(points - middle, axis=1) < 4 * radius if len(points) else np.zeros(0, bool)
        self._scene = Surroundings(points, centres, ground, middle, radius, points[near])
        for pane in self.panes.panes.values():
            self._lay(pane)

    def _lay(self, pane: Pane) -> None:
        laid = self._scene
        assert laid is not None
        pane.view.scene.set_points(laid.near)
        pane.view.scene.set_camera_path(laid.centres)
        pane.view.scene.set_ground(laid.middle[:2], laid.radius, laid.ground)
        pane.view.redraw()

    def show_background(self, mesh: tuple[Array, NDArray[np.int32], NDArray[np.uint8]] | None) -> None:
        """Show the measured background, or none."""
        self._background = mesh
        nothing = (np.zeros((0, 3)), np.zeros((0, 3), np.int32), np.zeros((0, 3), np.uint8))
        for pane in self.panes.panes.values():
            pane.view.scene.set_background(*(mesh or nothing))
            pane.view.redraw()

    def show_camera(self, camera: Camera | None, picture: QImage | None) -> None:
        """Take the camera and the picture of the frame."""
        for pane in self.panes.panes.values():
            pane.view.show_camera(camera, picture)
        main = self.viewport
        if main is not None:
            if camera is not None and not self._faced:
                self._faced = True
                main.orbit_from(camera)
            self.bar.over_film = main.through_camera
        self.look_buttons["camera"].setEnabled(camera is not None)
        self.look_buttons["side"].setEnabled(camera is not None)

    def show_handles(self, handles: Sequence[Handle]) -> None:
        """Show handles."""
        for pane in self.panes.own:
            pane.view.show_handles(handles)

    def show_gizmo(self, gizmo: Gizmo | None) -> None:
        """Show what places the character, or nothing."""
        for pane in self.panes.own:
            pane.view.show_gizmo(gizmo)

    def show_heat(self, heat: Heat | None) -> None:
        """Colour the mesh, or give it its own colours."""
        self.over.heat = heat
        for pane in self.panes.own:
            pane.view.taken = HEAT_WIDTH if heat is not None else 0
            if heat is None or len(heat.colours) == len(pane.view.vertices):
                pane.view.paint(None if heat is None else heat.colours)
            pane.view.repaint_over()

    def highlight(self, vertex: int) -> None:
        """Light a vertex that is pointed at elsewhere, -1 for none."""
        for pane in self.panes.own:
            pane.view.highlight(vertex)

    def allow_grabbing(self, on: bool) -> None:
        """Let vertices be taken, or not."""
        for pane in self.panes.own:
            pane.view.grabbing = on

    @property
    def dragging(self) -> bool:
        """Whether something is held in a view."""
        return any(pane.view.dragging for pane in self.panes.own)

    def cancel(self) -> bool:
        """Give up the drag under way in any view; says whether there was one."""
        return any(pane.view.cancel() for pane in self.panes.own)

    def _fade(self, value: int) -> None:
        for pane in self.panes.panes.values():
            pane.view.mesh_opacity = value / 100
            pane.view.redraw()

    def _layer(self, name: str, on: bool) -> None:
        self.bar.layers.switch(name, on, over_film=self.bar.over_film)
        for pane in self.panes.panes.values():
            pane.view.show_layers()

    def _ghost(self, on: bool) -> None:
        self.over.ghosting = on
        self._over()

    def _over(self) -> None:
        for pane in self.panes.own:
            pane.view.repaint_over()

    def changeEvent(self, event: QEvent) -> None:
        """Paint the overlays in another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.StyleChange and hasattr(self, "panes"):
            self._over()

    def finish(self) -> None:
        """Close the render windows."""
        self._libraries.close()
        self.panes.finish()
