"""What a person does in a whole session, by mouse, keys, drops and dialogs alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QDialog, QFileDialog, QLineEdit, QMessageBox

from app.formats import open_video, write_video
from app.window.canvas.hits import GRAB
from app.window.shell import Shell
from tests.window.conftest import _move, at, drag, hover, settle, wait_for

LEFT = Qt.MouseButton.LeftButton
PLAIN = Qt.KeyboardModifier.NoModifier
CONTROL = Qt.KeyboardModifier.ControlModifier
Place = tuple[float, float]


def begin_of(clip: Path, target: Path, frames: int, shrink: int = 1) -> None:
    """Write the first frames of a clip, made smaller by a whole number, as a clip of its own."""
    source = open_video(clip)
    kept = []
    for frame in range(frames):
        picture = np.asarray(source[frame])
        height, width = (side // shrink for side in picture.shape[:2])
        cells = picture[: height * shrink, : width * shrink].reshape(height, shrink, width, shrink, 3)
        kept.append(np.round(cells.mean((1, 3))).astype(np.uint8))
    source.close()
    write_video(target, kept, 25)


class Hands:
    """Works on a window; places are picture coordinates of the clip."""

    def __init__(self, shell: Shell) -> None:
        self.shell = shell
        self.tracks: dict[str, str] = {}

    @property
    def document(self) -> object:
        """The document in the window."""
        assert self.shell.project is not None
        return self.shell.project.document

    def key(self, key: Qt.Key, keys: Qt.KeyboardModifier = PLAIN) -> None:
        """Press a key."""
        QTest.keyClick(self.shell, key, keys)

    def drop(self, path: Path) -> None:
        """Drop a file on the window."""
        data = QMimeData()
        data.setUrls([QUrl.fromLocalFile(str(path))])
        place, action = QPoint(400, 400), Qt.DropAction.CopyAction
        enter = QDragEnterEvent(place, action, data, LEFT, PLAIN)
        QApplication.sendEvent(self.shell, enter)
        assert enter.isAccepted(), f"{path.name} is not taken"
        QApplication.sendEvent(self.shell, QDropEvent(QPointF(place), action, data, LEFT, PLAIN))

    def answer(self, path: Path, ask: Callable[[], object]) -> None:
        """Do what opens a file dialog, and type a path into it."""
        answered: list[str] = []
        end = time.monotonic() + 30

        def type_() -> None:
            waiting.start(50)  # goes on while a question of the dialog's own keeps this call
            dialog = QApplication.activeModalWidget()
            if isinstance(dialog, QMessageBox) or (isinstance(dialog, QDialog) and time.monotonic() > end):
                answered.clear()  # whatever is asked instead, nobody waits for it for ever
                dialog.reject()
            elif isinstance(dialog, QFileDialog) and not typing:
                typing.append(True)
                field = dialog.findChild(QLineEdit, "fileNameEdit")
                field.setCompleter(None)  # a list of known names would take the Enter key
                field.selectAll()
                QTest.keyClicks(field, str(path))
                answered.append(dialog.windowTitle())
                QTest.keyClick(field, Qt.Key.Key_Return)
                typing.clear()

        typing: list[bool] = []
        waiting = QTimer()
        waiting.setSingleShot(True)
        waiting.timeout.connect(type_)
        waiting.start(50)
        ask()
        waiting.stop()
        assert answered, "no dialog asked"
        self.shell.activateWindow()  # without a screen nobody gives it back the keys
        wait_for(self.shell.isActiveWindow)

    def go(self, frame: int) -> None:
        """Go to a frame by Home and the arrow keys, and wait for its picture."""
        self.key(Qt.Key.Key_Home)
        for _ in range(frame // 10):
            self.key(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
        for _ in range(frame % 10):
            self.key(Qt.Key.Key_Right)
        assert self.shell.project.frame == frame
        wait_for(lambda: self.shell.in_sight().frame == frame)
        settle()

    def quiet(self, seconds: float = 90) -> None:
        """Wait until no work is under way."""
        wait_for(lambda: not self.shell.project.progress, seconds)
        settle()

    def seen(self, name: str) -> Place | None:
        """Where a point is shown in the picture, on the widget."""
        mark = next(each for each in self.shell.video._marks if each.name == self.tracks[name])
        place = mark.at(self.shell.video.frame)
        return None if place is None else self.shell.video.canvas.view.point(*place)

    def at(self, place: Sequence[float]) -> Place:
        """A place of the picture on the widget."""
        return self.shell.video.canvas.view.point(*place)

    def lasso(self, outline: Sequence[Sequence[float]]) -> None:
        """Draw round something with the lasso."""
        self.key(Qt.Key.Key_M)
        canvas = self.shell.video.canvas
        places = [self.at(place) for place in outline]
        QTest.mousePress(canvas, LEFT, PLAIN, at(*places[0]))
        for place in places[1:]:
            _move(canvas, at(*place), LEFT, PLAIN)
        QTest.mouseRelease(canvas, LEFT, PLAIN, at(*places[-1]))

    def click_point(self, name: str, place: Sequence[float]) -> bool:
        """Begin a point with the Point tool; says no where another one is too near to be told apart."""
        wanted = np.asarray(self.at(place))
        others = [self.seen(each) for each in self.tracks]
        if any(np.hypot(*(wanted - other)) < 1.5 * GRAB for other in others if other is not None):
            return False
        count = len(self.document.tracks)
        self.key(Qt.Key.Key_P)
        QTest.mouseClick(self.shell.video.canvas, LEFT, PLAIN, at(*wanted))
        assert len(self.document.tracks) == count + 1, name
        self.tracks[name] = self.document.tracks[-1].id
        return True

    def rename(self, name: str) -> None:
        """Give the selected point a name: F4, the name, Enter."""
        self.key(Qt.Key.Key_F4)
        field = self.shell.video.inspector.name
        QTest.keyClicks(field, name)
        QTest.keyClick(field, Qt.Key.Key_Return)
        assert self.document.track(self.tracks[name]).name == name

    def correct(self, name: str, place: Sequence[float]) -> bool:
        """Drag a point where it belongs; says no where it is hidden, or another one lies over it."""
        here, wanted = self.seen(name), self.at(place)
        if here is None:
            return False
        over = [self.seen(each) for each in self.tracks if each != name]
        if any(np.hypot(*np.subtract(here, other)) < 4 for other in over if other is not None):
            return False
        if np.hypot(*np.subtract(here, wanted)) < 4:
            return False
        self.key(Qt.Key.Key_V)
        drag(self.shell.video.canvas, here, wanted)
        return self.shell.project.frame in self.document.track(self.tracks[name]).clicks

    def choose(self, name: str) -> None:
        """Click a point where it is seen."""
        wait_for(lambda: self.seen(name) is not None)
        QTest.mouseClick(self.shell.video.canvas, LEFT, PLAIN, at(*self.seen(name)))
        assert self.shell.project.track_id == self.tracks[name]

    def select(self, name: str) -> None:
        """Choose a point by Tab, which also finds hidden ones."""
        for _ in self.tracks:
            if self.shell.project.track_id == self.tracks[name]:
                return
            self.key(Qt.Key.Key_Tab)
        assert self.shell.project.track_id == self.tracks[name]

    def contact(self, name: str, first: int, last: int) -> None:
        """Mark a contact with the Contact tool: a click in its first and one in its last frame."""
        self.key(Qt.Key.Key_Escape)
        self.go(first)
        self.key(Qt.Key.Key_C)
        for frame in (first, last):
            self.go(frame)
            self.choose(name)
        self.key(Qt.Key.Key_V)

    # the character -----------------------------------------------------------------------------------------------

    def vertex_place(self, vertex: int) -> Place:
        """Where a vertex is on the 3D view."""
        view = self.shell.character.mesh.viewport
        x, y = view.lens().to_widget(view.vertices[vertex])
        return float(x), float(y)

    def pair(self, pairs: dict[str, int]) -> list[str]:
        """Pair points with vertices by clicking both, as far as both can be clicked from here; gives the paired.

        A vertex beside the wanted one, within a fiftieth of the mesh, will do: so near does a hand come.
        """
        shell, done = self.shell, []
        tracks, view = shell.character.tracks, shell.character.mesh.viewport
        near = 0.02 * float(np.linalg.norm(np.ptp(view.vertices, axis=0)))
        if not tracks.pair_button.isChecked():
            QTest.mouseClick(tracks.pair_button, LEFT)
        for name, vertex in pairs.items():
            clicked = at(*self.vertex_place(vertex))
            found = view.vertex_at((clicked.x(), clicked.y()))
            if found < 0 or np.linalg.norm(view.vertices[found] - view.vertices[vertex]) > near:
                continue
            mark = next(each for each in tracks._marks if each.name == self.tracks[name])
            place = mark.at(shell.character.frame)
            if place is None:
                continue
            QTest.mouseClick(tracks.canvas, LEFT, PLAIN, at(*tracks.canvas.view.point(*place)))
            if shell.project.track_id != self.tracks[name]:
                continue
            QTest.mouseClick(view, LEFT, PLAIN, clicked)
            character = self.document.characters[0]
            assert character.pairs.get(self.tracks[name]) == found, name
            done.append(name)
        return done

    def pair_all(self, pairs: dict[str, int]) -> list[str]:
        """Pair what can be seen, turn the character, go on; gives the paired."""
        done: list[str] = []
        for _ in range(4):
            done += self.pair({name: vertex for name, vertex in pairs.items() if name not in done})
            if len(done) == len(pairs):
                break
            self.turn(90)
        return done

    def pick(self, box: QComboBox, text: str) -> None:
        """Open a list and click one of its lines."""
        QTest.mouseClick(box, LEFT)
        lines = box.view()
        wait_for(lines.isVisible)
        place = lines.visualRect(box.model().index(box.findText(text), 0)).center()
        hover(lines.viewport(), place)
        settle(200)
        QTest.mouseClick(lines.viewport(), LEFT, PLAIN, place)
        settle()

    def turn(self, dx: float, dy: float = 0.0) -> None:
        """Turn the 3D view by a drag beside the character."""
        view = self.shell.character.mesh.viewport
        drag(view, (30, 60), (30 + dx, 60 + dy))
        settle()

    def pull(self, vertex: int, dx: float, dy: float) -> None:
        """Drag a vertex by so many pixels once the mesh follows, and let go."""
        view, live = self.shell.character.mesh.viewport, self.shell.character.posing.live
        x, y = self.vertex_place(vertex)
        solves = live.solves
        drag(view, (x, y), (x + dx, y + dy), release=False)
        wait_for(lambda: live.solves > solves, 60)
        settle()
        QTest.mouseRelease(view, LEFT, PLAIN, at(x + dx, y + dy))

    def motion(self) -> NDArray[np.float64]:
        """The character in every frame as the window shows it, (frames, n, 3)."""
        shell = self.shell
        poses = [shell.character.motion.vertices(frame) for frame in range(shell.project.frame_count)]
        return np.stack([np.array(pose) for pose in poses])

    def solved(self) -> bool:
        """Whether the motion is up to date and nothing runs."""
        project = self.shell.project
        return project.motion_state(project.character_id) == "fresh" and not project.progress
