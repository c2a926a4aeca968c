"""What a shown frame, a streamed one and an edit cost: counted, not timed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.model.edits import tracks
from app.window.character.motion import Motion
from app.window.moment import Moment
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for


class Watch(QObject):
    """Counts events of a kind, by widget."""

    def __init__(self, kind: QEvent.Type) -> None:
        super().__init__()
        self.kind, self.counts = kind, Counter[QObject]()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Count it and let it pass."""
        if event.type() == self.kind and isinstance(watched, QWidget):
            self.counts[watched] += 1
        return False


@contextmanager
def watching(kind: QEvent.Type) -> Iterator[Counter[QObject]]:
    """Count events of all widgets for a while."""
    watch, application = Watch(kind), QApplication.instance()
    assert application is not None
    application.installEventFilter(watch)
    try:
        yield watch.counts
    finally:
        application.removeEventFilter(watch)


@pytest.fixture
def calm(shell: Shell) -> Shell:
    """The Character workspace in frame 10 with nothing under way, and the next pictures in memory."""
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: shell.character.mesh.viewport is not None and len(shell.character.mesh.viewport.vertices))
    shell.project.show_frame(10)
    loader = shell.opened.loader
    wait_for(lambda: shell.character.frame == 10 and loader.peek(11) is not None and loader.peek(12) is not None)
    wait_for(lambda: not shell.project.progress and not shell.character.checks.measuring)
    shell.character.mesh.calm = lambda: False  # the finer picture of a view at rest is another paint, on purpose
    settle(400)
    return shell


def turn() -> None:
    """Let the window do what it has put off, once."""
    for _ in range(5):
        QApplication.processEvents()


def test_a_shown_frame_paints_every_picture_once(calm: Shell) -> None:
    """Film, 3D picture, marks, lanes and numbers: once each; what did not change is not painted."""
    view = calm.character.mesh.viewport
    with watching(QEvent.Type.Paint) as painted:
        calm.project.show_frame(11)
        turn()
    pictures = [calm.character.tracks.canvas, view, view.host, view.surface, calm.timeline.lanes]
    assert [painted[each] for each in pictures] == [1] * len(pictures)
    assert painted[calm.timeline.transport.number] == painted[calm.timeline.transport.of] == 1
    for still in (calm, calm.bar, calm.timeline, calm.timeline.transport, calm.character.inspector.vertex):
        assert painted[still] == 0, still
    assert calm.timeline.transport.number.text() == "11"


def test_a_shown_frame_lays_nothing_out(calm: Shell) -> None:
    """Numbers that change keep their room: the row they stand in is not laid out anew."""
    with watching(QEvent.Type.LayoutRequest) as laid:
        calm.project.show_frame(11)
        turn()
    assert not any(calm.timeline.isAncestorOf(each) for each in laid if isinstance(each, QWidget))


def test_results_are_not_read_again_for_another_frame(calm: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """The points are read when the document or a result has changed, and not once a frame."""
    reading, asked = calm.character.tracks.reading, []
    assert reading is not None
    find = reading._found
    monkeypatch.setattr(reading, "_found", lambda track: asked.append(track.id) or find(track))
    calm.project.show_frame(11)
    calm.project.show_frame(12)
    turn()
    assert not asked
    calm.project.edit(tracks.rename_track, calm.project.document.tracks[0].id, "renamed")
    turn()
    assert set(asked) == {track.id for track in calm.project.document.tracks}


def test_a_moment_ends_with_an_edit_and_with_a_result(calm: Shell) -> None:
    """What was read holds until the document, a result or a state has changed."""
    session = calm.project.session
    before = Moment.of(session)
    assert Moment.of(session) == before
    session.cache.put(session.stages.cameras, session.ready(session.stages.cameras))
    after = Moment.of(session)
    assert after != before
    calm.project.edit(tracks.rename_track, calm.project.document.tracks[0].id, "renamed")
    assert Moment.of(session) != after


def test_hidden_lists_are_not_refreshed(calm: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """An edit does not reach the inspector of a workspace that nobody sees; it is right when it comes into sight."""
    inspector, shown = calm.character.inspector, []
    show = inspector.show_character
    monkeypatch.setattr(inspector, "show_character", lambda *parts, **named: shown.append(1) or show(*parts, **named))
    calm.do("video")
    turn()
    shown.clear()
    calm.project.edit(tracks.rename_track, calm.project.document.tracks[0].id, "renamed")
    turn()
    assert not shown
    calm.do("character")
    turn()
    assert shown
    assert "renamed" in [entry.text for entry in inspector.pairs.list.entries]


def test_streamed_frames_show_the_lanes_once(calm: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """However many frames come in within a turn, the lanes are made and painted at most once."""
    made: list[int] = []
    lanes = calm.character.lanes
    monkeypatch.setattr(calm.character, "lanes", lambda: made.append(1) or lanes())
    project = calm.project
    stage = project.session.stages.animation(project.character_id)
    pose = calm.character.motion.vertices(10)
    with watching(QEvent.Type.Paint) as painted:
        for frame in range(1, 9):
            project.partial.emit(stage, (frame, pose))
        settle(150)
    assert made == [1]
    assert painted[calm.timeline.lanes] <= 1


def test_progress_is_told_once_for_many_reports(calm: Shell) -> None:
    """Each word on the progress repaints the bar at once: many reports are one word."""
    told: list[int] = []
    project = calm.project
    project.work_progressed.connect(lambda: told.append(1))
    job = project.call("Counting", lambda progress: [progress(step / 500) for step in range(500)])
    wait_for(lambda: job not in project.progress)
    settle(120)
    assert len(told) < 20


@pytest.mark.parametrize("known", [0, 6, 20])
def test_ways_are_the_poses_of_their_frames(known: int) -> None:
    """The places of chosen vertices, whichever of the sources they come from."""
    random = np.random.default_rng(7)
    motion = Motion(last=random.normal(size=(known, 9, 3)) if known else None)
    motion.streamed = {frame: random.normal(size=(9, 3)) for frame in (2, 8)}
    motion.held = {3: random.normal(size=(9, 3)), 8: random.normal(size=(9, 3))}
    chosen = [4, 0, 8]
    found = motion.ways(0, 12, chosen)
    for frame in range(13):
        pose = motion.vertices(frame)
        expected = np.full((3, 3), np.nan) if pose is None else pose[chosen]
        np.testing.assert_array_equal(found[frame], expected)
    assert np.isnan(motion.ways(0, 3, [9])).all()


def test_what_a_project_needs_is_asked_when_something_has_changed(
    shell: Shell, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The steps are the same in every frame; an edit may change them."""
    from app.window.video import right_column

    wait_for(lambda: not shell.project.progress)
    turn()
    asked: list[int] = []
    find = right_column.steps
    monkeypatch.setattr(right_column, "steps", lambda project: asked.append(1) or find(project))
    for frame in (3, 4, 5):
        shell.project.show_frame(frame)
        wait_for(lambda frame=frame: shell.video.frame == frame)
    assert not asked
    shell.project.edit(tracks.delete_track, shell.project.document.tracks[0].id)
    turn()
    assert asked


def test_layers_are_asked_for_when_their_menu_opens(calm: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether the background was measured is looked up for the menu, which says so, and not for every frame."""
    scenery, asked = calm.character.scenery, []
    known = type(scenery).known
    monkeypatch.setattr(type(scenery), "known", lambda self: asked.append(1) or known(self))
    calm.project.show_frame(11)
    turn()
    assert not asked
    menu = calm.character.mesh.bar.layer_menu()
    assert any("not measured yet" in action.text() for action in menu.actions())
    menu.deleteLater()
