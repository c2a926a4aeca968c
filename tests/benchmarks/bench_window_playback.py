"""Figures of the preview: captured frames of 15,000 vertices, each with faces of its own, played in 3D."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from app.actions import performing
from app.actions.performing_playback import ShownFrame, sequence_shown
from app.actions.session import Session
from app.formats.tvm import FrameMesh, write_mesh_frames
from app.window.performance.preview import Preview
from app.window.performance.state import PerformanceState
from app.window.project import Project
from resources.performer import Part, perform
from tests.benchmarks.bench_window import load
from tests.benchmarks.record import Recorder, cpu_seconds
from tests.window.conftest import private_places as private_places
from tests.window.conftest import qapp as qapp
from tests.window.conftest import screen_of_its_own as screen_of_its_own
from tests.window.conftest import settle, wait_for

pytestmark = pytest.mark.bench
FRAMES, SECONDS = 45, 3.0
SIZE = (430, 440)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """PLY files of a walk."""
    capture = perform([Part("walk", 3)], fps=30, seed=1, cell=0.0132)
    target = tmp_path_factory.mktemp("take") / "walk"
    frames = (FrameMesh(*capture.mesh(frame)) for frame in range(FRAMES))
    write_mesh_frames(target, frames, form="ply", fps=30, count=FRAMES)
    return target


@pytest.fixture
def preview(qapp: QApplication, take: Path, tmp_path: Path) -> Iterator[Preview]:
    """The preview as large as in a window of 1440 x 900, with its first frame in sight."""
    session = Session.new(tmp_path / "film")
    performing.add_sequence(session, take, fps=30.0, up="z", unit=1.0)
    project, state = Project(session), PerformanceState()
    state.attach(project)
    made = Preview(state, "raster")
    made.resize(*SIZE)
    made.show()
    state.show_source(session.document.sequences[0].id, 0)
    made.refresh()
    wait_for(lambda: made.shown >= 0)
    settle(600)
    yield made
    state.playback.stop()
    made.finish()
    made.close()
    made.deleteLater()
    project.close()


@pytest.mark.parametrize("fps", [10.0, 30.0])
def test_playback(bench: Recorder, preview: Preview, fps: float) -> None:
    """Three seconds: how many frames a second are seen from the first to the last, how many are left out, how late."""
    state, late, when = preview.state, [], []
    state.playback.play(0, FRAMES - 1, fps)
    began, last, rounds = time.perf_counter(), 0, 0

    def drawn(place: int) -> None:
        nonlocal last, rounds
        rounds += place < last
        last = place
        when.append(time.perf_counter())
        late.append(when[-1] - began - (rounds * FRAMES + place) / fps)

    preview.drawn.connect(drawn)
    count, cpu = preview.view.viewport.host.renders, time.process_time()
    settle(int(1000 * SECONDS))
    cpu, shown = time.process_time() - cpu, preview.view.viewport.host.renders - count
    state.playback.stop()
    vertices = len(preview.frame.vertices)
    name = f"window: playback of {round(vertices, -3):,} vertices a frame at {fps:g} fps"
    left = preview.dropped.dropped
    worst = f"{1e3 * np.median(late):.0f} ms late, 90 % within {1e3 * np.percentile(late, 90):.0f}"
    note = f"{left} of {left + preview.dropped.shown} left out, {worst}; {load()}"
    bench.record(name, (len(when) - 1) / (when[-1] - when[0]), asked=0.97 * fps, better="higher", unit="fps", note=note)
    bench.record(f"{name}, one frame", 1e3 * cpu / max(shown, 1), asked=1000 / fps, unit="ms CPU", note=load())


def test_one_frame(bench: Recorder, qapp: QApplication, preview: Preview) -> None:
    """A frame at hand to its picture, beside a mesh made anew in the usual way; and what the thread does for it."""
    session = preview.state.project.session
    frames = sequence_shown(session, preview.state.sequence_id)
    ready: list[ShownFrame] = [frames[place] for place in range(8)]
    viewport, turn = preview.view.viewport, iter(range(10**6))

    def streamed() -> None:
        count = viewport.host.renders
        preview.stage.show(ready[next(turn) % 8], elapsed=0.03, moving=True)
        while viewport.host.renders == count:
            qapp.processEvents()

    spent = 1e3 * cpu_seconds(streamed, 25)
    reading = 1e3 * cpu_seconds(lambda: frames[next(turn) % FRAMES], 25)
    preview.stage.clear()

    def anew() -> None:
        count, frame = viewport.host.renders, ready[next(turn) % 8]
        viewport.show_mesh(frame.vertices, frame.faces, frame.colours)
        while viewport.host.renders == count:
            qapp.processEvents()

    usual = 1e3 * cpu_seconds(anew, 15)
    viewport.clear_mesh()
    bench.record(
        "window: a frame of a capture to its picture, 15,000 vertices", spent, asked=33.0, unit="ms CPU",
        baseline=usual, baseline_name="a mesh made anew", note=f"the thread reads and prepares it in {reading:.1f} ms",
    )  # fmt: skip
