"""Words on a panel: titles, captions, chips, and rows of a label with its control."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QWidget

from app.window import icons

LABEL_WIDTH = 84


def label(text: str, role: str = "label") -> QLabel:
    """A text in one of the roles title, label, value, caption or brand."""
    widget = QLabel(text)
    widget.setProperty("role", role)
    widget.setTextFormat(Qt.TextFormat.PlainText)
    return widget


class Pictogram(QWidget):
    """A large icon that stands for what will be here, in the colours of the look of the moment."""

    def __init__(self, name: str, token: str = "text3", size: int = 56) -> None:
        super().__init__()
        self._icon = icons.icon(name, token)
        self.setFixedHeight(size)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw it in the middle."""
        painter = QPainter(self)
        self._icon.paint(painter, self.rect())
        painter.end()


class Elided(QLabel):
    """A text that ends with an ellipsis where it does not fit, and then shows all of itself as a tooltip."""

    def __init__(self, text: str = "", role: str = "caption") -> None:
        super().__init__(text)
        self.setProperty("role", role)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def minimumSizeHint(self) -> QSize:
        """Narrow enough to make room for its neighbours."""
        return QSize(24, super().minimumSizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw what fits."""
        painter = QPainter(self)
        text = QFontMetrics(self.font()).elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        self.setToolTip(self.text() if text != self.text() else "")
        painter.setPen(self.palette().color(self.foregroundRole()))
        painter.drawText(self.rect(), int(self.alignment() | Qt.AlignmentFlag.AlignVCenter), text)
        painter.end()


class Chip(QLabel):
    """A short state with a colour; it says the state in words as well."""

    def __init__(self, text: str = "", tone: str = "neutral") -> None:
        super().__init__(text)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.setProperty("chip", tone)
        self.setVisible(bool(text))

    def show_state(self, text: str, tone: str = "neutral") -> None:
        """Show another state; an empty text hides the chip."""
        self.setText(text)
        if self.property("chip") != tone:
            self.setProperty("chip", tone)
            self.style().unpolish(self)
            self.style().polish(self)
        self.setVisible(bool(text))


class Row(QWidget):
    """A label of fixed width and its control, aligned with the rows above and below."""

    def __init__(self, text: str, *controls: QWidget, width: int = LABEL_WIDTH) -> None:
        super().__init__()
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        self.caption = label(text)
        self.caption.setFixedWidth(width)
        layout.addWidget(self.caption)
        for control in controls:
            layout.addWidget(control, 1)


class Header(QWidget):
    """The title of a panel or of a section, with room for a caption and for buttons at its right end."""

    def __init__(self, title: str, caption: str = "", height: int = 32) -> None:
        super().__init__()
        self.setObjectName("panelHeader")
        self.setFixedHeight(height)
        self.row = QHBoxLayout(self)
        self.row.setContentsMargins(12, 0, 8, 0)
        self.row.setSpacing(8)
        self.title = Elided(title, "title")
        self.title.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self.caption = Elided(caption)
        self.row.addWidget(self.title)
        self.row.addWidget(self.caption, 1)


def separator() -> QFrame:
    """A thin line between sections."""
    line = QFrame()
    line.setObjectName("separator")
    line.setFixedHeight(1)
    return line
