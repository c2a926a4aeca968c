"""The row above the lanes: playing, stepping, the frame number, what the colours mean."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QBrush, QFont, QFontMetricsF, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QWidget

from app.window import fonts, icons, theme
from app.window.controls import Figure, icon_button
from app.window.timeline.lanes import Diamond
from app.window.timeline.paint import paint_diamond

Entry = tuple[str, str, str]


class Legend(QWidget):
    """What diamonds, colours and hatches in the lanes mean: (text, colour, shape)."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: tuple[Entry, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(28)

    def show_entries(self, entries: Sequence[Entry]) -> None:
        """Show other entries; those that do not fit are left out from the left."""
        if tuple(entries) != self.entries:
            self.entries = tuple(entries)
            self.update()

    def sizeHint(self) -> QSize:
        """As wide as there is room."""
        return QSize(200, 28)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the entries from the right."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look, face = theme.active(), fonts.font(fonts.CAPTION)
        metrics = QFontMetricsF(face)
        right, middle = float(self.width()), self.height() / 2
        painter.setFont(face)
        for text, colour, shape in reversed(self.entries):
            width = metrics.horizontalAdvance(text)
            left = right - width - 20
            if left < 0:
                break
            painter.setPen(look.colour("text2"))
            painter.drawText(QRectF(left + 20, 0, width + 2, self.height()), Qt.AlignmentFlag.AlignVCenter, text)
            if shape in ("diamond", "hollow"):
                paint_diamond(painter, left + 8, middle, Diamond(0, colour, shape == "diamond"), 4.5)
            else:
                box = QRectF(left + 2, middle - 4, 12, 8)
                painter.setPen(Qt.PenStyle.NoPen)
                pattern = Qt.BrushStyle.BDiagPattern if shape == "hatch" else Qt.BrushStyle.SolidPattern
                painter.setBrush(QBrush(look.colour(colour), pattern))
                painter.drawRoundedRect(box, 2, 2)
            right = left - 14
        painter.setPen(look.colour("line"))
        painter.drawLine(QPointF(0, self.height()), QPointF(0, self.height()))
        painter.end()


class Transport(QWidget):
    """Buttons for playing and stepping. ``wanted`` names what is asked for."""

    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(38)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 0, 8, 0)
        row.setSpacing(4)
        self.buttons = {}
        for name, text, key in (
            ("first", "First frame", "Home"),
            ("previous_mark", "Previous click or edit", "Up"),
            ("previous", "Previous frame", "Left"),
            ("play", "Play or pause", "Space"),
            ("next", "Next frame", "Right"),
            ("next_mark", "Next click or edit", "Down"),
            ("last", "Last frame", "End"),
        ):
            button = icon_button(name, text, lambda name=name: self.wanted.emit(name), key)
            self.buttons[name] = button
            row.addWidget(button)
        row.addSpacing(10)
        self.number = Figure("text", fonts.BODY, QFont.Weight.DemiBold, align=Qt.AlignmentFlag.AlignRight)
        self.number.setMinimumWidth(26)
        self.of = Figure("text3")
        row.addWidget(self.number)
        row.addWidget(self.of)
        row.addSpacing(12)
        self.legend = Legend()
        row.addWidget(self.legend, 1)
        row.addSpacing(8)
        row.addWidget(icon_button("fit_time", "Show the whole clip", lambda: self.wanted.emit("fit_time")))

    def show_frame(self, frame: int, count: int, fps: float, seconds: float) -> None:
        """Show where we are."""
        last = max(count - 1, 0)
        self.number.reserve(str(last))
        self.of.reserve(f"of {last}   ·   {last / max(fps, 1e-9):.2f} s   ·   {fps:g} fps")
        self.number.setText(str(frame))
        self.of.setText(f"of {last}   ·   {seconds:.2f} s   ·   {fps:g} fps")

    def show_playing(self, playing: bool) -> None:
        """Show whether it plays."""
        self.buttons["play"].setIcon(icons.icon("pause" if playing else "play", "text2", "text2"))
