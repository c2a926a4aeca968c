"""Opening and closing leaves nothing behind, however often."""

from __future__ import annotations

import gc
import shutil
import threading
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QObject, QTimer
from PySide6.QtWidgets import QApplication

from app.actions.session import Session
from app.window.shell import Shell
from app.window.viewport import Viewport
from tests.support.once import built_once
from tests.window.conftest import settle, wait_for
from tests.window.small_performance import build_small_performance

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
ROUNDS, WARM = 10, 3


def alive() -> Counter[str]:
    """Threads, Qt objects and render windows that Python knows of."""
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    for _ in range(3):
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        QApplication.processEvents()
        gc.collect()
    found: Counter[str] = Counter(threads=threading.active_count())
    for each in gc.get_objects():
        try:
            kind = type(each)
            if issubclass(kind, vtkRenderWindow):
                found["render windows"] += 1
            elif issubclass(kind, Shell | Viewport | QTimer | Session):
                found[kind.__name__] += 1
            elif issubclass(kind, QObject):
                found["Qt objects"] += 1
        except ReferenceError:
            continue
    return found


def test_ten_windows_leave_nothing(session: Session, qapp: QApplication, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each shows the video, then the character in 3D, and is closed: from the third on nothing is more than before."""
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda *_: "discard")
    place: Path = session.folder.path
    session.close()
    del session

    def look(shell: Shell) -> None:
        wait_for(lambda: not shell.video.canvas.picture.isNull())
        shell.do("character")
        wait_for(lambda: shell.character.mesh.viewport and len(shell.character.mesh.viewport.vertices))

    open_and_close(place, look)


def test_ten_motion_graphs_leave_nothing(
    qapp: QApplication, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each shows the graph, composes, plays what is composed in 3D, and is closed while it is still placed."""
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda *_: "discard")
    analysed = built_once(tmp_path_factory, "moves", build_small_performance)
    place = shutil.copytree(analysed, tmp_path / analysed.name)

    def look(shell: Shell) -> None:
        page = shell.performance
        shell.do("performance")
        wait_for(lambda: page.graph.canvas.picture.nodes, 60)
        for node in (0, 2):
            page.editing.append(node)
        wait_for(lambda: page.state.placed is not None and page.preview.shown >= 0, 60)
        shell.do("play")
        settle(60)
        page.editing.append(1)

    open_and_close(place, look)


def open_and_close(place: Path, look: Callable[[Shell], None]) -> None:
    """Open windows one after the other, look at something in each, and count what is left of them."""
    counts: list[Counter[str]] = []
    for _ in range(ROUNDS):
        shell = Shell(Session.open(place), viewport="raster")
        shell.resize(1200, 760)
        shell.show()
        look(shell)
        settle(20)
        shell.close()
        shell.deleteLater()
        del shell
        counts.append(alive())
    after = counts[WARM:]
    assert all(count["Shell"] <= 1 and count["render windows"] <= 1 for count in after), counts
    for name in set().union(*after):
        values = [count[name] for count in after]
        assert values[-1] <= values[0], f"{name} grow: {values}"
