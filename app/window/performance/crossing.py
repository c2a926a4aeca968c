"""What a transition looks like: the two frames that meet, one over the other, and what it costs."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QFontMetricsF, QImage, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.window import fonts, theme
from app.window.performance.graph_model import told
from app.window.performance.state import PerformanceState
from app.window.performance.thumbnails import Thumbnails

SIZE, PADDING, WIDEST = 104, 10, 340
PATIENCE = 220
"""Milliseconds that the mouse has to stay on a transition, so that nothing flickers where it only passes."""
WRAPPED = Qt.TextFlag.TextWordWrap | Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop
AWAY = QPoint(18, 18)


class Crossing(QWidget):
    """A card beside the mouse, which goes through it."""

    def __init__(self, parent: QWidget, state: PerformanceState, thumbnails: Thumbnails) -> None:
        super().__init__(parent)
        self.state, self.thumbnails = state, thumbnails
        self.frames: tuple[tuple[str, int], ...] = ()
        self.words = ""
        self._high = 0.0
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._wait = QTimer(self)
        self._wait.setSingleShot(True)
        self._wait.setInterval(PATIENCE)
        self._wait.timeout.connect(self._appear)
        self.hide()
        thumbnails.ready.connect(lambda *_: self.update() if self.isVisible() else None)

    def show_edge(self, start: int, goal: int, where: QPoint) -> None:
        """Show a transition of the graph; without one hide."""
        graph = self.state.graph
        if graph is None or min(start, goal) < 0 or max(start, goal) >= len(self.state.motions):
            self.stop()
            return
        leave, enter = (int(frame) for frame in graph.transitions[start, goal])
        sequences = (self.state.motions[start].sequence, self.state.motions[goal].sequence)
        self._show(((sequences[0], leave), (sequences[1], enter)), told(self.state, start, goal), where)

    def show_cut(self, number: int, words: str, where: QPoint) -> None:
        """Show a cut of the performance; without one hide."""
        performance = self.state.performance
        if performance is None or not 0 <= number < len(performance.cuts):
            self.stop()
            return
        leave, enter = self.state.cut_motions(number)
        self._show(((leave.sequence, leave.frame), (enter.sequence, enter.frame)), words, where)

    def _show(self, frames: tuple[tuple[str, int], ...], words: str, where: QPoint) -> None:
        self.frames, self.words = frames, words
        metrics = QFontMetricsF(fonts.font(fonts.CAPTION))
        needed = metrics.boundingRect(QRectF(0, 0, WIDEST, 1000), WRAPPED, words)
        self._high = needed.height()
        size = QSize(round(max(needed.width() + 2, 2 * SIZE) + 2 * PADDING), round(SIZE + self._high + 2 * PADDING + 4))
        self.resize(size)
        room, place = self.parentWidget().rect(), self.parentWidget().mapFromGlobal(where) + AWAY
        if place.y() + size.height() > room.bottom():
            place.setY(place.y() - size.height() - 2 * AWAY.y())
        place.setX(max(min(place.x(), room.right() - size.width()), 0))
        self.move(place)
        self.update()
        if not self.isVisible():
            self._wait.start()

    def _appear(self) -> None:
        self.raise_()
        self.show()

    def stop(self) -> None:
        """Show nothing, and nothing later."""
        self._wait.stop()
        self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the card: both frames one over the other, and what is said of them."""
        look = theme.active()
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        painter.setPen(QPen(look.colour("line2"), 1))
        painter.setBrush(look.colour("raised"))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6, 6)
        middle = self.width() / 2
        for place, (sequence, frame) in enumerate(self.frames):
            image: QImage | None = self.thumbnails.picture(sequence, frame, first=True)
            if image is not None and not image.isNull():
                painter.setOpacity(0.95 if place == 0 else 0.6)
                painter.drawImage(QRectF(middle - SIZE / 2, PADDING, SIZE, SIZE), image)
        painter.setOpacity(1.0)
        painter.setFont(fonts.font(fonts.CAPTION))
        painter.setPen(look.colour("text"))
        room = QRectF(PADDING, PADDING + SIZE + 3, self.width() - 2 * PADDING, self._high + 2)
        painter.drawText(room, WRAPPED, self.words)
        painter.end()
