"""A host that draws straight into the window, for desktops whose Qt has OpenGL."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pyvistaqt import QtInteractor
from vtkmodules.vtkRenderingCore import vtkCoordinate, vtkPolyDataMapper2D, vtkTexturedActor2D

from app.window.viewport.background import Background
from app.window.viewport.lens import Lens
from app.window.viewport.scene import Scene


def _veil() -> vtkTexturedActor2D:
    """A sheet over the whole view: the background is drawn on it once more, so that what lies before it is see-through.

    The character fades as one picture: its far side is not seen through its near one.
    """
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    sheet = pv.PolyData(corners, np.array([4, 0, 1, 2, 3]))
    sheet.active_texture_coordinates = corners[:, :2]
    place = vtkCoordinate()
    place.SetCoordinateSystemToNormalizedViewport()
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(sheet)
    mapper.SetTransformCoordinate(place)
    veil = vtkTexturedActor2D()
    veil.SetMapper(mapper)
    veil.SetVisibility(False)
    return veil


class GlHost(QWidget):
    """Shows a scene in pyvistaqt's interactor; the background becomes a texture behind it."""

    name = "OpenGL"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("render host")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self.plotter: Any = QtInteractor(self, auto_update=False, multi_samples=0, lighting="none")
        self.plotter.iren.interactor.SetInteractorStyle(None)
        layout.addWidget(self.plotter)
        self.scene = Scene(self.plotter)
        self.background = Background()
        self._veil = _veil()
        self.plotter.renderer.AddViewProp(self._veil)
        self._drawn: tuple[object, ...] = ()
        self._samples = 0
        self.renders = 0

    def draw(self, lens: Lens, *, fine: bool) -> None:
        """Draw the scene by a lens; ``fine`` smooths the edges, for a view at rest."""
        if self.plotter is None or min(lens.size) < 2:
            return
        self._texture(lens.size)
        samples = 4 if fine else 0
        if samples != self._samples:
            self.plotter.render_window.SetMultiSamples(samples)
            self._samples = samples
        self.scene.look_through(lens)
        self.scene.leave_out_hidden(not fine)
        self.plotter.update()
        self.renders += 1

    def _texture(self, size: tuple[int, int]) -> None:
        picture = self.background.picture
        opacity = self.background.mesh_opacity
        wanted = (None if picture is None else picture.cacheKey(), self.background.view, size, opacity)
        if wanted == self._drawn:
            return
        self._drawn = wanted
        image = QImage(size[0], size[1], QImage.Format.Format_RGB888)
        painter = QPainter(image)
        self.background.paint(painter, *size)
        painter.end()
        stride = image.bytesPerLine()
        rows = np.frombuffer(image.constBits(), np.uint8).reshape(size[1], stride)[:, : 3 * size[0]]
        behind = rows.reshape(size[1], size[0], 3)
        renderer = self.plotter.renderer
        renderer.SetBackgroundTexture(pv.Texture(np.ascontiguousarray(behind)))
        renderer.SetTexturedBackground(True)
        self._veil.SetVisibility(opacity < 1.0)
        if opacity < 1.0:
            share = np.full((*behind.shape[:2], 1), round(255 * (1.0 - opacity)), np.uint8)
            self._veil.SetTexture(pv.Texture(np.concatenate([behind, share], axis=2)))

    def finish(self) -> None:
        """Close the render window; nothing can be drawn afterwards."""
        if self.plotter is None:
            return
        plotter, self.plotter = self.plotter, None
        self.scene.clear()
        plotter.render_window.Finalize()
        plotter.close()
        self.setProperty("finished", True)
