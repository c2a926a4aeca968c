"""Fixtures of the window: a clean Qt for every test, nothing left behind, and a small project to work on."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import hypothesis
import pytest
from PySide6.QtCore import QEventLoop, QPoint, QPointF, Qt, QTimer, qInstallMessageHandler
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.actions.session import Session
from app.window.application import make_application
from app.window.settings import settings
from app.window.shell import Shell
from app.window.viewport import hosts
from app.window.viewport.hosts import Choice
from tests.support.once import built_once
from tests.window.small_project import build_small_project

hypothesis.settings.register_profile("window", deadline=None)
hypothesis.settings.load_profile("window")
VIEWPORT: Choice = "gl" if os.environ.get("MOTIONWRIGHT_VIEWPORT") == "gl" else "raster"
"""What draws in 3D; OpenGL needs a screen."""
HARMLESS = ("propagateSizeHints", "does not support raise()", "does not support grabbing the keyboard")
"""What Qt says of windows without a screen, not of the program."""


@pytest.fixture(scope="session", autouse=True)
def private_places(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Settings and unsaved projects of the tests stay away from the user's own."""
    patch = pytest.MonkeyPatch()
    for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):
        patch.setenv(name, str(tmp_path_factory.mktemp(name)))
    yield
    patch.undo()


@pytest.fixture(autouse=True)
def nothing_remembered(private_places: None) -> None:
    """What one test chose (a form of export, a look, a key) is not what the next begins with."""
    settings().clear()


@pytest.fixture(scope="session")
def screen_of_its_own(private_places: None) -> Iterator[bool]:
    """On a screen only one window has the keys: every process of the tests has a virtual screen where there are any.

    Yields whether the screen is this process's alone. Without ``Xvfb``, or on a screen that was asked for with
    ``MOTIONWRIGHT_SCREEN=given``, the processes take turns.
    """
    virtual = shutil.which("Xvfb")
    if os.environ.get("QT_QPA_PLATFORM") != "xcb" or not virtual or os.environ.get("MOTIONWRIGHT_SCREEN") == "given":
        yield os.environ.get("QT_QPA_PLATFORM") == "offscreen"
        return
    heard, said = os.pipe()
    server = subprocess.Popen(
        [virtual, "-displayfd", str(said), "-screen", "0", "1920x1200x24", "-nolisten", "tcp"],
        pass_fds=[said],
        stderr=subprocess.DEVNULL,
    )
    # After Qt, which ends the process when its screen goes first.
    atexit.register(server.wait)
    atexit.register(server.terminate)  # the last named goes first
    os.close(said)
    with os.fdopen(heard) as answer:
        number = answer.readline().strip()
    assert number, "the virtual screen did not start"
    patch = pytest.MonkeyPatch()
    patch.setenv("DISPLAY", f":{number}")
    yield True
    patch.undo()


@pytest.fixture(scope="session")
def qapp(private_places: None, screen_of_its_own: bool) -> QApplication:
    """The application as users get it: typeface, look, icons."""
    return make_application()


@pytest.fixture(autouse=True)
def no_qt_warnings() -> Iterator[None]:
    """Whatever Qt complains about fails the test."""
    heard: list[str] = []

    def hear(kind: object, context: object, text: str) -> None:
        if not any(word in text for word in HARMLESS):
            heard.append(text)

    before = qInstallMessageHandler(hear)
    yield
    qInstallMessageHandler(before)
    assert not heard, f"Qt complained: {heard}"


@pytest.fixture(autouse=True)
def nothing_left(qapp: QApplication) -> Iterator[None]:
    """No thread, no running timer, no top-level window and no open render window may outlive a test."""
    threads = set(threading.enumerate())
    yield
    for _ in range(3):
        qapp.processEvents()
        qapp.sendPostedEvents(None, 52)
    gc.collect()
    # What is left now is the libraries and what tests share: the next search need not go through it again.
    gc.freeze()
    end = time.monotonic() + 3
    while (left := [each for each in threading.enumerate() if each not in threads]) and time.monotonic() < end:
        time.sleep(0.02)
    assert not left, f"threads left behind: {left}"
    windows = [each for each in qapp.topLevelWidgets() if each.isVisible()]
    assert not windows, f"windows left open: {windows}"
    timers = [each for widget in qapp.topLevelWidgets() for each in widget.findChildren(QTimer) if each.isActive()]
    assert not timers, f"timers still run: {timers}"
    renderers = [each for widget in qapp.topLevelWidgets() for each in widget.findChildren(QWidget, "render host")]
    assert all(each.property("finished") for each in renderers), "a render window is still open"


