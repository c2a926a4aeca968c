"""What hands do in the Motion graph: places of nodes and blocks, waiting for results; the window they work on."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.window.performance.blocks import Block, box
from app.window.shell import Shell
from app.window.timeline.lanes import RULER
from tests.support.once import built_once
from tests.window.conftest import at, settle, wait_for
from tests.window.small_performance import build_small_performance

LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier
WALK, JACK, SQUAT, MARCH = range(4)


class PerformingHands:
    """Works on the Motion graph of a window."""

    def __init__(self, shell: Shell) -> None:
        self.shell, self.page = shell, shell.performance
        self.canvas, self.lane = self.page.graph.canvas, self.page.composed.view

    @property
    def keys(self) -> list[int]:
        """Nodes of the key motions of the document, in order."""
        state = self.page.state
        return [state.motion_node(key.motion) for key in state.document.performance.keys]

    def ready(self) -> None:
        """Wait for the graph and its places."""
        wait_for(lambda: self.page.state.graph is not None and self.canvas.picture.nodes, 60)
        settle(30)

    def place(self, node: int) -> QPoint:
        """Where a node is seen."""
        mark = self.canvas.picture.mark(node)
        assert mark is not None
        return at(*self.canvas.lens.pixel(mark.x, mark.y))

    def click(self, node: int) -> None:
        """Click a node."""
        QTest.mouseClick(self.canvas, LEFT, pos=self.place(node))

    def twice(self, node: int) -> None:
        """Double-click a node."""
        QTest.mouseClick(self.canvas, LEFT, pos=self.place(node))
        QTest.mouseDClick(self.canvas, LEFT, pos=self.place(node))
        QTest.mouseRelease(self.canvas, LEFT, pos=self.place(node))

    def compose(self, *nodes: int) -> None:
        """Double-click nodes in order, and wait for the path."""
        for node in nodes:
            self.twice(node)
        self.found()

    def found(self) -> None:
        """Wait for the path of the key motions as they are, or for why there is none."""
        state = self.page.state
        wait_for(lambda: state.problem or (state.paths and self.path_keys() == self.merged()), 30)
        settle(20)

    def path_keys(self) -> list[int]:
        """Nodes of the key motions on the path."""
        performance = self.page.state.performance
        return [performance.path[place] for place in performance.keys] if performance is not None else []

    def merged(self) -> list[int]:
        """Key motions with equal neighbours together."""
        return [node for place, node in enumerate(self.keys) if not place or self.keys[place - 1] != node]

    def block(self, key: int) -> Block:
        """The block of a key motion."""
        return next(block for block in self.lane.shown.blocks if key in block.keys)

    def on_block(self, key: int) -> tuple[float, float]:
        """A place on the block of a key motion, away from its buttons."""
        left, right = box(self.block(key), self.lane.axis)
        return left + min(30.0, (right - left) / 2), RULER + 12.0

    def on_button(self, key: int, sign: int) -> QPoint:
        """The + or - of a block."""
        _, right = box(self.block(key), self.lane.axis)
        return at(right - (12.0 if sign > 0 else 57.0), RULER + self.lane.heights[0] - 14.0)

    def press(self, key: Qt.Key, keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        """Press a key wherever the focus is."""
        widget = self.shell.focusWidget() or self.shell
        QTest.keyClick(widget, key, keys)


@pytest.fixture(scope="session")
def analysed(tmp_path_factory: pytest.TempPathFactory, private_places: None) -> Path:
    """A project of two takes with its motion graph."""
    return built_once(tmp_path_factory, "moves", build_small_performance)


@pytest.fixture
def hands(analysed: Path, tmp_path: Path, open_shell: Callable[[Session], Shell]) -> PerformingHands:
    """Hands on the Motion graph of a window, the graph in sight."""
    copy = tmp_path / analysed.name
    shutil.copytree(analysed, copy)
    shell = open_shell(Session.open(copy))
    QTest.keyClick(shell, Qt.Key.Key_F3)
    made = PerformingHands(shell)
    made.ready()
    return made


def give_keys(shell: Shell) -> None:
    """Make the window the one with the keys: where there is no screen a menu or a tooltip takes them for good."""
    shell.activateWindow()
    wait_for(shell.isActiveWindow)


def entries(shell: Shell) -> int:
    """How many entries the history has up to the present."""
    assert shell.project is not None
    return shell.project.session.history.present


def undo(hands: PerformingHands) -> None:
    """Ctrl+Z."""
    hands.press(Qt.Key.Key_Z, CONTROL)
