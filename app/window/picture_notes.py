"""Small plates in the corners of a picture: which frame it is, and a message that goes away by itself."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from app.window import theme
from app.window.canvas import marks


class PictureNotes(QWidget):
    """Lies over a picture and lets the mouse through."""

    def __init__(self, over: QWidget) -> None:
        super().__init__(over)
        self._over = over
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.text, self.message, self.right = "", "", ("", "text")
        self._fade = QTimer(self)
        self._fade.setSingleShot(True)
        self._fade.setInterval(2600)
        self._fade.timeout.connect(lambda: self.say(""))
        over.installEventFilter(self)
        self.resize(over.size())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Stay as large as the picture."""
        if event.type() == QEvent.Type.Resize and isinstance(watched, QWidget):
            self.resize(watched.size())
        return False

    def show_frame(self, frame: int, count: int, seconds: float) -> None:
        """Show the number of the frame that is really on the screen."""
        text = f"Frame {frame} of {count - 1}  ·  {seconds:.2f} s"
        if text != self.text:
            self.text = text
            self._paint_soon()

    def show_right(self, text: str, token: str = "text") -> None:
        """Show a short state in the other corner."""
        if (text, token) != self.right:
            self.right = (text, token)
            self._paint_soon()

    def say(self, message: str) -> None:
        """Show a message for a moment."""
        self.message = message
        if message:
            self._fade.start()
        self._paint_soon()

    def _paint_soon(self) -> None:
        """Paint it with what it lies over, which is painted once then, and not once more for the plates alone."""
        self._over.update()
        if self.internalWinId():
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the plates."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        look = theme.DARK
        if self.text:
            marks.plate(painter, 10, 21, self.text, look.colour("text"))
        if self.right[0]:
            marks.plate(painter, self.width() - 10, 21, self.right[0], look.colour(self.right[1]), align="right")
        if self.message:
            marks.plate(
                painter, self.width() / 2, self.height() - 24, self.message, look.colour("text"), align="centre"
            )
        painter.end()
