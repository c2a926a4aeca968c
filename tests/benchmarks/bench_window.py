"""Figures of the window: CPU milliseconds of drawing, picking, undo; gaps between its ticks under load."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.model.edits import tracks
from tests.benchmarks.record import Recorder, cpu_seconds
from tests.window.conftest import drag, settle, wait_for
from tests.window.conftest import open_shell as open_shell
from tests.window.conftest import private_places as private_places
from tests.window.conftest import qapp as qapp
from tests.window.conftest import session as session
from tests.window.conftest import small_project as small_project

pytestmark = pytest.mark.bench


def ball(subdivisions: int) -> tuple[np.ndarray, np.ndarray]:
    """A ball of 2,562 (4) or 10,242 (5) vertices."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces, np.int32)


@pytest.mark.parametrize(("subdivisions", "asked"), [(4, 20.0), (5, 28.0)])
def test_update(bench: Recorder, qapp: QApplication, subdivisions: int, asked: float) -> None:
    """One update of the mesh at 900 x 700 with handles, paint included, beside the bare render."""
    from app.window.viewport import Handle, Viewport

    vertices, faces = ball(subdivisions)
    view = Viewport("raster")
    view.resize(900, 700)
    view.show()
    view.show_mesh(vertices, faces, None)
    view.fit()
    view.show_handles([Handle(each, "x", tuple(vertices[each]), "ray") for each in range(0, 400, 20)])
    settle(500)

    def update() -> None:
        view.move_mesh(vertices)
        view.repaint()

    def bare() -> None:
        view.scene.move_mesh(vertices)
        view.host.plotter.render_window.Render()

    view._draw(fine=False)
    spent, alone = 1e3 * cpu_seconds(update, 15), 1e3 * cpu_seconds(bare, 15)
    name = f"{len(vertices):,} vertices"
    bench.record(
        f"window: one update, {name}", spent, asked=asked, unit="ms CPU", baseline=alone, baseline_name="bare render"
    )
    bench.record(f"window: update against the bare render, {name}", spent / alone, asked=2.0, unit="x")
    view.close()
    view.deleteLater()


def test_picking(bench: Recorder) -> None:
    """Picking a vertex at 10,242 vertices."""
    from app.window.viewport.orbit import Orbit
    from app.window.viewport.picking import pick_vertex

    vertices, faces = ball(5)
    camera = Orbit((0, 0, 0), 4.0).camera((900, 700))
    spent = 1e3 * cpu_seconds(lambda: pick_vertex(camera, vertices, faces, (450, 350)), 21)
    bench.record("window: picking a vertex, 10,242 vertices", spent, asked=2.0, unit="ms CPU")


def test_drag_and_gaps(
    bench: Recorder, open_shell: Callable[..., object], session: object, small_project: Path
) -> None:
    """A vertex is dragged, released and spreads while the window ticks every 8 ms (wall clock)."""
    shell = open_shell(session)
    shell.do("character")
    wait_for(lambda: shell.character.mesh.viewport is not None and len(shell.character.mesh.viewport.vertices))
    shell.project.show_frame(10)
    settle(500)
    view, character = shell.character.mesh.viewport, shell.project.document.characters[0]
    vertex = next(iter(character.pairs.values()))
    live = shell.character.posing.live
    x, y = view.lens().to_widget(view.vertices[vertex])
    drag(view, (x, y), (x + 4, y), pause=5)
    wait_for(lambda: bool(shell.project.document.characters[0].edits), 60)
    wait_for(lambda: not shell.project.progress, 60)
    settle(300)
    ticks: list[float] = []
    timer = QTimer()
    timer.setInterval(8)
    timer.timeout.connect(lambda: ticks.append(time.perf_counter()))
    timer.start()
    began, solves = time.process_time(), live.solves
    x, y = view.lens().to_widget(view.vertices[vertex])
    drag(view, (x, y), (x + 40, y - 20), steps=25, pause=20)
    spent = time.process_time() - began
    pictures = live.solves - solves
    released = time.perf_counter()
    wait_for(lambda: not shell.project.progress and live._target is None, 60)
    settle(200)
    timer.stop()
    gaps = 1e3 * np.diff(ticks)
    bench.record(
        "window: drag, CPU a solved picture, 1,200 vertices", 1e3 * spent / max(pictures, 1), asked=35.0, unit="ms CPU"
    )
    bench.record(
        "window: ticks while dragging and propagating, p99", float(np.percentile(gaps, 99)), asked=50.0, unit="ms"
    )
    bench.record("window: ticks while dragging and propagating, worst", float(gaps.max()), asked=150.0, unit="ms")
    bench.record("window: release to all 24 frames done", time.perf_counter() - released, unit="s")


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