@pytest.fixture(autouse=True)
def keys_of_its_own(
    qapp: QApplication, screen_of_its_own: bool, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[None]:
    """On a screen that processes share, a test waits until the one of another process has ended."""
    if screen_of_its_own:
        yield
        return
    import fcntl

    with (tmp_path_factory.getbasetemp().parent / "display.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@pytest.fixture(scope="session")
def small_project(tmp_path_factory: pytest.TempPathFactory, private_places: None) -> Path:
    """A project folder with a short clip, tracks, contacts, known cameras and a paired character; all solved."""
    return built_once(tmp_path_factory, "small", build_small_project)


@pytest.fixture
def session(small_project: Path, tmp_path: Path) -> Session:
    """A session on a copy of the small project; the window closes it."""
    copy = tmp_path / small_project.name
    shutil.copytree(small_project, copy)
    return Session.open(copy)


@pytest.fixture
def open_shell(qapp: QApplication, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Session], Shell]]:
    """Opens a window on a session, and closes it without asking."""
    monkeypatch.setattr("app.window.files.ask_unsaved", lambda *_: "discard")
    opened: list[Shell] = []

    def open_(session: Session) -> Shell:
        shell = Shell(session, viewport=VIEWPORT)
        opened.append(shell)
        if VIEWPORT == "gl":
            hosts.await_opengl(shell)
        shell.resize(1440, 900)
        shell.show()
        QTest.qWaitForWindowExposed(shell)
        shell.activateWindow()  # where no window manager gives it the keys
        QTest.qWaitForWindowActive(shell)
        wait_for(lambda: shell.at_rest)
        return shell

    yield open_
    for shell in opened:
        shell.close()
        shell.deleteLater()
    qapp.processEvents()


@pytest.fixture
def shell(open_shell: Callable[[Session], Shell], session: Session) -> Shell:
    """The window on the small project."""
    shell = open_shell(session)
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    return shell


def wait_for(ready: Callable[[], object], seconds: float = 20.0) -> None:
    """Let the window live until something is so; fails when it takes too long."""
    end = time.monotonic() + seconds
    while not ready():
        assert time.monotonic() < end, "what was waited for did not come"
        settle(5)


def settle(milliseconds: int = 30) -> None:
    """Let the window live for a moment, and the other threads with it: ``QTest.qWait`` holds the interpreter's lock."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def at(x: float, y: float) -> QPoint:
    """A widget place."""
    return QPointF(x, y).toPoint()


def drag(
    widget: QWidget,
    start: tuple[float, float],
    end: tuple[float, float],
    *,
    steps: int = 6,
    keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
    release: bool = True,
    pause: int = 0,
) -> None:
    """Press, move in steps and release, as a hand does."""
    button = Qt.MouseButton.LeftButton
    QTest.mousePress(widget, button, keys, at(*start))
    for step in range(1, steps + 1):
        share = step / steps
        place = at(start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        _move(widget, place, button, keys)
        if pause:
            settle(pause)
    if release:
        QTest.mouseRelease(widget, button, keys, at(*end))


def hover(widget: QWidget, place: QPoint) -> None:
    """Move the mouse over a widget with nothing pressed; on a real screen moving the pointer takes its time."""
    _move(widget, place, Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier)


def _move(widget: QWidget, place: QPoint, button: Qt.MouseButton, keys: Qt.KeyboardModifier) -> None:
    from PySide6.QtCore import QEvent
    from PySide6.QtGui import QMouseEvent

    event = QMouseEvent(
        QEvent.Type.MouseMove, QPointF(place), QPointF(widget.mapToGlobal(place)), Qt.MouseButton.NoButton, button, keys
    )
    QApplication.sendEvent(widget, event)
