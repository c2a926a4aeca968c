"""The column at the right folds to a strip: by itself in a narrow window, and when it is asked to."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.window.fold_away import NARROW
from app.window.settings import settings
from app.window.shell import Shell
from tests.window.clipping import assert_nothing_clipped
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
PAGES = (("video", Qt.Key.Key_F1), ("character", Qt.Key.Key_F2), ("performance", Qt.Key.Key_F3))


@pytest.mark.parametrize(("page", "key"), PAGES)
def test_a_narrow_window_folds_the_column_and_keeps_the_picture(shell: Shell, page: str, key: Qt.Key) -> None:
    """Below 1280 pixels the strip alone is there; above them the column comes back with the width that it had."""
    QTest.keyClick(shell, key)
    wait_for(lambda: shell.pages.currentWidget() is shell.pages.in_sight)
    settle(150)
    aside = shell.pages.in_sight.aside
    assert aside is not None
    wide = aside.width()
    assert not aside.folded
    assert wide > 250
    shell.resize(NARROW - 1, 800)
    settle(150)
    assert aside.folded
    assert aside.width() <= 40
    assert not aside.body.isVisible()
    shell.resize(1440, 900)
    settle(150)
    assert not aside.folded
    assert abs(aside.width() - wide) <= 2


def test_what_was_chosen_is_kept_for_narrow_and_for_wide_windows(
    shell: Shell, open_shell: Callable[[Session], Shell]
) -> None:
    """A press on the strip unfolds it, I folds it; each holds for windows of about that width, also in another run."""
    shell.resize(1100, 720)
    settle(100)
    aside = shell.video.aside
    QTest.mouseClick(aside.strip, LEFT, pos=QPoint(16, 200))
    assert not aside.folded
    shell.resize(1440, 900)
    settle(100)
    QTest.keyClick(shell, Qt.Key.Key_I)
    assert aside.folded
    shell.resize(1100, 720)
    settle(100)
    assert not aside.folded
    assert str(settings().value("folded/video/wide")).lower() == "true"
    other = open_shell(Session.open(shell.project.session.folder.path))
    settle(100)
    assert other.video.aside.folded
    QTest.mouseClick(other.video.aside.strip.button, LEFT)
    assert not other.video.aside.folded
    assert other.character.aside.folded is False, "another page was not asked"


def test_what_is_asked_for_in_a_folded_column_unfolds_it(shell: Shell) -> None:
    """Renaming a point, or choosing the ground, shows the fields for it; the choice is not kept."""
    shell.resize(1100, 720)
    settle(100)
    shell.project.select_track(shell.project.document.tracks[0].id)
    settle(50)
    QTest.keyClick(shell, Qt.Key.Key_F4)
    assert not shell.video.aside.folded
    assert shell.video.inspector.name.hasFocus()
    QTest.keyClicks(shell.video.inspector.name, "black paw")
    QTest.keyClick(shell.video.inspector.name, Qt.Key.Key_Return)
    assert shell.project.document.tracks[0].name == "black paw"
    shell.resize(1101, 720)
    settle(100)
    assert shell.video.aside.folded, "it was unfolded for that one thing"
    QTest.mouseClick(shell.video.tool_buttons["ground"], LEFT)
    assert not shell.video.aside.folded
    assert shell.video.scene.isVisible()


def test_folding_lets_go_of_the_keys(shell: Shell) -> None:
    """A field that is folded away no longer takes what is typed."""
    shell.project.select_track(shell.project.document.tracks[0].id)
    settle(50)
    QTest.keyClick(shell, Qt.Key.Key_F4)
    assert shell.video.inspector.name.hasFocus()
    QTest.mouseClick(shell.video.aside.grip, LEFT)
    assert shell.video.aside.folded
    QTest.keyClick(shell.focusWidget() or shell, Qt.Key.Key_Right)
    assert shell.project.frame == 1


def test_a_small_screen_has_room_for_the_window(shell: Shell) -> None:
    """At 1024 x 700 the window is not larger than asked for, its picture has most of it, and no text is cut off."""
    for page, key in PAGES:
        QTest.keyClick(shell, key)
        shell.resize(1024, 700)
        wait_for(lambda page=page: page != "character" or shell.character.mesh.viewport is not None)
        settle(300)
        wait_for(lambda: shell.at_rest)
        assert (shell.width(), shell.height()) == (1024, 700), page
        assert_nothing_clipped(shell)
    QTest.keyClick(shell, Qt.Key.Key_F1)
    settle(100)
    assert shell.video.canvas.width() > 680
    assert shell.video.canvas.height() > 380
    state = shell.bar.state
    assert state.fontMetrics().horizontalAdvance(state.text()) <= state.width(), "whether it is saved can be read"
