"""Figures of the window: its start, drawing, picking, scrubbing, playing, undo. See bench_window_work for the rest."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from app.model.edits import tracks
from tests.benchmarks.record import Recorder, cpu_seconds
from tests.window.conftest import private_places as private_places
from tests.window.conftest import qapp as qapp
from tests.window.conftest import screen_of_its_own as screen_of_its_own
from tests.window.conftest import session as session
from tests.window.conftest import settle, wait_for
from tests.window.conftest import small_project as small_project
from tests.window.large_project import FRAMES, SIZE, number_in, striped

pytestmark = pytest.mark.bench

START = """
import sys, time
began = time.perf_counter()
from pathlib import Path
from PySide6.QtCore import QEvent, QObject, QTimer
from app.window import application
make, seen = application.make_application, {}


class Watch(QObject):
    def eventFilter(self, thing, event):
        if event.type() == QEvent.Type.Paint and type(thing).__name__ == "Shell" and "window" not in seen:
            seen["window"] = time.perf_counter(), time.process_time()
            QTimer.singleShot(0, lambda: look(thing))
        return False


def made():
    running = make()
    seen["watch"] = Watch(running)
    running.installEventFilter(seen["watch"])
    return running


def look(shell):
    shell.do("character")
    timer = QTimer(shell)
    seen["timer"] = timer
    timer.timeout.connect(lambda: done(shell))
    timer.start(5)


def done(shell):
    view = shell.character.mesh.viewport
    if view is not None and view.host.renders and len(view.vertices):
        seen["timer"].stop()
        picture = time.perf_counter(), time.process_time()
        print("times", *(value for wall, cpu in (seen["window"], picture) for value in (wall - began, cpu)))
        shell.close()


application.make_application = made
application.open_window(Path(sys.argv[1]))
"""


def load() -> str:
    """How busy the machine is, said beside figures of the wall clock."""
    return f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"


def ball(subdivisions: int) -> tuple[np.ndarray, np.ndarray]:
    """A ball of 2,562 (4) or 10,242 (5) vertices."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces, np.int32)


def test_start(bench: Recorder, small_project: Path, tmp_path: Path) -> None:
    """A fresh process that opens a project: the window on the screen, and the first 3D picture after a change to it.

    Byte code is kept from one start to the next, as an installation keeps it; the first round writes it.
    """
    kept = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path)}
    kept.pop("PYTHONDONTWRITEBYTECODE", None)
    rounds = []
    for _ in range(4):
        now = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", START, str(small_project)], capture_output=True, text=True, timeout=120, env=kept
        )
        whole = time.perf_counter() - now
        line = next((row for row in done.stdout.splitlines() if row.startswith("times")), "")
        assert line, f"the window did not come in {whole:.0f} s: {done.stderr[-500:]}"
        rounds.append([float(value) for value in line.split()[1:]])
    window, window_cpu, picture, picture_cpu = np.median(rounds[1:], axis=0)
    note = (
        f"wall clock, warm, without the interpreter's own start; CPU {window_cpu:.2f} and {picture_cpu:.2f} s; {load()}"
    )
    bench.record("window: on the screen", window, asked=0.8, unit="s", note=note)
    bench.record("window: 3D picture", picture, asked=2.5, unit="s", note=note)


@pytest.mark.parametrize(("subdivisions", "asked"), [(4, 20.0), (5, 28.0)])
def test_update(bench: Recorder, qapp: QApplication, subdivisions: int, asked: float) -> None:
    """One update of the mesh at 900 x 700 with handles, paint included, beside the bare render of the same picture."""
    from app.window.viewport import Handle, Viewport

    vertices, faces = ball(subdivisions)
    window, view = QWidget(), Viewport("raster")
    column = QVBoxLayout(window)
    column.setContentsMargins(0, 0, 0, 0)
    column.addWidget(view)
    window.resize(900, 700)
    window.show()
    view.show_mesh(vertices, faces, None)
    view.fit()
    view.show_handles([Handle(each, "x", tuple(vertices[each]), "ray") for each in range(0, 400, 20)])
    settle(500)

    def update() -> None:
        count = view.host.renders
        view.move_mesh(vertices)
        while view.host.renders == count:
            qapp.processEvents()

    def bare() -> None:
        view.scene.move_mesh(vertices)
        view.host.stage.render_window.Render()

    view._draw(fine=False)
    spent, alone = 1e3 * cpu_seconds(update, 25), 1e3 * cpu_seconds(bare, 25)
    name = f"{len(vertices):,} vertices"
    bench.record(
        f"window: one update, {name}", spent, asked=asked, unit="ms CPU", baseline=alone, baseline_name="bare render",
        note=load(),
    )  # fmt: skip
    bench.record(f"window: update against the bare render, {name}", spent / alone, asked=2.0, unit="x")
    view.finish()
    window.close()
    window.deleteLater()


