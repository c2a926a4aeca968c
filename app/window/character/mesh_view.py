"""The panel of the 3D view: how one looks at the character, and what is drawn around it."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QButtonGroup, QSlider, QVBoxLayout, QWidget

from app.window.background_call import BackgroundCalls
from app.window.controls import ErrorBar, Panel, icon_button, label, toggle
from app.window.picture_notes import PictureNotes
from app.window.viewport import Handle, Viewport
from app.window.viewport.hosts import Choice
from app.window.viewport.lens import Lens
from app.window.work import details
from imitation.geometry import Camera

LIBRARIES = "app.window.viewport.scene"
"""The module whose loading loads the 3D libraries."""
LOOKS = (
    ("orbit", "Orbit", "orbit", "3"),
    ("camera", "Camera", "camera", "1"),
    ("side", "Side", "side", "2"),
)


class MeshView(Panel):
    """Holds the viewport, which is made when it is first shown, because the 3D libraries load slowly."""

    happened = Signal(object)
    made = Signal()
    loaded = Signal()

    def __init__(self, choice: Choice) -> None:
        super().__init__("Character", " ")
        self.choice = choice
        self.viewport: Viewport | None = None
        self._calls = BackgroundCalls(self)
        self._loading = False
        self.ghosts: Callable[[], Sequence[tuple[int, NDArray[np.float64]]]] = tuple
        self.calm: Callable[[], bool] = lambda: True
        self._mesh: tuple[int, int] = (0, 0)
        self._ground: tuple[float, ...] = ()
        self._faced = False
        bar = self.header.row
        self.looks = QButtonGroup(self)
        self.look_buttons = {}
        for name, text, icon, key in LOOKS:
            each = toggle(icon, text, lambda on, name=name: self.look(name) if on else None, key=key)
            self.looks.addButton(each)
            self.look_buttons[name] = each
            bar.addWidget(each)
        self.opacity = QSlider(Qt.Orientation.Horizontal)
        self.opacity.setRange(10, 100)
        self.opacity.setValue(100)
        self.opacity.setFixedWidth(72)
        self.opacity.setToolTip("How solid the character is over the video")
        self.opacity.setAccessibleName("Opacity of the character")
        self.opacity.valueChanged.connect(self._fade)
        self.ghost_button = toggle("ghosts", "Ghosts", lambda on: self._over(), key="G")
        self.points_button = toggle("grid", "Scene", self._show_scene, on=True)
        self.points_button.setToolTip("Background points, the camera's path and the ground")
        for each in (self.ghost_button, self.points_button):
            each.setAccessibleName(each.text())
            each.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
        for widget in (self.ghost_button, self.points_button, self.opacity):
            bar.addWidget(widget)
        bar.addWidget(icon_button("fit", "Show everything", self.fit, "F"))
        self.errors = ErrorBar()
        self.column.addWidget(self.errors)
        self.place = QWidget()
        self._inner = QVBoxLayout(self.place)
        self._inner.setContentsMargins(0, 0, 0, 0)
        self.waiting = label("Loading the 3D view…", "caption")
        self.waiting.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._inner.addWidget(self.waiting)
        self.column.addWidget(self.place, 1)
        self.notes: PictureNotes | None = None
        self.look_buttons["orbit"].setChecked(True)

    def ready(self) -> bool:
        """Whether the viewport can be made at once; else the 3D libraries are loaded, and ``loaded`` says when."""
        if self.viewport is not None or LIBRARIES in sys.modules:
            return True
        if not self._loading:
            self._loading = True
            self._calls.run(lambda: importlib.import_module(LIBRARIES), lambda _: self.loaded.emit(), self._not_loaded)
        return False

    def _not_loaded(self, error: BaseException) -> None:
        self._loading = False
        self.waiting.setText("The 3D view cannot be loaded.")
        self.errors.tell(f"The 3D view cannot be loaded: {error}", details(error))

    def make(self) -> Viewport:
        """Give the viewport, made now where there is none yet."""
        if self.viewport is None:
            self.viewport = Viewport(self.choice)
            self.waiting.hide()
            self._inner.addWidget(self.viewport)
            self.viewport.happened.connect(self.happened)
            self.viewport.notes = (self._paint_ghosts,)
            self.viewport.calm = lambda: self.calm()
            self.notes = PictureNotes(self.viewport)
            self.notes.raise_()
            self.made.emit()
        return self.viewport

    def look(self, name: str) -> None:
        """Orbit, look through the camera or from its side."""
        self.look_buttons[name].setChecked(True)
        self.opacity.setEnabled(name == "camera")
        if self.viewport is not None:
            self.viewport.look(name)  # type: ignore[arg-type]

    def fit(self) -> None:
        """Show everything."""
        if self.viewport is not None:
            self.viewport.fit()

    def show_mesh(
        self, vertices: NDArray[np.float64], faces: NDArray[np.int32], colours: NDArray[np.uint8] | None
    ) -> None:
        """Show a pose; the mesh is made anew only where it is another one."""
        viewport = self.make()
        mesh = (id(faces), len(vertices))
        if mesh != self._mesh:
            self._mesh = mesh
            self._faces = faces
            viewport.show_mesh(vertices, faces, colours)
            viewport.fit()
        else:
            viewport.move_mesh(vertices)

    def clear(self) -> None:
        """Show no mesh."""
        self._mesh, self._faced = (0, 0), False
        if self.viewport is not None:
            self.viewport.clear_mesh()

    def show_scene(self, points: NDArray[np.float64], centres: NDArray[np.float64], ground: float) -> None:
        """Show the background of the character: points, the camera's path, the ground's height."""
        viewport = self.make()
        extent = viewport.scene.extent
        middle = extent.mean(0)
        radius = 2.2 * float(np.linalg.norm(extent[1] - extent[0]))
        signature = (float(len(points)), float(len(centres)), ground, *np.round(middle, 1).tolist(), round(radius, 1))
        if signature == self._ground:
            return
        self._ground = signature
        near = np.linalg.norm(points - middle, axis=1) < 4 * radius if len(points) else np.zeros(0, bool)
        viewport.scene.set_points(points[near])
        viewport.scene.set_camera_path(centres)
        viewport.scene.set_ground(middle[:2], radius, ground)
        viewport.redraw()

    def show_camera(self, camera: Camera | None, picture: QImage | None) -> None:
        """Take the camera and the picture of the frame."""
        if self.viewport is not None:
            self.viewport.show_camera(camera, picture)
            if camera is not None and not self._faced:
                self._faced = True
                self.viewport.orbit_from(camera)
        self.look_buttons["camera"].setEnabled(camera is not None)
        self.look_buttons["side"].setEnabled(camera is not None)

    def show_handles(self, handles: Sequence[Handle]) -> None:
        """Show handles."""
        if self.viewport is not None:
            self.viewport.show_handles(handles)

    def _fade(self, value: int) -> None:
        if self.viewport is not None:
            self.viewport.mesh_opacity = value / 100
            self.viewport.redraw()

    def _show_scene(self, on: bool) -> None:
        if self.viewport is not None:
            [self.viewport.show_layer(name, on) for name in ("points", "path", "ground")]

    def _over(self) -> None:
        if self.viewport is not None:
            self.viewport.surface.update()

    def _paint_ghosts(self, painter: QPainter, lens: Lens) -> None:
        if self.ghost_button.isChecked():
            from app.window.character.ghosts import paint_ghosts

            paint_ghosts(painter, lens, self.ghosts())

    def finish(self) -> None:
        """Close the render window."""
        self._calls.close()
        if self.viewport is not None:
            self.viewport.finish()
