"""Starting the window: the application, its look, what Qt has to say, and loading the slow libraries behind it."""

from __future__ import annotations

import contextlib
import gc
import importlib
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QMessageLogContext, QTimer, QtMsgType, qInstallMessageHandler
from PySide6.QtWidgets import QApplication

from app.window import fonts, icons, settings, theme
from app.window.plain_imports import use_plain_imports
from imitation.errors import InputError

if TYPE_CHECKING:
    from app.actions.session import Session
    from app.window.viewport.hosts import Choice

PICTURE = ("app.window.viewport.scene", "app.window.character", "app.window.performance")
"""What the first 3D picture and the first look at a page need."""
SLOW = ("scipy.sparse.linalg", "cv2", "numba", "imitation.deformation.deformer")
"""What the first drag needs."""
PAUSE = 1.5
"""Seconds between the two: whoever goes straight to a character gets its picture first."""
messages: list[str] = []


def _heard(kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
    messages.append(text)
    if kind in (QtMsgType.QtCriticalMsg, QtMsgType.QtFatalMsg):
        sys.stderr.write(text + "\n")


def make_application() -> QApplication:
    """The application with its look; the one that runs already is taken."""
    running = QApplication.instance()
    application = running if isinstance(running, QApplication) else QApplication(sys.argv[:1])
    application.setApplicationName("Motionwright")
    application.setDesktopFileName("motionwright")
    application.setWindowIcon(icons.application_icon())
    fonts.apply(application)
    theme.apply(application, theme.THEMES.get(str(settings.settings().value("look", "dark")), theme.DARK))
    return application


def load_slow_libraries(viewport: Choice = "auto") -> threading.Thread:
    """Load in a thread what the first 3D picture and, a while later, what the first drag will need."""
    from app.window.viewport import hosts

    chosen = hosts.choose(viewport)
    if viewport == "auto":
        settings.remember_graphics_card(chosen == "gl")
    host = ("app.window.viewport.gl_host",) if chosen == "gl" else ()

    def load() -> None:
        for names, pause in (((*PICTURE[:1], *host, *PICTURE[1:]), PAUSE), (SLOW, 0.0)):
            for name in names:
                with contextlib.suppress(ImportError):
                    importlib.import_module(name)
            gc.freeze()  # each search through all of them would hold up the window for a fifth of a second
            time.sleep(pause)

    thread = threading.Thread(target=load, name="libraries", daemon=True)
    thread.start()
    return thread


def open_window(path: Path | None = None, *, sample: bool = False, viewport: Choice | None = None) -> int:
    """Open the window on a project (or the sample, or an empty one) and run until it is closed; gives the exit code.

    A path that is no project is taken into an empty one; what cannot be opened is told in the window.
    """
    _need_a_screen()
    use_plain_imports()
    os.environ.setdefault("QT_API", "pyside6")
    qInstallMessageHandler(_heard)
    with _kept():
        application = make_application()
        from app.window.shell import Shell

        session, refused = _first(path, sample)
        choice = viewport or settings.viewport()
        shell = Shell(session, viewport=choice)
        if settings.expects_opengl(choice):
            from app.window.viewport import hosts

            hosts.await_opengl(shell)
        geometry = settings.settings().value("geometry")
        if geometry is not None:
            shell.restoreGeometry(geometry)
        shell.show()
    if refused is not None and path is not None:
        shell.care.refuse(path, refused)
    elif path is not None and not session.titled:
        shell.files.take(path)
    shell.care.offer_never_saved()
    _after(lambda: load_slow_libraries(choice))
    return application.exec()


@contextlib.contextmanager
def _kept() -> Iterator[None]:
    """Look for no garbage while everything that is made stays; what there is then is never looked through again."""
    gc.disable()
    try:
        yield
        gc.freeze()
    finally:
        gc.enable()


def _need_a_screen() -> None:
    """Raise ``InputError`` where Qt would end the program: Linux without a screen, and nothing said about it."""
    told = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"))
    if sys.platform == "linux" and not told:
        raise InputError(
            "There is no screen for a window: start a desktop session, or use the command line (motionwright --help)."
        )


def _first(path: Path | None, sample: bool) -> tuple[Session, Exception | None]:
    """The project to begin with, and why the one that was asked for cannot be opened."""
    from app.actions.session import Session

    if path is None and sample:
        from app.window.sample import sample_session

        return sample_session(), None
    if path is None:
        return Session.new(), None
    from app.actions.kinds import kind_of

    try:
        known = kind_of(path)
        return (Session.new() if known not in ("project", "") else Session.open(path)), None
    except (InputError, OSError) as error:
        return Session.new(), error


def _after(call: Callable[[], object]) -> None:
    QTimer.singleShot(200, lambda: call())
