"""Figures of long work in the window: drags, what a release starts, cancelling, corrections, and the ticks meanwhile.

The projects are long ones of 2,500 and 10,000 vertices (``tests.window.large_project``); events are a mouse's.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions.session import Session
from app.model.edits import tracks
from tests.benchmarks.bench_window import load
from tests.benchmarks.record import Recorder
from tests.window.conftest import _move as move_mouse
from tests.window.conftest import at, settle, wait_for
from tests.window.conftest import open_shell as open_shell
from tests.window.conftest import private_places as private_places
from tests.window.conftest import qapp as qapp
from tests.window.conftest import screen_of_its_own as screen_of_its_own
from tests.window.large_project import build_large_project

pytestmark = pytest.mark.bench
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier


@pytest.fixture(scope="module", params=[2500, 10000])
def large(request: pytest.FixtureRequest, private_places: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A long project of a size."""
    return build_large_project(tmp_path_factory.mktemp("large"), request.param)


class Ticks:
    """A heartbeat of 8 ms; the gaps between its beats say how long the window was deaf."""

    def __init__(self) -> None:
        self._times: list[float] = []
        self._timer = QTimer()
        self._timer.setInterval(8)
        self._timer.timeout.connect(lambda: self._times.append(time.perf_counter()))
        self._timer.start()

    def stop(self) -> np.ndarray:
        """End, and give all gaps, ms."""
        self._timer.stop()
        return 1e3 * np.diff(self._times)


class Hand:
    """Drags a vertex of the character in sight and measures what follows."""

    def __init__(self, shell: Any) -> None:
        self.shell, self.view, self.live = shell, shell.character.mesh.viewport, shell.character.posing.live
        self.posed = 0
        self.live.posed.connect(self._count)
        self.partials: list[tuple[int, float]] = []
        shell.project.partial.connect(lambda stage, value: self.partials.append((value[0], time.perf_counter())))

    def _count(self, *values: object) -> None:
        self.posed += 1

    def free_vertices(self) -> list[int]:
        """Vertices in sight that are far from all paired ones, the farthest first."""
        from app.window.viewport.picking import pick_vertex

        view, paired = self.view, list(self.shell.project.document.characters[0].pairs.values())
        away = np.linalg.norm(view.vertices[:, None] - view.vertices[paired], axis=2).min(axis=1)
        camera, found = view.lens().camera, []
        for vertex in np.argsort(-away)[:200].tolist():
            x, y = view.lens().to_widget(view.vertices[vertex])
            if pick_vertex(camera, view.vertices, view.faces, (float(x), float(y))) == vertex:
                found.append(vertex)
        return found

    def take(self, vertex: int) -> None:
        """Press the button on a vertex."""
        x, y = (float(value) for value in self.view.lens().to_widget(self.view.vertices[vertex]))
        self._place = x, y
        QTest.mousePress(self.view, LEFT, NONE, at(x, y))

    def carry(self, dx: float, dy: float, steps: int = 25) -> tuple[list[float], list[float]]:
        """Move what is held; wall and CPU milliseconds from each event to the new picture."""
        view, wall, cpu = self.view, [], []
        x, y = self._place
        for step in range(1, steps + 1):
            place = at(x + dx * step / steps, y + dy * step / steps)
            posed, drawn = self.posed, view.host.renders
            began, spent = time.perf_counter(), time.process_time()
            move_mouse(view, place, LEFT, NONE)
            if not view.dragging or not view._drag._dragging:
                continue  # the first pixels are no drag yet
            while self.posed == posed or view.host.renders == drawn:
                QApplication.processEvents()
                time.sleep(0.0005)
                assert time.perf_counter() - began < 20, "the mesh does not follow"
            wall.append(1e3 * (time.perf_counter() - began))
            cpu.append(1e3 * (time.process_time() - spent))
        self._place = x + dx, y + dy
        return wall, cpu

    def ready(self) -> bool:
        """Whether nothing is being prepared for the release."""
        return not self.shell.character.posing.calls._threads

    def release(self) -> float:
        """Let go; the moment."""
        self.partials.clear()
        moment = time.perf_counter()
        QTest.mouseRelease(self.view, LEFT, NONE, at(*self._place))
        return moment

    def done(self) -> bool:
        """Whether nothing is under way."""
        return not self.shell.project.progress and self.live._target is None


@pytest.fixture
def hand(open_shell: Callable[..., Any], large: Path, tmp_path: Path) -> Hand:
    """The window on a copy of the project, in the Character workspace, warm."""
    copy = tmp_path / large.name
    shutil.copytree(large, copy)
    shell = open_shell(Session.open(copy))
    shell.do("character")
    wait_for(lambda: shell.character.mesh.viewport is not None and len(shell.character.mesh.viewport.vertices))
    wait_for(lambda: shell.character.posing.calls._threads == set(), 120)
    shell.project.show_frame(120)
    settle(500)
    return Hand(shell)


