"""Figures of the Motion graph in the window: from the slider of its size to the new path lit, large graphs drawn."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions.session import Session
from app.model.edits import performance as edits
from app.model.performance import KeyMotion
from tests.benchmarks.bench_window import load
from tests.benchmarks.record import Recorder, cpu_seconds
from tests.window.conftest import _move as move_mouse
from tests.window.conftest import at, settle, wait_for
from tests.window.conftest import open_shell as open_shell
from tests.window.conftest import private_places as private_places
from tests.window.conftest import qapp as qapp
from tests.window.conftest import screen_of_its_own as screen_of_its_own
from tests.window.performing_hands import PerformingHands
from tests.window.small_performance import build_small_performance

pytestmark = pytest.mark.bench
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
SMALL, LARGE = 4, 60


@pytest.fixture(scope="module")
def analysed(private_places: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two takes with their motion graph."""
    return build_small_performance(tmp_path_factory.mktemp("moves"))


@pytest.fixture
def hands(analysed: Path, tmp_path: Path, open_shell: Callable[[Session], Any]) -> PerformingHands:
    """A window on the graph with key motions."""
    copy = tmp_path / analysed.name
    shutil.copytree(analysed, copy)
    shell = open_shell(Session.open(copy))
    shell.do("performance")
    made = PerformingHands(shell)
    made.ready()
    made.compose(0, 2, 1)
    shell.project.edit(edits.set_forbidden, made.page.state.motions[3].motion, True)
    settle(400)
    return made


class Painted(QObject):
    """Hears when the canvas has been painted with a path."""

    def __init__(self, canvas: Any) -> None:
        super().__init__()
        self.canvas, self.when = canvas, 0.0
        canvas.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Paint first, then note the time."""
        if event.type() == QEvent.Type.Paint:
            self.canvas.removeEventFilter(self)
            QApplication.sendEvent(watched, event)
            self.canvas.installEventFilter(self)
            self.when = time.perf_counter()
            return True
        return False


def grown(state: Any, count: int) -> None:
    """Put a larger graph in place of the one there is: the same analyses, its motions many times, other costs."""
    graph = state.graph
    random = np.random.default_rng(7)
    points = random.normal(size=(count, 3))
    complete = np.linalg.norm(points[:, None] - points, axis=2) + 0.2
    np.fill_diagonal(complete, np.inf)
    chosen = np.arange(count) % len(graph.nodes)
    nodes = tuple(graph.nodes[k] for k in chosen)
    transitions = graph.transitions[np.ix_(chosen, chosen)].copy()
    for a, b in np.argwhere(transitions.min(axis=2) < 0):
        transitions[a, b] = nodes[a].last, nodes[b].first
    base = attrs.evolve(
        graph,
        nodes=nodes,
        complete=complete,
        weights=complete,
        transitions=transitions,
        distances=complete,
        intensities=np.ones(count),
        poor=np.zeros((count, count), bool),
    )
    state.graph = base.pruned(0.9)
    state.motions = [attrs.evolve(state.motions[k], node=number) for number, k in enumerate(chosen)]
    state._nodes = {}
    state.paths, state.placed, state.blends = [], None, None


@pytest.mark.parametrize("count", [SMALL, LARGE])
def test_slider_to_path_lit(hands: PerformingHands, bench: Recorder, count: int) -> None:
    """From the mouse moving the slider to the canvas painted with the path of the new size."""
    page, slider = hands.page, hands.page.database.slider
    if count != SMALL:
        grown(page.state, count)
        page.state.take_results = lambda: None
        page.graph.refresh()
        wait_for(lambda: len(hands.canvas.picture.nodes) == count, 30)
    y = slider.height() // 2

    def x(mu: float) -> float:
        return 7 + (slider.width() - 14) * mu / 2.0

    QTest.mousePress(slider, LEFT, NONE, at(x(0.9), y))
    painted, spent, busy = Painted(hands.canvas), [], []
    for step in range(24):
        mu = 1.0 + 0.03 * (step if step < 12 else 24 - step)
        before = page.trial.result
        painted.when = 0.0
        start, used = time.perf_counter(), time.process_time()
        move_mouse(slider, at(x(mu), y), LEFT, NONE)
        wait_for(lambda before=before, start=start: page.trial.result is not before and painted.when > start, 10)
        spent.append(1e3 * (painted.when - start))
        busy.append(1e3 * (time.process_time() - used))
        settle(30)
    assert page.trial.result is not None
    QTest.mouseRelease(slider, LEFT, NONE, at(x(1.0), y))
    bench.record(
        f"window, mu slider to new path lit, {count} motions",
        float(np.median(spent)),
        asked=50.0,
        unit="ms",
        note=f"wall, worst {max(spent):.0f} ms, CPU {np.median(busy):.0f} ms; {load()}",
    )


def test_a_large_graph_is_drawn(hands: PerformingHands, bench: Recorder) -> None:
    """All of 60 motions with their transitions, anew."""
    grown(hands.page.state, LARGE)
    hands.page.state.take_results = lambda: None
    hands.page.graph.refresh()
    wait_for(lambda: len(hands.canvas.picture.nodes) == LARGE, 30)
    settle(200)

    def draw() -> None:
        hands.canvas.refresh()
        hands.canvas.repaint()

    draw()
    bench.record(
        f"window, motion graph of {LARGE} motions drawn",
        1e3 * cpu_seconds(draw, 9),
        unit="ms",
        note=f"CPU, {len(hands.canvas.picture.edges)} transitions; {load()}",
    )


def test_keys_to_path_lit(hands: PerformingHands, bench: Recorder) -> None:
    """From a changed key motion to its path in the canvas, through the stages."""
    page, spent = hands.page, []
    shell = hands.shell
    shell.project.edit(edits.clear_forbidden)
    hands.found()
    orders = [(0, 2), (0, 1, 2), (2, 1), (1, 3, 0), (3, 2, 0), (0, 3, 1)]
    for order in orders:
        keys = [KeyMotion(page.state.motions[node].motion) for node in order]
        start = time.perf_counter()
        shell.project.edit(edits.set_keys, keys)
        wait_for(lambda order=order: page.state.paths and tuple(hands.path_keys()) == order, 20)
        hands.canvas.repaint()
        spent.append(1e3 * (time.perf_counter() - start))
        settle(300)
    bench.record(
        "window, key motion to path lit, through the stages",
        float(np.median(spent)),
        unit="ms",
        note=f"wall, worst {max(spent):.0f} ms; {load()}",
    )
