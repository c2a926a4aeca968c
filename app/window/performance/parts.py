"""The parts of the Motion graph in the order in which the keys lead through them."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QWidget

if TYPE_CHECKING:
    from app.window.performance.workspace import PerformanceWorkspace


CARDS = "Up and Down choose a sequence, Enter plays it as captured, F4 renames it, Delete removes it."
GRAPH = "Arrows and Page Down choose a motion, Enter adds it as key motion, X forbids it, Delete takes it out again."
LANE = (
    "Up and Down go from motion to motion, Ctrl with Left and Right moves one, with Up and Down repeats it, "
    "Enter makes it a key motion, Delete removes it."
)
SOURCE = (
    "Up and Down go from texton to texton, Enter keeps one; Page Down goes to the next boundary, "
    "Ctrl with Left and Right moves it, Delete joins."
)
MATRIX = "Arrows point at two moments, Enter shows the first; Page Down goes to the next boundary."


class Parts:
    """Library, database, graph, preview or self-similarity, choices, composed lane, source: as they are seen."""

    def __init__(self, page: PerformanceWorkspace) -> None:
        self._page = page
        views = (page.library.cards, page.graph.canvas, page.composed.view, page.strip.view, page.matrix.view)
        self._said = tuple(zip(views, (CARDS, GRAPH, LANE, SOURCE, MATRIX), strict=True))
        for view in views:
            view.reached.connect(lambda: page.hint.emit(self.hint()))

    def hint(self) -> str:
        """What the keys do where they go now, if keys led there; else nothing."""
        return next((sentence for view, sentence in self._said if view.ringed and view.hasFocus()), "")

    def order(self) -> list[tuple[QWidget, QWidget]]:
        """Each part that is seen, with what takes the keys in it."""
        page = self._page
        view = page.preview.view.viewport
        parts: list[tuple[QWidget, QWidget]] = [
            (page.library, page.library.cards if page.library.cards.isVisible() else page.library.add_button),
            (page.database, page.database.slider),
            (page.graph, page.graph.canvas if page.graph.canvas.isVisible() else page.graph.nothing.add),
            (page.preview, view if view is not None and view.isVisible() else page.preview.play_button),
            (page.matrix, page.matrix.view),
            (page.composed.options, page.composed.options.paths),
            (page.composed.view, page.composed.view),
            (page.strip, page.strip.view),
        ]
        return [(part, inner) for part, inner in parts if inner.isVisible() and inner.isEnabled()]

    def go(self, step: int) -> None:
        """Give the keys to the next part, or to the one before."""
        parts, focus = self.order(), QApplication.focusWidget()
        here = next((k for k, (part, _) in enumerate(parts) if focus is not None and _in(part, focus)), None)
        if parts:
            to = (0 if step > 0 else len(parts) - 1) if here is None else (here + step) % len(parts)
            reason = Qt.FocusReason.TabFocusReason if step > 0 else Qt.FocusReason.BacktabFocusReason
            parts[to][1].setFocus(reason)

    def chain(self) -> None:
        """Let Tab lead through all that takes the keys, part by part, from the left and from above."""
        page = self._page
        panels: list[QWidget] = [page.library, page.database, page.graph, page.preview, page.matrix]
        panels += [page.composed.transport, page.composed.options, page.composed.view, page.strip]
        stops = [each for panel in panels for each in _stops(panel)]
        for before, after in pairwise(stops):
            QWidget.setTabOrder(before, after)


def _in(part: QWidget, widget: QWidget) -> bool:
    return part is widget or part.isAncestorOf(widget)


def _stops(panel: QWidget) -> list[QWidget]:
    """What takes the focus by Tab in a panel, in the order in which it was made."""
    found = [panel, *panel.findChildren(QWidget)]
    by_tab = [each for each in found if each.focusPolicy() & Qt.FocusPolicy.TabFocus and each.focusProxy() is None]
    return [each for each in by_tab if each.window() is panel.window()]
