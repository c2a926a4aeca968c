"""The preview: the performance in 3D at its own rate, compared, with ghosts; and the thread that reads ahead."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions.performing_playback import ready
from app.actions.session import Session
from app.formats.tvm import FrameMesh
from app.window.performance.player import Dropped, FrameReader, ahead
from app.window.performance.preview_notes import cut_near
from app.window.playback import Course, Playback
from app.window.shell import Shell
from imitation.errors import InputError
from tests.window.conftest import drag, settle, wait_for
from tests.window.performance_parts import LEFT, quiet
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


def first_cut(shell: Shell) -> int:
    """The first frame after the first cut between two motions."""
    placed = shell.pages.in_sight.state.placed
    return next(cut.position for cut in placed.performance.cuts if cut.kind == "cut")


def test_it_plays_at_its_own_rate(composed: Shell) -> None:
    """Space plays and pauses; two seconds show the frames of two seconds, in order, and what is left out is counted."""
    page = composed.pages.in_sight
    preview, state = page.preview, page.state
    state.show_position(0)
    drawn: list[tuple[float, int]] = []
    preview.drawn.connect(lambda place: drawn.append((time.perf_counter(), place)))
    QTest.keyClick(composed, Qt.Key.Key_Space)
    assert state.playback.playing
    began = time.perf_counter()
    settle(2000)
    QTest.keyClick(composed, Qt.Key.Key_Space)
    passed = time.perf_counter() - began
    assert not state.playback.playing
    places = [place for _, place in drawn]
    assert places == sorted(places)
    assert abs(places[-1] - passed * state.fps) <= 3
    counted = preview.dropped
    assert counted.shown + counted.dropped == pytest.approx(places[-1] - places[0], abs=2)
    assert "15 fps" in preview.rate.text()


def test_being_late_once_makes_nothing_later(qapp: QApplication) -> None:
    """Frames are due at whole multiples from the start: after a late one the next comes at its own time."""
    owner, at = QObject(), {"frame": 0}
    playback = Playback(owner, lambda: at["frame"])
    playback.due.connect(lambda frame: at.update(frame=frame))
    playback.play(0, 500, 10.0)

    class Late:
        def nsecsElapsed(self) -> int:
            return 372_000_000

    playback._clock = Late()
    playback._tick()
    assert at["frame"] == 3
    assert playback._timer.interval() == 28
    playback.stop()
    assert not playback._timer.isActive()


def test_what_is_drawn_is_what_was_composed(composed: Shell) -> None:
    """The mesh, its colours and its place are those of the frame; another frame takes its place in the scene."""
    from app.actions.performing_frames import performance_frames

    page = composed.pages.in_sight
    frames = performance_frames(composed.project.session)
    for place in (0, first_cut(composed), len(frames) - 1):
        page.state.show_position(place)
        wait_for(lambda place=place: page.preview.shown == place)
        shown, truth = page.preview.frame, frames[place]
        np.testing.assert_allclose(shown.vertices, truth.vertices, atol=1e-5)
        np.testing.assert_array_equal(shown.faces, truth.faces)
        assert shown.colours is not None
        data = page.preview.stage._mesh._data
        assert data.GetNumberOfPoints() == len(truth.vertices)
        assert data.GetNumberOfPolys() == len(truth.faces)


def test_cuts_are_compared(composed: Shell) -> None:
    """Blended, placed, as filmed: three buttons; the seam is named with its scores, and as filmed it stands out."""
    page = composed.pages.in_sight
    cut = first_cut(composed)
    page.state.show_position(cut)
    wait_for(lambda: page.preview.shown == cut)
    note = cut_near(page.state, cut)
    assert note is not None
    assert note.position == cut
    assert note.filmed > 5 * note.placed
    blended = page.preview.frame.vertices.copy()
    QTest.mouseClick(page.preview.mode_buttons["filmed"], LEFT)
    sequence, frame = page.state.placed.performance.frames[cut]
    from app.actions.performing_frames import sequence_footage

    filmed = sequence_footage(composed.project.session, composed.project.document.sequences[sequence].id)[int(frame)]

    def shows(vertices: np.ndarray) -> bool:
        shown = page.preview.frame.vertices
        return shown.shape == vertices.shape and bool(np.abs(shown - vertices).max() < 1e-5)

    wait_for(lambda: shows(filmed.vertices))
    QTest.mouseClick(page.preview.mode_buttons["placed"], LEFT)
    assert page.state.before
    wait_for(lambda: not shows(filmed.vertices))
    QTest.mouseClick(page.preview.mode_buttons["blended"], LEFT)
    assert not page.state.before
    wait_for(lambda: shows(blended))
    quiet(composed)


def test_ghosts_orbit_follow_and_fit(composed: Shell) -> None:
    """G shows both sides of a cut; the mouse turns the view; the view goes along with the performer, or stays."""
    page = composed.pages.in_sight
    preview, state = page.preview, page.state
    cut = first_cut(composed)
    state.show_position(cut + 1)
    wait_for(lambda: preview.shown == cut + 1)
    QTest.keyClick(composed, Qt.Key.Key_G)
    assert preview.ghost_button.isChecked()
    assert preview._ghost_places() == [cut - 1, cut]
    wait_for(lambda: preview.reader.frame(cut - 1) is not None and preview.reader.frame(cut) is not None)
    wait_for(lambda: all(ghost._there for ghost in preview.stage._ghosts))
    QTest.keyClick(composed, Qt.Key.Key_G)
    wait_for(lambda: not any(ghost._there for ghost in preview.stage._ghosts))
    viewport = preview.view.viewport
    before = viewport.orbit
    drag(viewport, (150, 100), (220, 120))
    assert viewport.orbit.azimuth != before.azimuth
    target = viewport.orbit.target
    state.show_position(cut + 12)
    wait_for(lambda: preview.shown == cut + 12)
    assert viewport.orbit.target != target
    assert viewport.orbit.target[2] == target[2]
    QTest.mouseClick(preview.follow_button, LEFT)
    target = viewport.orbit.target
    state.show_position(0)
    wait_for(lambda: preview.shown == 0)
    assert viewport.orbit.target == target
    preview.fit()
    middle = 0.5 * (preview.frame.low + preview.frame.high)
    np.testing.assert_allclose(viewport.orbit.target, middle, atol=1e-6)


def test_an_edit_keeps_the_picture_until_the_next_is_there(composed: Shell) -> None:
    """While a new path is placed the one before stays in sight; without key motions a sentence says what to do."""
    from app.model.edits import performance

    page = composed.pages.in_sight
    keys = composed.project.document.performance.keys
    composed.project.edit(performance.remove_key, 0)
    assert page.preview.frame is not None
    quiet(composed)
    wait_for(lambda: page.preview.shown >= 0)
    composed.project.edit(performance.set_keys, [])
    quiet(composed)
    assert page.preview.frame is None
    assert "Choose motions in the graph" in page.preview.view.waiting.text()
    composed.project.edit(performance.set_keys, keys)
    quiet(composed)
    wait_for(lambda: page.preview.frame is not None)


def test_an_empty_project_says_what_comes_here(open_shell: Callable[[Session], Shell]) -> None:
    """Without sequences there is a sentence instead of a view, and nothing to press."""
    shell = open_shell(Session.new())
    QTest.keyClick(shell, Qt.Key.Key_F3)
    preview = shell.pages.in_sight.preview
    assert preview.view.waiting.isVisible()
    assert preview.view.waiting.text() == "Add a sequence to see it here."
    assert preview.view.viewport is None
    assert not preview.play_button.isEnabled()
    assert not any(button.isEnabled() for button in preview.mode_buttons.values())


# the thread that reads ahead -------------------------------------------------------------------------------------


class Slow:
    """Frames that are read one at a time when they are let through."""

    def __init__(self, count: int) -> None:
        self.count, self.read = count, []
        self.gate = threading.Semaphore(0)

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, position: int) -> Any:
        self.gate.acquire()
        if position == 7:
            raise InputError("Frame 7 is damaged.")
        self.read.append(position)
        vertices = np.array([[position, 0, 0], [1, 0, 0], [0, 1, 0]], float)
        return ready(FrameMesh(vertices, np.array([[0, 1, 2]], np.int32)), 0, position)


@pytest.fixture
def reader(qapp: QApplication) -> Iterator[FrameReader]:
    """A reader that keeps four of these frames."""
    made = FrameReader(memory=400)
    yield made
    made.close()


def test_the_newest_wish_is_read_first_and_memory_is_bounded(reader: FrameReader) -> None:
    """Wishes that are outdated are dropped; what was shown longest ago goes first; frames outside are not read."""
    source = Slow(100)
    arrived: list[int] = []
    reader.arrived.connect(arrived.append)
    reader.open(lambda: source)
    reader.want([0, 1, 2, 3])
    settle(30)
    reader.want([50, 51, 52, 500])
    for _ in range(10):
        source.gate.release()
    wait_for(lambda: len(arrived) >= 4)
    settle(30)
    assert source.read == [0, 50, 51, 52]
    assert reader.frame(52) is not None
    assert reader._held <= 400
    other = Slow(5)
    reader.open(lambda: other)
    assert reader.frame(52) is None
    reader.want([1])
    other.gate.release()
    wait_for(lambda: reader.frame(1) is not None)


def test_a_damaged_frame_is_told_once(reader: FrameReader) -> None:
    """The sentence comes through, and the thread waits for another source."""
    source = Slow(10)
    told: list[str] = []
    reader.failed.connect(lambda sentence, _: told.append(sentence))
    reader.open(lambda: source)
    reader.want([7, 8])
    source.gate.release()
    wait_for(lambda: told)
    source.gate.release()
    settle(40)
    assert told == ["Frame 7 is damaged."]
    assert source.read == []


def test_dropped_frames_are_counted() -> None:
    """Forwards, backwards, round the end, and at double speed, where every second frame is meant to be left out."""
    counted = Dropped()

    def seen(places: tuple[int, ...], course: Course) -> tuple[int, int]:
        counted.begin()
        for place in places:
            counted.saw(place, course)
        return counted.shown, counted.dropped

    assert seen((0, 1, 2, 2, 5, 6, 9, 0), Course(0, 0, 9, 25.0)) == (7, 4)
    assert seen((3, 2, 1, 0, 9, 6), Course(3, 0, 9, 25.0, -1.0)) == (6, 2)
    assert seen((0, 2, 4, 8), Course(0, 0, 99, 25.0, 2.0)) == (4, 1)
    assert seen((20, 21, 22, 20, 22), Course(20, 20, 22, 25.0)) == (5, 1), "a few frames again and again"


def test_what_is_read_ahead() -> None:
    """A second of what comes next while playing, round the end of what is played; the neighbours at rest."""
    assert ahead(8, 10, Course(8, 0, 9, 5.0)) == [8, 9, 0, 1, 2]
    assert ahead(1, 10, Course(1, 0, 9, 5.0, -1.0)) == [1, 0, 9, 8, 7]
    assert ahead(22, 100, Course(20, 20, 23, 25.0)) == [22, 23, 20, 21]
    assert ahead(0, 10, None) == [0, 1, 2]
    assert ahead(0, 0, None) == []