def test_drag_and_release(bench: Recorder, hand: Hand) -> None:
    """A vertex without a track is dragged and let go: live pictures, first neighbour, the whole clip, the ticks."""
    size = f"{len(hand.view.vertices):,} vertices"
    small = len(hand.view.vertices) < 5000
    ticks = Ticks()
    hand.take(hand.free_vertices()[0])
    first_wall, _ = hand.carry(10.0, -5.0, 10)
    wait_for(hand.ready, 120)
    wall, cpu = hand.carry(20.0, -10.0)
    note = (
        f"wall clock {np.median(wall):.0f} ms; while the release is prepared "
        f"{np.median(first_wall):.0f}, the very first {first_wall[0]:.0f}; {load()}"
    )
    asked = 35.0 if small else 70.0
    bench.record(
        f"window: drag, event to picture, {size}", float(np.median(cpu)), asked=asked, unit="ms CPU", note=note
    )
    spent, moment = time.process_time(), hand.release()
    wait_for(lambda: len(hand.partials) > 1 and hand.done(), 300)
    spent, whole = time.process_time() - spent, max(when for _, when in hand.partials) - moment
    frames = sorted(frame for frame, _ in hand.partials)
    assert frames == list(range(1, 240)), "every frame but the first comes once"
    first = next(when for frame, when in hand.partials if frame != 120) - moment
    gaps = ticks.stop()
    bench.record(
        f"window: release to the first neighbour, {size}", first, asked=0.2 if small else None, unit="s",
        note=f"wall clock; {load()}",
    )  # fmt: skip
    bench.record(
        f"window: release to all 240 frames, two passes, {size}", spent, asked=4.0 if small else None, unit="s CPU",
        note=f"all threads, drawing included; wall clock {whole:.1f} s; {load()}",
    )  # fmt: skip
    note = f"wall clock; half within {np.median(gaps):.0f} ms; {load()}"
    for name, value, asked in (("p99", np.percentile(gaps, 99), 50.0), ("worst", gaps.max(), 150.0)):
        bench.record(
            f"window: ticks while dragging and propagating, {name}, {size}",
            float(value),
            asked=asked,
            unit="ms",
            note=note,
        )


def test_cancel_while_scrubbing(bench: Recorder, hand: Hand) -> None:
    """While the edit of a key point spreads the frames are scrubbed, then all work is cancelled."""
    shell, size = hand.shell, f"{len(hand.view.vertices):,} vertices"
    key = list(shell.project.document.characters[0].pairs.values())[3]
    hand.take(key)
    hand.carry(20.0, -10.0, 8)
    wait_for(hand.ready, 120)
    hand.release()
    wait_for(lambda: len(hand.partials) > 2, 120)
    ticks = Ticks()
    for frame in range(121, 141):
        shell.project.show_frame(frame)
        settle(10)
        if not shell.project.progress:
            break
    gaps = ticks.stop()
    note = f"wall clock; {load()}"
    name = "window: ticks while scrubbing and propagating"
    bench.record(f"{name}, p99, {size}", float(np.percentile(gaps, 99)), asked=50.0, unit="ms", note=note)
    bench.record(f"{name}, worst, {size}", float(gaps.max()), asked=150.0, unit="ms", note=note)
    if shell.project.progress:
        moment = time.perf_counter()
        shell.do("cancel_work")
        wait_for(lambda: not shell.project.progress)
        bench.record(f"window: cancelled, {size}", time.perf_counter() - moment, asked=0.1, unit="s", note=note)


def test_scrubbing(bench: Recorder, hand: Hand) -> None:
    """Frames whose pictures are in memory, one after the other with nothing under way: film, pose, marks and lanes."""
    shell, spent = hand.shell, []
    wait_for(lambda: not shell.character.checks.measuring, 120)
    for frame in (125, 130, 135, 140, 130, 120):
        shell.project.show_frame(frame)
        settle(300)
    for _ in range(3):
        for frame in (*range(121, 141), *range(139, 119, -1)):
            began = time.thread_time()
            shell.project.show_frame(frame)
            for _ in range(4):
                QApplication.processEvents()
            spent.append(1e3 * (time.thread_time() - began))
    bench.record(
        f"window: a frame shown beside its character, {len(hand.view.vertices):,} vertices",
        float(np.median(spent)),
        unit="ms CPU",
        note=f"the window's own thread; {load()}",
    )


def test_correction(bench: Recorder, qapp: QApplication, private_places: None) -> None:
    """The built-in sample: a click between two spans of 50 and 30 frames is moved; until the new path is there."""
    from app.window.sample import sample_session

    session = sample_session()
    try:
        known = session.document.tracks[0]
        session.result(session.stages.flow)
        place = session.result(session.stages.track(known.id)).positions  # type: ignore[attr-defined]
        session.apply(tracks.add_track(session.document, 0, tuple(place[0]), name="measured"))
        track = session.document.tracks[-1].id
        session.apply(tracks.set_click(session.document, track, 50, tuple(place[50])))
        session.result(session.stages.track(track))
        wall, cpu = [], []
        for step in range(1, 8):
            began, spent = time.perf_counter(), time.process_time()
            session.apply(tracks.set_click(session.document, track, 50, (place[50, 0] + step, place[50, 1])))
            session.result(session.stages.track(track))
            wall.append(1e3 * (time.perf_counter() - began))
            cpu.append(1e3 * (time.process_time() - spent))
    finally:
        session.close()
    note = f"81 frames of 540p, flow ready; CPU {np.median(cpu):.0f} ms; {load()}"
    bench.record("window: a correction to its new path", float(np.median(wall)), asked=250.0, unit="ms", note=note)
