"""A window on a small performance, and the hands that work in its parts."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.actions import performing
from app.actions.session import Session
from app.model.edits import performance
from app.model.performance import KeyMotion
from app.window.shell import Shell
from tests.support.once import built_once
from tests.window.conftest import settle, wait_for
from tests.window.small_performance import build_small_performance

LEFT, PLAIN = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture(scope="session")
def composed_project(tmp_path_factory: pytest.TempPathFactory, private_places: None) -> Path:
    """Two sequences, three key motions, everything computed."""
    analysed = built_once(tmp_path_factory, "moves", build_small_performance)
    return built_once(tmp_path_factory, "composed", lambda folder: _compose(analysed, folder / analysed.name))


def _compose(analysed: Path, path: Path) -> Path:
    shutil.copytree(analysed, path)
    session = Session.open(path)
    graph: Any = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    walk = next(each for each in named if each.name.startswith("Walk"))
    gym = next(each for each in named if each.name.startswith("Gym"))
    keys = [KeyMotion(walk.motion), KeyMotion(gym.motion), KeyMotion(walk.motion)]
    session.apply(performance.set_keys(session.document, keys))
    session.apply(performance.set_mu(session.document, 50.0))
    session.apply(performance.set_smoothing(session.document, align=True, blend=True))
    session.result(session.stages.blends)
    session.save()
    session.close()
    return path


@pytest.fixture
def composed(composed_project: Path, tmp_path: Path, open_shell: Callable[[Session], Shell]) -> Shell:
    """The window on a copy of it, the Motion graph in sight and at rest."""
    copy = tmp_path / composed_project.name
    shutil.copytree(composed_project, copy)
    shell = open_shell(Session.open(copy))
    QTest.keyClick(shell, Qt.Key.Key_F3)
    part = shell.pages.in_sight
    wait_for(lambda: part.preview.shown >= 0 and not shell.project.progress, 60)
    settle(50)
    return shell


def drop(widget: QWidget, path: Path) -> None:
    """Drop a file or folder on a widget."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    place, action = QPoint(40, 60), Qt.DropAction.CopyAction
    enter = QDragEnterEvent(place, action, data, LEFT, PLAIN)
    QApplication.sendEvent(widget, enter)
    assert enter.isAccepted(), f"{path.name} is not taken"
    QApplication.sendEvent(widget, QDropEvent(QPointF(place), action, data, LEFT, PLAIN))


def quiet(shell: Shell, seconds: float = 60.0) -> None:
    """Wait until no work is under way."""
    settle(30)
    wait_for(lambda: not shell.project.progress, seconds)
    settle(30)


def label_of(shell: Shell) -> str | None:
    """What undo would take back."""
    return shell.project.session.history.undo_label


def pick(menu: Any, text: str) -> None:
    """Choose an entry of an open menu by the mouse."""
    action = next(each for each in menu.actions() if each.text() == text)
    assert action.isEnabled(), text
    menu.popup(QPoint(20, 20))
    settle(20)
    QTest.mouseClick(menu, LEFT, PLAIN, menu.actionGeometry(action).center())
    settle(20)
