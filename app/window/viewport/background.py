"""What lies behind the 3D scene: the video frame where one looks through its camera, else a quiet gradient."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QLinearGradient, QPainter

from app.window import theme
from app.window.canvas.view import View


class Background:
    """A picture placed by a view, dimmed as wanted, or nothing."""

    def __init__(self) -> None:
        self.picture: QImage | None = None
        self.view = View()
        self.dim = 0.0
        self.mesh_opacity = 1.0

    def show(self, picture: QImage | None, view: View, *, mesh_opacity: float = 1.0) -> None:
        """Take another picture; the mesh over it may be see-through."""
        self.picture, self.view, self.mesh_opacity = picture, view, mesh_opacity

    def paint(self, painter: QPainter, width: int, height: int) -> None:
        """Fill a widget of a size."""
        look = theme.active()
        if self.picture is None or self.picture.isNull():
            fade = QLinearGradient(QPointF(0, 0), QPointF(0, height))
            top, low = ("#262D36", "#14171B") if look.name == "dark" else ("#EEF1F4", "#C9D0D8")
            fade.setColorAt(0.0, QColor(top))
            fade.setColorAt(1.0, QColor(low))
            painter.fillRect(QRectF(0, 0, width, height), fade)
            return
        painter.fillRect(QRectF(0, 0, width, height), look.colour("canvas"))
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        scale = self.view.scale
        place = QRectF(self.view.x, self.view.y, self.picture.width() * scale, self.picture.height() * scale)
        painter.drawImage(place, self.picture)
        if self.dim > 0:
            painter.fillRect(place, QColor(0, 0, 0, round(255 * self.dim)))
