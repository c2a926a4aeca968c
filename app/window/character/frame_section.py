"""How well the pose in sight fits: distances from the points, stretch, the worst constraints as bars."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QFont, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import fonts, theme
from app.window.controls import Figure, Fold, Row

SHOWN, ROW = 5, 22


class ResidualBars(QWidget):
    """The largest distances as bars with the limit as a dashed line; ``chosen`` gives a vertex."""

    chosen = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.rows: tuple[tuple[int, str, float], ...] = ()
        self.limit = 1.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setAccessibleName("Worst constraints in this frame")

    def show_rows(self, rows: Sequence[tuple[int, str, float]], limit: float) -> None:
        """Show (vertex, name, pixels), the worst first."""
        made = tuple(rows[:SHOWN])
        if (made, limit) != (self.rows, self.limit):
            self.rows, self.limit = made, limit
            self.setFixedHeight(len(made) * ROW)
            self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the vertex of a bar."""
        number = int(event.position().y() // ROW)
        if 0 <= number < len(self.rows):
            self.chosen.emit(self.rows[number][0])

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw names, bars, numbers and the limit."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look = theme.active()
        painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.Normal))
        metrics = QFontMetricsF(painter.font())
        left, right = 92.0, self.width() - 52.0
        most = max(2 * self.limit, *(value for _, _, value in self.rows)) if self.rows else 1.0
        for number, (_, name, value) in enumerate(self.rows):
            top, over = float(number * ROW), value > self.limit
            painter.setPen(look.colour("text2"))
            text = metrics.elidedText(name, Qt.TextElideMode.ElideRight, left - 8)
            painter.drawText(QRectF(0, top, left - 6, ROW), Qt.AlignmentFlag.AlignVCenter, text)
            painter.setPen(look.colour("err" if over else "text2"))
            box, flags = QRectF(right + 4, top, 48, ROW), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
            painter.drawText(box, int(flags), f"{value:.1f} px")
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("hover"))
            painter.drawRoundedRect(QRectF(left, top + ROW / 2 - 3, right - left, 6), 3, 3)
            painter.setBrush(look.colour("err" if over else "accent"))
            painter.drawRoundedRect(QRectF(left, top + ROW / 2 - 3, max((right - left) * value / most, 3), 6), 3, 3)
        if self.rows:
            x = left + (right - left) * self.limit / most
            painter.setPen(QPen(look.colour("err"), 1.2, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(x, 2), QPointF(x, self.height() - 2))
        painter.end()


class FrameSection(Fold):
    """What can be read off the frame in sight."""

    chosen = Signal(int)

    def __init__(self) -> None:
        super().__init__("This frame")
        self.fit, self.stretch = Figure(), Figure()
        self.column.addWidget(Row("Reprojection", self.fit))
        self.column.addWidget(Row("Edge stretch", self.stretch))
        self.bars = ResidualBars()
        self.bars.chosen.connect(self.chosen)
        self.column.addWidget(self.bars)

    def show_fit(
        self, away: Mapping[int, float], names: Mapping[int, str], limit: float, stretch: tuple[float, float] | None
    ) -> None:
        """Show distances (vertex to pixels) from the points, and the least and largest stretch of an edge."""
        values = list(away.values())
        mean = sum(values) / len(values) if values else 0.0
        self.fit.setText(f"{mean:.1f} px mean, {max(values):.1f} px max" if values else "nothing is seen here")
        self.stretch.setText(f"{stretch[0]:.2f} – {stretch[1]:.2f}" if stretch is not None else "not measured yet")
        order = sorted(away, key=lambda vertex: -away[vertex])
        self.bars.show_rows([(vertex, names.get(vertex, f"{vertex}"), away[vertex]) for vertex in order], limit)
        over = sum(value > limit for value in values)
        self.caption.setText(f"{over} over {limit:.1f} px" if over else "")
