"""All points of the project in a list: colour, name, how sure, drawn or not; a click chooses."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFont, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.model.tracks import Track
from app.window import fonts, icons, theme
from app.window.lanes_of import DOUBT
from app.window.picture_layers import colour_of
from app.window.reading import KnownTrack

ROW, EYE, DOT = 28, 30, 26


class PointList(QWidget):
    """Rows to choose from. The dot gives the next colour, the eye hides; Up, Down, Return and Space do the same."""

    chosen = Signal(str)
    hidden = Signal(str)
    recoloured = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[tuple[Track, float]] = []
        self.at = 0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setAccessibleName("Points")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def show_points(self, rows: list[tuple[Track, KnownTrack]]) -> None:
        """Show the points; of each the lowest confidence, 0 while it is being followed."""
        made = [(track, float(known.confidence.min()) if known.complete else 0.0) for track, known in rows]
        if made != self.rows:
            self.rows = made
            self.at = min(self.at, max(len(made) - 1, 0))
            self.setFixedHeight(max(len(made), 1) * ROW)
            self.update()

    def sizeHint(self) -> QSize:
        """As high as the rows."""
        return QSize(200, max(len(self.rows), 1) * ROW)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a row, or switch its colour or its eye."""
        number = int(event.position().y() // ROW)
        if 0 <= number < len(self.rows):
            self.at = number
            x = event.position().x()
            signal = self.recoloured if x < DOT else self.hidden if x > self.width() - EYE else self.chosen
            signal.emit(self.rows[number][0].id)
            self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Say what a click would do."""
        x = event.position().x()
        words = "Next colour" if x < DOT else "Draw it or not" if x > self.width() - EYE else "Choose this point"
        self.setToolTip(words)

    def event(self, event: QEvent) -> bool:
        """Keep the keys of the list while it has the focus."""
        keys = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Space)
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() in keys:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move, choose, hide."""
        if event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down) and self.rows:
            step = 1 if event.key() == Qt.Key.Key_Down else -1
            self.at = min(max(self.at + step, 0), len(self.rows) - 1)
            self.update()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Space) and self.rows:
            signal = self.chosen if event.key() == Qt.Key.Key_Return else self.hidden
            signal.emit(self.rows[self.at][0].id)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the rows."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look = theme.active()
        for number, (track, lowest) in enumerate(self.rows):
            top = float(number * ROW)
            if number == self.at and self.hasFocus():
                painter.setPen(QPen(look.colour("accent"), 2))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRoundedRect(QRectF(1, top + 1, self.width() - 2, ROW - 2), 5, 5)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour(colour_of(track)))
            painter.drawEllipse(QPointF(12, top + ROW / 2), 5.5, 5.5)
            painter.setFont(fonts.font(fonts.BODY, QFont.Weight.Normal))
            painter.setPen(look.colour("text" if track.visible else "text3"))
            right = self.width() - EYE
            name = QFontMetricsF(painter.font()).elidedText(track.name, Qt.TextElideMode.ElideRight, right - DOT - 70)
            painter.drawText(QRectF(DOT, top, right - DOT - 66, ROW), Qt.AlignmentFlag.AlignVCenter, name)
            painter.setFont(fonts.font(fonts.CAPTION))
            painter.setPen(look.colour("text3" if lowest >= DOUBT else "warn"))
            text = f"least {lowest:.2f}" if lowest else "following"
            painter.drawText(QRectF(right - 66, top, 60, ROW), _RIGHT, text)
            eye = icons.pixmap("seen" if track.visible else "hidden", "text2" if track.visible else "text3", 16)
            painter.drawPixmap(QPointF(right + 6, top + ROW / 2 - 8), eye)
        painter.end()


_RIGHT = int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight)
