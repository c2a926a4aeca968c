"""Widgets in a row or a column, without the lines that a layout takes each time."""

from __future__ import annotations

from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QVBoxLayout, QWidget

GAP = 8


def beside(wide: QWidget, *others: QWidget, margin: int = 0) -> QWidget:
    """A row whose first part takes the room that there is."""
    row = QWidget()
    layout = QHBoxLayout(row)
    _fill(layout, (wide, *others), margin, GAP)
    layout.setStretchFactor(wide, 1)
    return row


def above(*parts: QWidget) -> QWidget:
    """A column without gaps; what has a height of its own keeps it."""
    column = QWidget()
    layout = QVBoxLayout(column)
    _fill(layout, parts, 0, 0)
    return column


def _fill(layout: QBoxLayout, parts: tuple[QWidget, ...], margin: int, gap: int) -> None:
    layout.setContentsMargins(margin, margin, margin, margin)
    layout.setSpacing(gap)
    for part in parts:
        layout.addWidget(part)
