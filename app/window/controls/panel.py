"""Panels: a framed surface with a header, and the scrolled column of an inspector."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from app.window.controls.labels import Header


class Panel(QFrame):
    """A framed surface; what it shows is added to ``column``, errors appear under the header."""

    def __init__(self, title: str = "", caption: str = "", header_height: int = 38) -> None:
        super().__init__()
        self.setObjectName("panel")
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(1, 1, 1, 1)
        self.column.setSpacing(0)
        self.header = Header(title, caption, header_height)
        self.column.addWidget(self.header)
        self.header.setVisible(bool(title))  # shown before it lies in the panel it would be a window for a moment


class ScrollColumn(QScrollArea):
    """A column of rows that scrolls where it does not fit, so that no row is squeezed."""

    def __init__(self) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        body = QWidget()
        body.setObjectName("scrollBody")
        self.rows = QVBoxLayout(body)
        self.rows.setContentsMargins(12, 4, 12, 12)
        self.rows.setSpacing(8)
        self.setWidget(body)
        self.viewport().setAutoFillBackground(False)
