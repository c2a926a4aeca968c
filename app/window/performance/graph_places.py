"""Where the nodes of the graph stand: laid out once a graph in the background; those that were dragged stay."""

from __future__ import annotations

import hashlib
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.window.background_call import BackgroundCalls
from app.window.performance.state import PerformanceState

KEPT = 20


class GraphPlaces(QObject):
    """``places`` by node in node diameters; ``changed`` when there are others."""

    changed = Signal()

    def __init__(self, state: PerformanceState, calls: BackgroundCalls, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state, self._calls = state, calls
        self.places: dict[int, tuple[float, float]] = {}
        self._known: dict[str, list[tuple[float, float]]] = {}
        self._moved: dict[tuple[str, int], tuple[float, float]] = {}
        self._graph: Any = None
        self._key = self._asked = ""

    def forget(self) -> None:
        """Another project: nothing was dragged."""
        self.places, self._moved, self._graph, self._key, self._asked = {}, {}, None, "", ""

    def refresh(self) -> None:
        """Follow the graph: another size of it changes nothing, other motions are laid out anew."""
        graph = self.state.graph
        if graph is None:
            self._graph, self._key = None, ""
            self._set({})
            return
        if graph is self._graph:
            return
        self._graph = graph
        digest = hashlib.blake2b(graph.complete.tobytes(), digest_size=12)
        digest.update(repr([node.sequence for node in graph.nodes]).encode())
        self._key = digest.hexdigest()
        if self._key in self._known:
            self._arrange()
        elif self._key != self._asked:
            self._ask(graph, self._key)

    def _ask(self, graph: Any, key: str) -> None:
        self._asked = key

        def made() -> list[tuple[float, float]]:
            import numpy as np

            from app.actions.performing_graph import layout

            found = layout(graph.complete, np.array([node.sequence for node in graph.nodes]))
            return [(float(x), float(y)) for x, y in found]

        self._calls.run(made, lambda found: self._laid_out(key, found), lambda _: self._laid_out(key, []))

    def _laid_out(self, key: str, found: list[tuple[float, float]]) -> None:
        self._known[key] = found
        while len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        if key == self._key:
            self._arrange()

    def _arrange(self) -> None:
        places = dict(enumerate(self._known[self._key]))
        for motion in self.state.motions:
            dragged = self._moved.get((motion.sequence, motion.texton[0]))
            if dragged is not None:
                places[motion.node] = dragged
        self._set(places)

    def move(self, node: int, x: float, y: float) -> None:
        """Put a node somewhere else; it stays there."""
        if node in self.places:
            motion = self.state.motions[node]
            self._moved[motion.sequence, motion.texton[0]] = (x, y)
            self._set({**self.places, node: (x, y)})

    def tidy(self) -> None:
        """Put every node back where the layout has it."""
        if self._moved and self._key in self._known:
            self._moved = {}
            self._arrange()

    def _set(self, places: dict[int, tuple[float, float]]) -> None:
        if places != self.places:
            self.places = places
            self.changed.emit()
