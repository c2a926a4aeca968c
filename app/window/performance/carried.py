"""A motion on its way from the graph to the timeline, beside the mouse."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtGui import QImage, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.window import fonts, theme

SIZE = 72


class Carried(QWidget):
    """Picture and name; the mouse goes through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFixedSize(SIZE + 48, SIZE + 22)
        self._shown: tuple[QImage | None, str] = (None, "")
        self.hide()

    def show_at(self, shown: tuple[QImage | None, str] | None, place: QPoint) -> None:
        """Follow the mouse at a place of the parent; without anything to show it hides."""
        if shown is None:
            self.hide()
            return
        self._shown = shown
        self.move(place.x() - self.width() // 2, place.y() - SIZE // 2)
        self.raise_()
        self.show()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw it."""
        look = theme.active()
        image, name = self._shown
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setOpacity(0.85)
        circle = QRectF((self.width() - SIZE) / 2, 1, SIZE - 2, SIZE - 2)
        painter.setPen(QPen(look.colour("accent"), 2))
        painter.setBrush(look.colour("panel"))
        painter.drawEllipse(circle)
        if image is not None and not image.isNull():
            painter.drawImage(circle.adjusted(6, 6, -6, -6), image)
        painter.setFont(fonts.font(fonts.CAPTION))
        painter.setPen(look.colour("text"))
        painter.drawText(QRectF(0, SIZE, self.width(), 20), Qt.AlignmentFlag.AlignCenter, name)
        painter.end()
