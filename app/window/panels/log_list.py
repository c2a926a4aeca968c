"""What the program said, kept: one sentence each, details on demand."""

from __future__ import annotations

from datetime import datetime

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QHBoxLayout, QListWidget, QListWidgetItem, QPlainTextEdit, QVBoxLayout, QWidget

from app.window import icons
from app.window.controls import button

MOST = 500
LEVELS = {"error": ("error", "err"), "warn": ("warning", "warn"), "note": ("note", "accent")}


class LogList(QWidget):
    """The newest at the top; the chosen one shows its details, which can be copied."""

    def __init__(self) -> None:
        super().__init__()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.list = QListWidget()
        self.list.setAccessibleName("Messages")
        self.list.setWordWrap(True)
        self.list.setIconSize(QSize(16, 16))
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.currentRowChanged.connect(self._choose)
        self.details = QPlainTextEdit()
        self.details.setReadOnly(True)
        self.details.setFixedHeight(140)
        self.details.hide()
        row = QHBoxLayout()
        row.setSpacing(8)
        self.copy_button = button("Copy", self.copy)
        self.clear_button = button("Clear", self.clear)
        row.addWidget(self.copy_button)
        row.addWidget(self.clear_button)
        row.addStretch(1)
        column.addWidget(self.list, 1)
        column.addWidget(self.details)
        column.addLayout(row)
        self._choose(-1)

    def add(self, sentence: str, details: str = "", level: str = "error") -> None:
        """Keep one message; the oldest gives way where there are too many."""
        name, token = LEVELS[level]
        item = QListWidgetItem(icons.icon(name, token), f"{datetime.now().astimezone():%H:%M:%S}  {sentence}")
        item.setData(Qt.ItemDataRole.UserRole, details)
        item.setToolTip(sentence)
        self.list.insertItem(0, item)
        while self.list.count() > MOST:
            self.list.takeItem(self.list.count() - 1)
        self._choose(self.list.currentRow())

    def copy(self) -> None:
        """Copy the chosen message with its details, or all messages where none is chosen."""
        chosen = self.list.currentItem()
        items = [chosen] if chosen is not None else [self.list.item(row) for row in range(self.list.count())]
        texts = [f"{item.text()}\n{item.data(Qt.ItemDataRole.UserRole)}".strip() for item in items]
        QGuiApplication.clipboard().setText("\n".join(texts))

    def clear(self) -> None:
        """Forget all messages."""
        self.list.clear()
        self._choose(-1)

    def _choose(self, row: int) -> None:
        item = self.list.item(row)
        details = item.data(Qt.ItemDataRole.UserRole) if item is not None else ""
        self.details.setPlainText(details)
        self.details.setVisible(bool(details))
        self.copy_button.setText("Copy" if item is not None else "Copy all")
        for each in (self.copy_button, self.clear_button):
            each.setEnabled(self.list.count() > 0)
