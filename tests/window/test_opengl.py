"""The view that OpenGL draws, for machines with a graphics card; tried on a screen only (make screen)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions.session import Session
from app.window import settings
from app.window.shell import Shell
from app.window.viewport import hosts
from tests.window import conftest
from tests.window.conftest import drag, settle, wait_for

FIRST = 60.0
"""Seconds the first view may take on a busy machine: pyvista and matplotlib are loaded for it."""
pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]


@pytest.fixture
def shell(
    qapp: QApplication,
    monkeypatch: pytest.MonkeyPatch,
    open_shell: Callable[[Session], Shell],
    session: Session,
) -> Shell:
    """A window whose 3D views are OpenGL's."""
    if QApplication.platformName() != "xcb":
        pytest.skip("OpenGL needs a screen: make screen")
    monkeypatch.setattr(conftest, "VIEWPORT", "gl")
    shell = open_shell(session)
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    return shell


def test_the_window_is_not_made_anew(shell: Shell) -> None:
    """The first OpenGL view comes into the window that is there; it keeps the keys, and every key still works."""
    before = shell.winId()
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: _drawn(shell), FIRST)
    assert shell.winId() == before
    assert shell.isActiveWindow()
    assert shell.character.mesh.viewport.host.name == "OpenGL"
    QTest.keyClick(shell, Qt.Key.Key_X)
    wait_for(lambda: len(shell.character.mesh.panes.panes) == 2)
    QTest.keyClick(shell, Qt.Key.Key_F1)
    assert shell.pages.currentWidget() is shell.video


def test_a_character_is_seen_and_turned(shell: Shell) -> None:
    """What stands on the screen is a lit body before a plain ground, and another view of it after a drag."""
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: _drawn(shell), FIRST)
    viewport = shell.character.mesh.viewport
    settle(400)
    first = _on_screen(shell)
    assert first.std() > 8, "the view is empty"
    middle = viewport.width() / 2, viewport.height() / 2
    rendered = viewport.host.renders
    drag(viewport, (middle[0] + 150, 40), (middle[0] + 20, 90), pause=20)
    wait_for(lambda: viewport.host.renders > rendered)
    settle(400)
    turned = _on_screen(shell)
    assert np.abs(first - turned).mean() > 1, "the view did not turn"


def test_the_character_fades_over_the_film(shell: Shell) -> None:
    """Looking through the camera, O mixes what the screen shows of the character with the film behind it, as asked."""
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: _drawn(shell), FIRST)
    QTest.keyClick(shell, Qt.Key.Key_1)
    wait_for(lambda: shell.character.mesh.viewport.through_camera)
    viewport = shell.character.mesh.viewport
    seen = {}
    for opacity in (1.0, 0.5, 0.0):
        viewport.mesh_opacity = opacity
        viewport.redraw()
        settle(400)
        seen[opacity] = _on_screen(shell)
    body = np.abs(seen[1.0] - seen[0.0]) > 30
    assert body.sum() > 100, "the character is not before the film"
    mixed = (seen[1.0] + seen[0.0]) / 2
    assert np.abs(seen[0.5] - mixed)[body].mean() < 3


def test_a_card_that_was_found_is_remembered(qapp: QApplication) -> None:
    """The next window is made for OpenGL where one was found, and never where the processor alone was chosen."""
    assert not settings.expects_opengl("auto")
    assert settings.expects_opengl("gl")
    settings.remember_graphics_card(True)
    assert settings.expects_opengl("auto")
    assert not settings.expects_opengl("raster")
    settings.remember_graphics_card(False)
    assert not settings.expects_opengl("auto")


def test_a_platform_without_opengl_is_left_alone(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """Waiting for it there changes nothing."""
    shell = open_shell(session)
    before = shell.children()
    if QApplication.platformName() in hosts.WITHOUT_OPENGL:
        hosts.await_opengl(shell)
        assert shell.children() == before


def _drawn(shell: Shell) -> bool:
    """Whether the 3D view is there, with a mesh, and drawn."""
    viewport = shell.character.mesh.viewport
    return viewport is not None and len(viewport.vertices) > 0 and viewport.host.renders > 0


def _on_screen(shell: Shell) -> np.ndarray:
    """Grey of what the screen shows of the middle of the 3D view."""
    viewport = shell.character.mesh.viewport
    corner = viewport.mapToGlobal(viewport.rect().topLeft())
    picture = shell.screen().grabWindow(0, corner.x(), corner.y(), viewport.width(), viewport.height())
    image = picture.toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[image.height() // 4 : -image.height() // 4, : image.width()].astype(np.float64)
