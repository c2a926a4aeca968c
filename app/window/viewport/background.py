"""What lies behind the 3D scene: the video frame where one looks through its camera, else a quiet gradient."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QImage, QLinearGradient, QPainter, QPixmap

from app.window import theme
from app.window.canvas.view import View


class Background:
    """A picture placed by a view, dimmed as wanted, or nothing."""

    def __init__(self) -> None:
        self.picture: QImage | None = None
        self.view = View()
        self.dim = 0.0
        self.mesh_opacity = 1.0
        self._kept: tuple[tuple[int, int, str], QPixmap] | None = None

    def show(self, picture: QImage | None, view: View, *, mesh_opacity: float = 1.0) -> None:
        """Take another picture; the mesh over it may be see-through."""
        self.picture, self.view, self.mesh_opacity = picture, view, mesh_opacity

    def _fade(self, width: int, height: int, look: str) -> QPixmap:
        key = (width, height, look)
        if self._kept is None or self._kept[0] != key:
            fade = QLinearGradient(QPointF(0, 0), QPointF(0, height))
            top, low = ("#262D36", "#14171B") if look == "dark" else ("#EEF1F4", "#C9D0D8")
            fade.setColorAt(0.0, QColor(top))
            fade.setColorAt(1.0, QColor(low))
            picture = QPixmap(width, height)
            painter = QPainter(picture)
            painter.fillRect(QRectF(0, 0, width, height), fade)
            painter.end()
            self._kept = (key, picture)
        return self._kept[1]

    def paint(self, painter: QPainter, width: int, height: int) -> None:
        """Fill a widget of a size."""
        look = theme.active()
        if self.picture is None or self.picture.isNull():
            painter.drawPixmap(0, 0, self._fade(width, height, look.name))
            return
        painter.fillRect(QRectF(0, 0, width, height), look.colour("canvas"))
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        scale = self.view.scale
        place = QRectF(self.view.x, self.view.y, self.picture.width() * scale, self.picture.height() * scale)
        painter.drawImage(place, self.picture)
        if self.dim > 0:
            painter.fillRect(place, QColor(0, 0, 0, round(255 * self.dim)))
