"""A number that changes with every frame."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFont, QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import fonts, theme

LEFT, RIGHT = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight


class Figure(QWidget):
    """A text on a panel that is painted over in place.

    A label that changes has all that surrounds it laid out and painted anew, which takes longer than a frame's picture.
    """

    def __init__(
        self,
        token: str = "text",
        size: int = fonts.CAPTION,
        weight: QFont.Weight = QFont.Weight.Normal,
        *,
        align: Qt.AlignmentFlag = LEFT,
    ) -> None:
        super().__init__()
        self._text = self._widest = ""
        self._token, self._font, self._align = token, fonts.font(size, weight), align
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)

    def text(self) -> str:
        """What it says."""
        return self._text

    def setText(self, text: str) -> None:
        """Say something else."""
        if text != self._text:
            self._text = text
            self.setAccessibleName(text)
            self.update()

    def reserve(self, widest: str) -> None:
        """Keep room for the widest text that will come."""
        if widest != self._widest:
            self._widest = widest
            self.updateGeometry()

    def sizeHint(self) -> QSize:
        """As wide as what room is kept for."""
        metrics = QFontMetrics(self._font)
        return QSize(max(metrics.horizontalAdvance(self._widest), self.minimumWidth()), metrics.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the text on the colour of a panel."""
        look = theme.active()
        painter = QPainter(self)
        painter.fillRect(self.rect(), look.colour("panel"))
        painter.setFont(self._font)
        painter.setPen(look.colour(self._token if self.isEnabled() else "line2"))
        painter.drawText(self.rect(), int(self._align | Qt.AlignmentFlag.AlignVCenter), self._text)
        painter.end()
