"""How the window begins: what is made and read before it is seen, and what waits until it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.actions import performing
from app.actions.session import Session
from app.stages.stage import Stage
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for
from tests.window.small_performance import write_take

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]


def test_a_page_is_made_when_it_is_first_shown(shell: Shell) -> None:
    """Only what is seen is there at first; what a key brings belongs to the open project and its frame."""
    assert set(shell.pages.workspaces) == {"video"}
    shell.project.show_frame(5)
    wait_for(lambda: shell.shown is not None and shell.shown[0] == 5)
    QTest.keyClick(shell, Qt.Key.Key_F2)
    assert set(shell.pages.workspaces) == {"video", "character"}
    assert shell.pages.currentWidget() is shell.character
    assert shell.character.project is shell.project
    assert shell.character.frame == 5
    QTest.keyClick(shell, Qt.Key.Key_F3)
    wait_for(lambda: shell.pages.currentWidget() is shell.pages.workspaces.get("performance"))
    assert shell.performance.project is shell.project
    QTest.keyClick(shell, Qt.Key.Key_F2)
    assert shell.pages.currentWidget() is shell.character


def test_a_page_of_many_parts_is_made_in_steps(shell: Shell) -> None:
    """The window lives between them; whoever needs the page now has it whole, and shown."""
    QTest.keyClick(shell, Qt.Key.Key_F3)
    assert set(shell.pages.workspaces) == {"video"}, "it was made in one go"
    assert shell.pages.currentWidget() is shell.video
    assert shell.bar.tabs["performance"].isChecked()
    QTest.keyClick(shell, Qt.Key.Key_F1)
    settle(50)
    assert shell.pages.currentWidget() is shell.video, "another page was asked for meanwhile"
    QTest.keyClick(shell, Qt.Key.Key_F3)
    page = shell.performance
    assert shell.pages.currentWidget() is page
    assert page.project is shell.project


def test_a_window_closed_while_a_page_is_made(shell: Shell) -> None:
    """What is half made is closed with the rest."""
    QTest.keyClick(shell, Qt.Key.Key_F3)
    shell.close()
    settle(50)
    assert "performance" in shell.pages.workspaces


def test_making_a_page_opens_no_window(shell: Shell, qapp: QApplication) -> None:
    """No part of a page is shown on its own before it lies in its place, and the keys stay with the window."""
    seen: list[str] = []

    class Watch(QObject):
        def eventFilter(self, thing: QObject, event: QEvent) -> bool:
            if event.type() == QEvent.Type.Show and isinstance(thing, QWidget) and thing.isWindow():
                seen.append(type(thing).__name__)
            return False

    watch = Watch()
    qapp.installEventFilter(watch)
    for key in (Qt.Key.Key_F2, Qt.Key.Key_F3):
        QTest.keyClick(shell, key)
        wait_for(lambda: shell.pages.currentWidget() is shell.pages.in_sight)
        settle(50)
    qapp.removeEventFilter(watch)
    assert set(shell.pages.workspaces) == {"video", "character", "performance"}
    assert not seen
    assert shell.isActiveWindow()


def test_a_page_made_later_speaks_to_the_window(shell: Shell) -> None:
    """Where it is to propagate, and where to go, is heard also from a page that was not there at the start."""
    keeper = shell.opened.keeper
    assert keeper.propagate_on_release
    shell.do("character")
    shell.character.inspector.automatic.click()
    assert not keeper.propagate_on_release
    shell.character.inspector.go.emit(7)
    assert shell.project.frame == 7
    folder = shell.project.session.folder.path
    shell.open_session(Session.open(folder))
    assert not shell.opened.keeper.propagate_on_release, "another project goes on as it was chosen"


def test_results_are_read_once_the_window_is_seen(
    qapp: object, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before it is on the screen no track is read; afterwards its marks are there without being asked for."""
    read: list[Stage] = []
    get = session.cache.get
    monkeypatch.setattr(session.cache, "get", lambda stage: (read.append(stage), get(stage))[1])
    shell = Shell(session, viewport="raster")
    try:
        shell.refresh()
        assert not shell.video._marks
        assert not read
        shell.show()
        assert not read, "showing it reads nothing either: that waits for the first paint"
        wait_for(lambda: len(shell.video._marks) == len(session.document.tracks))
    finally:
        shell.close()
        shell.deleteLater()


def test_takes_without_a_film_begin_in_the_motion_graph(open_shell: Callable[[Session], Shell], tmp_path: Path) -> None:
    """The page of the clip is not made for a project that has none."""
    session = Session.new(tmp_path / "takes")
    performing.add_sequence(session, write_take(tmp_path, "Walk"), name="Walk")
    shell = open_shell(session)
    wait_for(lambda: shell.pages.currentWidget() is shell.pages.workspaces.get("performance"))
    assert set(shell.pages.workspaces) == {"performance"}
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)
