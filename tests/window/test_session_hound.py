"""The sample performance through the window: from a click to a composed performance that plays and is written."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.window.performance.export_dialog import FORMS, ExportDialog
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for
from tests.window.performing_hands import CONTROL, LEFT, give_keys

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]


@pytest.mark.timeout(1500)
def test_the_sample_performance_is_opened_played_and_written(
    open_shell: Callable[[Session], Shell], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its takes are made, its film is solved, both are cut into motions and composed; nobody has to ask for it."""
    monkeypatch.setenv("HOME", str(tmp_path))
    shell = open_shell(Session.new())
    QTest.keyClick(shell, Qt.Key.Key_F3)
    page = shell.performance
    QTest.mouseClick(page.graph.nothing.sample, LEFT)
    wait_for(lambda: shell.project.document.clip is not None, 30)
    state = page.state
    assert shell.pages.in_sight is page
    assert page.graph.nothing.isVisible()
    wait_for(lambda: not page.graph.nothing.add.isVisible(), 10)
    assert "on its way" in page.graph.nothing.sentence.text()
    wait_for(lambda: len(state.document.sequences) == 2, 120)
    wait_for(lambda: state.document.performance.keys, 1200)
    wait_for(lambda: state.placed is not None and state.blends is not None and not shell.project.progress, 300)
    settle(100)
    names = {each.id: each.name for each in state.document.sequences}
    keyed = [block for block in page.composed.view.shown.blocks if block.keys]
    assert [names[state.motions[block.node].sequence] for block in keyed] == [
        "hound as filmed",
        "hound takes",
        "hound takes",
        "hound as filmed",
    ]
    cuts = [joint for joint in page.composed.view.shown.joints if joint.kind == "cut"]
    assert cuts
    assert max(joint.after for joint in cuts) < 2.0
    assert not shell.project.session.history.modified, "whoever only looks is not asked to save"

    wait_for(lambda: page.preview.shown >= 0, 60)
    give_keys(shell)
    QTest.keyClick(shell, Qt.Key.Key_Home)
    QTest.keyClick(shell, Qt.Key.Key_Space)
    assert state.playback.playing
    wait_for(lambda: page.preview.shown >= 12, 60)
    QTest.keyClick(shell, Qt.Key.Key_Space)
    assert not state.playback.playing

    give_keys(shell)
    QTest.keyClick(shell, Qt.Key.Key_E, CONTROL)
    settle(50)
    dialog = page.findChild(ExportDialog)
    wait_for(lambda: not dialog._still.startswith("Looking"), 60)
    wanted = [name for name, _, _ in FORMS].index("path")
    dialog.form.setFocus()
    while dialog.form.currentIndex() != wanted:
        QTest.keyClick(dialog.form, Qt.Key.Key_Down)
    dialog.place.setFocus()
    dialog.place.selectAll()
    QTest.keyClicks(dialog.place, str(tmp_path / "hound.json"))
    said: list[str] = []
    dialog.done.connect(said.append)
    QTest.mouseClick(dialog.export_button, LEFT)
    wait_for(lambda: said, 60)
    written = json.loads((tmp_path / "hound.json").read_text())
    assert "hound takes" in json.dumps(written)


def test_the_menu_opens_it_and_it_can_be_given_up(open_shell: Callable[[Session], Shell]) -> None:
    """By the project menu; cancelled while its takes are made it leaves the film, and nothing is asked."""
    shell = open_shell(Session.new())
    menu = shell.bar.menu_button.menu()
    menu.popup(shell.mapToGlobal(QPoint(20, 60)))
    settle(30)
    action = next(each for each in menu.actions() if each.text() == "Open the sample performance")
    QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(action).center())
    wait_for(lambda: shell.project.document.clip is not None, 30)
    assert shell.pages.in_sight is shell.performance
    wait_for(lambda: any("takes" in text for _, text in shell.project.progress.values()), 30)
    wait_for(lambda: "on its way" in shell.performance.graph.nothing.sentence.text(), 10)
    give_keys(shell)
    QTest.keyClick(shell, Qt.Key.Key_Escape)
    wait_for(lambda: not shell.project.progress, 60)
    settle(50)
    assert not shell.project.document.sequences
    assert shell.performance.graph.nothing.add.isVisible()
    assert not shell.project.session.history.modified
