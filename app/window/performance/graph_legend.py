"""What colours, lines and badges of the motion graph mean."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import fonts, theme
from app.window.performance.state import PerformanceState

LINES = (
    ("key motion", "edit", "disc"),
    ("path", "accent", "line"),
    ("other transition", "line2", "line"),
    ("poses far apart", "line2", "dash"),
)


class GraphLegend(QWidget):
    """One row under the graph: lines first, as sequences are named elsewhere too; what does not fit is left out."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: tuple[tuple[str, str, str], ...] = ()
        self.setFixedHeight(28)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        """As wide as there is room."""
        return QSize(200, 28)

    def show_state(self, state: PerformanceState, visible: bool) -> None:
        """Show the sequences of the project, and what the lines are."""
        rings = tuple((each.name, state.colour(each.id), "ring") for each in state.document.sequences if each.visible)
        entries = (*LINES, *rings) if visible else ()
        if entries != self.entries:
            self.entries = entries
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the entries from the left."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look, face = theme.active(), fonts.font(fonts.CAPTION)
        metrics = QFontMetricsF(face)
        painter.setFont(face)
        left, middle = 14.0, self.height() / 2
        for text, token, shape in self.entries:
            text = metrics.elidedText(text, Qt.TextElideMode.ElideRight, 140)
            width = metrics.horizontalAdvance(text)
            if left + 22 + width > self.width() - 8:
                break
            colour = look.colour(token)
            painter.setBrush(colour if shape == "disc" else Qt.BrushStyle.NoBrush)
            pen = QPen(colour, 2)
            if shape == "dash":
                pen.setDashPattern([2, 1.5])
            painter.setPen(Qt.PenStyle.NoPen if shape == "disc" else pen)
            if shape in ("line", "dash"):
                painter.drawLine(QPointF(left, middle), QPointF(left + 14, middle))
            else:
                painter.drawEllipse(QPointF(left + 7, middle), 5, 5)
            painter.setPen(look.colour("text2"))
            painter.drawText(QRectF(left + 20, 0, width + 2, self.height()), Qt.AlignmentFlag.AlignVCenter, text)
            left += 20 + width + 16
        painter.end()
