"""A window that is killed in the midst of work: the next one asks, and brings the work back."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.formats import write_video

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]

BEGIN = """
import sys
from pathlib import Path
from PySide6.QtCore import QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from app.window import application
from app.window.shell import Shell

application.load_slow_libraries = lambda viewport: None
application.make_application()

def the_shell():
    return next(each for each in QApplication.topLevelWidgets() if isinstance(each, Shell))

def when(ready, then):
    def look():
        shell = the_shell()
        return then(shell) if ready(shell) else QTimer.singleShot(20, look)
    QTimer.singleShot(20, look)
"""

WORK = """
def click(shell):
    shell.care.autosaver.start(50)
    shell.do("tool_point")
    QTest.mouseClick(shell.video.canvas, Qt.MouseButton.LeftButton, pos=QPoint(300, 200))
    when(lambda shell: shell.project.session.folder.autosave_file.exists(), say)

def say(shell):
    print(shell.project.session.folder.path, flush=True)

when(lambda shell: not shell.video.canvas.picture.isNull(), click)
application.open_window(Path(sys.argv[1]), viewport="raster")
"""

AGAIN = """
def recover(shell):
    notice = next(iter(shell.care.notices.open.values()))
    print(notice.sentence.text(), flush=True)
    QTest.mouseClick(notice.buttons["Recover"], Qt.MouseButton.LeftButton)
    when(lambda shell: shell.project.document.tracks and not shell.video.canvas.picture.isNull(), end)

def end(shell):
    print(len(shell.project.document.tracks), shell.bar.state.text(), flush=True)
    application.settings.settings()
    import app.window.files as files
    files.ask_unsaved = lambda *_: "discard"
    shell.close()

when(lambda shell: shell.care.notices.open, recover)
path = Path(sys.argv[1]) if len(sys.argv) > 1 else None
raise SystemExit(application.open_window(path, viewport="raster"))
"""


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """A short video of noise that moves."""
    picture = np.random.default_rng(0).integers(40, 215, (180, 332, 3), np.uint8)
    write_video(tmp_path / "dog.mp4", [np.ascontiguousarray(picture[:, t : t + 320]) for t in range(6)], 25)
    return tmp_path / "dog.mp4"


@pytest.fixture
def home(tmp_path: Path) -> dict[str, str]:
    """A user with settings and unsaved projects of their own."""
    places = {name: str(tmp_path / name) for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME")}
    return {**os.environ, **places, "QT_QPA_PLATFORM": "offscreen"}


def kill_at_work(path: Path, home: dict[str, str]) -> Path:
    """Open a window on a path, click a point, and kill it once that was autosaved; gives the project's folder."""
    with subprocess.Popen(
        [sys.executable, "-c", BEGIN + WORK, str(path)], env=home, stdout=subprocess.PIPE, text=True
    ) as window:
        assert window.stdout is not None
        place = Path(window.stdout.readline().strip())
        window.send_signal(signal.SIGKILL)
    assert (place / "autosave.json").is_file()
    return place


def start_again(home: dict[str, str], *arguments: str) -> list[str]:
    """Open a window that answers Recover; gives what it says."""
    again = subprocess.run(
        [sys.executable, "-c", BEGIN + AGAIN, *arguments],
        env=home,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert again.returncode == 0, again.stderr
    return again.stdout.splitlines()


def test_a_killed_window_on_a_new_film(clip: Path, home: dict[str, str]) -> None:
    """Nobody had chosen a place yet: the next start offers the project, with its film and its point."""
    place = kill_at_work(clip, home)
    asked, told = start_again(home)
    assert "has no place yet" in asked
    assert "dog: 1 point, 1 click" in asked
    assert told.startswith("1 ")
    assert "not saved yet" in told
    assert not place.exists(), "the person threw it away when asked"


def test_a_killed_window_on_a_saved_project(clip: Path, home: dict[str, str], tmp_path: Path) -> None:
    """The project opens as it was saved and asks; recovered, it has unsaved changes."""
    from contextlib import closing

    from app.actions import bringing
    from app.actions.session import Session

    with closing(Session.new(tmp_path / "walk")) as session:
        bringing.add_clip(session, clip)
        session.save()
    place = kill_at_work(session.folder.path, home)
    asked, told = start_again(home, str(place))
    assert "This project has work that was not saved" in asked
    assert told.startswith("1 ")
    assert "unsaved changes" in told