def test_picking(bench: Recorder) -> None:
    """Picking a vertex at 10,242 vertices."""
    from app.window.viewport.orbit import Orbit
    from app.window.viewport.picking import pick_vertex

    vertices, faces = ball(5)
    camera = Orbit((0, 0, 0), 4.0).camera((900, 700))
    spent = 1e3 * cpu_seconds(lambda: pick_vertex(camera, vertices, faces, (450, 350)), 21)
    bench.record("window: picking a vertex, 10,242 vertices", spent, asked=2.0, unit="ms CPU")


def test_mesh_over_video(bench: Recorder, qapp: QApplication) -> None:
    """How far balls lie from where an odd camera sees them: centroids of drawn pixels and of K [R | T] X."""
    from app.window.viewport import Viewport
    from app.window.viewport.orbit import Orbit
    from imitation.geometry import Camera

    view = Viewport("raster")
    view.resize(600, 450)
    view.show()
    base = Orbit((0, 0, 1), 4.5, 0.5, 0.25).camera((600, 450))
    camera = Camera([[700.0, 0, 333.0], [0, 660.0, 190.0], [0, 0, 1]], base.R, base.T)
    picture = QImage(600, 450, QImage.Format.Format_RGB32)
    picture.fill(QColor(0, 0, 0))
    vertices, faces = ball(3)
    random, away = np.random.default_rng(1), []
    for centre in random.uniform((-0.6, -0.6, 0.5), (0.6, 0.6, 1.5), (12, 3)):
        view.show_mesh(0.12 * vertices + centre, faces, None)
        view.show_camera(camera, picture)
        view.look("camera")
        settle()
        view._draw(fine=True)
        rows = view.host._rows[::-1, :, 3].astype(float)
        ys, xs = np.mgrid[: rows.shape[0], : rows.shape[1]]
        seen = (np.array([(rows * xs).sum(), (rows * ys).sum()]) / rows.sum() + 0.5) / (rows.shape[1] / 600)
        # The middle of a ball's outline is not its centre's projection: the tilted cone makes an ellipse.
        wanted = _centroid(camera.project(0.12 * vertices + centre) + 0.5)
        away.append(float(np.linalg.norm(seen - wanted)))
    bench.record(
        "window: mesh over video, worst of 12", max(away), asked=0.05, unit="px", note=f"mean {np.mean(away):.3f}"
    )
    view.close()
    view.deleteLater()


def _centroid(points: np.ndarray) -> np.ndarray:
    """Centroid (2,) of the outline of projected points (n, 2)."""
    from scipy.spatial import ConvexHull

    ring = points[ConvexHull(points).vertices]
    following = np.roll(ring, -1, axis=0)
    cross = ring[:, 0] * following[:, 1] - following[:, 0] * ring[:, 1]
    centre: np.ndarray = ((ring + following) * cross[:, None]).sum(0) / (3 * cross.sum())
    return centre


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A film of 540p whose pictures carry their number, a key frame every twelve."""
    from app.formats import write_video

    path = tmp_path_factory.mktemp("film") / "numbers.mp4"
    write_video(path, striped(FRAMES), 25, count=FRAMES, gop=12)
    return path


@pytest.fixture
def loader(qapp: QApplication, film: Path) -> Iterator[object]:
    """The window's decoder on it."""
    from app.formats import open_video
    from app.window.frames import FrameLoader

    source = open_video(film)
    made = FrameLoader(lambda: source, FRAMES)
    made.source = source
    yield made
    made.close()


