"""A host that draws off-screen and paints the picture itself: needs no OpenGL from Qt, and is cheap on software GL."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QImage, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from app.window.viewport.background import Background
from app.window.viewport.lens import Lens
from app.window.viewport.offscreen import Offscreen
from app.window.viewport.scene import Scene


class RasterHost(QWidget):
    """Shows a scene by painting its off-screen picture over the background."""

    name = "software picture"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("render host")
        self.stage: Offscreen | None = Offscreen()
        self.scene = Scene(self.stage)
        self.background = Background()
        self._pixels = vtkUnsignedCharArray()
        self._rows: np.ndarray | None = None
        self._picture = QImage()
        self._size = (0, 0)
        self.renders = 0

    def draw(self, lens: Lens, *, fine: bool) -> None:
        """Draw the scene by a lens; ``fine`` draws twice as large and scales down, for a view at rest."""
        if self.stage is None or min(lens.size) < 2:
            return
        factor = self.devicePixelRatioF() * (2.0 if fine else 1.0)
        size = (max(round(lens.size[0] * factor), 2), max(round(lens.size[1] * factor), 2))
        window = self.stage.render_window
        if size != self._size:
            window.SetSize(*size)
            self._size = size
        self.scene.look_through(lens)
        self.scene.leave_out_hidden(not fine)
        window.Render()
        window.GetRGBACharPixelData(0, 0, size[0] - 1, size[1] - 1, 0, self._pixels)
        rows = vtk_to_numpy(self._pixels).reshape(size[1], size[0], 4)
        self._rows = rows
        # The rows come from the bottom up, and in an order of bytes that is painted slowly.
        picture = QImage(rows.data, size[0], size[1], 4 * size[0], QImage.Format.Format_RGBA8888_Premultiplied)
        picture = picture.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)
        picture.flip(Qt.Orientation.Vertical)
        self._picture = picture
        self.renders += 1

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the background, then the picture of the scene."""
        painter = QPainter(self)
        self.background.paint(painter, self.width(), self.height())
        painter.setOpacity(self.background.mesh_opacity)
        at_rest = self._picture.width() > self.width() * self.devicePixelRatioF() + 1
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, at_rest)
        painter.drawImage(QRectF(0, 0, self.width(), self.height()), self._picture)
        painter.end()

    def finish(self) -> None:
        """Close the render window; nothing can be drawn afterwards."""
        if self.stage is None:
            return
        stage, self.stage = self.stage, None
        self._picture, self._rows = QImage(), None
        self.scene.clear()
        stage.finish()
        self.setProperty("finished", True)