def number_of(picture: QImage) -> int:
    """The number that a picture carries."""
    rows = picture.convertToFormat(QImage.Format.Format_RGB888)
    data = np.frombuffer(rows.constBits(), np.uint8).reshape(SIZE[1], rows.bytesPerLine())
    return number_in(data[:, : 3 * SIZE[0]].reshape(SIZE[1], SIZE[0], 3))


def test_scrub(bench: Recorder, loader: object) -> None:
    """From the wish to the picture in hand: a kept frame, the next one, a random cold one; every number is checked."""
    got: dict[int, tuple[float, QImage]] = {}
    loader.loaded.connect(lambda frame, picture: got.update({frame: (time.perf_counter(), picture)}))
    wrong = 0

    def ask(frame: int) -> float:
        nonlocal wrong
        got.clear()
        began = time.perf_counter()
        picture = loader.request(frame)
        if picture is None:
            wait_for(lambda: frame in got)
            ended, picture = got[frame]
        else:
            ended = time.perf_counter()
        wrong += number_of(picture) != frame
        return 1e3 * (ended - began)

    ask(0)
    settle(1000)
    random = np.random.default_rng(2)
    following = [ask(frame) for frame in range(1, 60)]
    kept = [ask(frame) for frame in range(59, 50, -1) for _ in range(4)]
    cold = []
    for frame in random.permutation(np.arange(80, FRAMES, 9)):
        settle(400)
        loader._kept.clear()
        for cache in (loader.source._decoded, loader.source._shown):
            cache.clear()
        cold.append(ask(int(frame)))
    for name, values, asked in (("cached", kept, 8.0), ("next", following, 15.0), ("random, cold", cold, 80.0)):
        note = f"95 of 100 within {np.percentile(values, 95):.1f} ms; {load()}"
        bench.record(f"window: scrub 540p, {name}", float(np.median(values)), asked=asked, unit="ms", note=note)
    bench.record(
        "window: wrong frames while scrubbing", wrong, asked=0, unit="frames", note=f"of {len(kept + following + cold)}"
    )


def test_playing(bench: Recorder, qapp: QApplication, loader: object) -> None:
    """Three seconds at the source's speed: playing against the clock, and how many frames were left out."""
    from app.window.playback import Playback

    shown: list[tuple[float, int, QImage]] = []
    at = {"frame": 0}
    loader.loaded.connect(lambda frame, picture: shown.append((time.perf_counter(), frame, picture)))
    playback = Playback(qapp, lambda: at["frame"])

    def due(frame: int) -> None:
        at["frame"] = frame
        picture = loader.request(frame)
        if picture is not None:
            shown.append((time.perf_counter(), frame, picture))

    playback.due.connect(due)
    loader.request(0)
    settle(800)
    shown.clear()
    began = time.perf_counter()
    playback.play(0, FRAMES - 1, 25.0)
    settle(3000)
    playback.stop()
    settle(100)
    late = [moment - began - frame / 25.0 for moment, frame, _ in shown]
    frames = [frame for _, frame, _ in shown]
    assert all(number_of(picture) == frame for _, frame, picture in shown[::5])
    assert frames == sorted(frames), "playing never goes back"
    bench.record(
        "window: playing 540p, a picture's lateness", 1e3 * float(np.median(late)), asked=40.0, unit="ms", note=load()
    )
    # Until the last picture that came: the clip may end before the three seconds do.
    speed = frames[-1] / 25.0 / (shown[-1][0] - began)
    bench.record("window: playing 540p, speed", speed, asked=0.97, better="higher", unit="x the source's")
    bench.record(
        "window: playing 540p, frames left out", 1 - len(set(frames)) / (frames[-1] + 1), unit="share", note=load()
    )


def test_undo(bench: Recorder, session: object) -> None:
    """1,000 edits: undo of all is exact, and one undo takes little."""
    start = session.document
    track = start.tracks[0].id
    for step in range(1000):
        session.apply(tracks.set_click(session.document, track, 8, (100 + step * 0.01, 80.0)))
    began = time.process_time()
    while session.history.undo_label is not None:
        session.undo()
    spent = 1e3 * (time.process_time() - began) / 1000
    assert session.document == start
    bench.record("window: one undo of 1,000 edits", spent, asked=1.0, unit="ms CPU")
    session.close()
