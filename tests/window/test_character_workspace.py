"""The Character workspace as a person uses it: select, drag, release, watch it spread, take it back."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.model.edits import characters
from app.window.shell import Shell
from app.window.viewport import Viewport
from tests.window.conftest import at, drag, settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def posed(open_shell: Callable[[Session], Shell], session: Session) -> Shell:
    """The window in the Character workspace at frame 10."""
    shell = open_shell(session)
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: shell.character.mesh.viewport is not None and len(shell.character.mesh.viewport.vertices))
    shell.project.show_frame(10)
    wait_for(lambda: shell.character.frame == 10)
    settle()
    return shell


def test_the_3d_libraries_load_behind_the_window(
    open_shell: Callable[[Session], Shell], session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The workspace comes into sight at once and says that it loads; the window lives on until the view is there."""
    monkeypatch.setattr("app.window.lazy_view.LIBRARIES", "tests.window.late_library")
    monkeypatch.delitem(sys.modules, "tests.window.late_library", raising=False)
    shell = open_shell(session)
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: shell.character.isVisible())
    assert shell.character.mesh.viewport is None, "the window waited for the library"
    assert shell.character.mesh.waiting.isVisible()
    wait_for(lambda: shell.character.mesh.viewport is not None and len(view(shell).vertices))
    assert not shell.character.mesh.waiting.isVisible()


def view(shell: Shell) -> Viewport:
    """The 3D view."""
    viewport = shell.character.mesh.viewport
    assert viewport is not None
    return viewport


def vertex(shell: Shell, name: str) -> int:
    """The vertex that is paired with a point."""
    track = next(each for each in shell.project.document.tracks if each.name == name)
    return shell.project.document.characters[0].pairs[track.id]


def place(shell: Shell, number: int) -> tuple[float, float]:
    """Where a vertex is on the screen."""
    x, y = view(shell).lens().to_widget(view(shell).vertices[number])
    return float(x), float(y)


def pose(shell: Shell, frame: int) -> np.ndarray:
    """The vertices shown in a frame."""
    found = shell.character.motion.vertices(frame)
    assert found is not None
    return np.array(found)


def character(shell: Shell) -> object:
    """The character in the document."""
    return shell.project.document.characters[0]


def done(shell: Shell) -> bool:
    """Whether the motion is up to date and nothing runs."""
    stage = shell.project.session.stages.animation(character(shell).id)
    return shell.project.state(stage) == "fresh" and not shell.project.progress


def drag_vertex(shell: Shell, number: int, dx: float, dy: float, *, release: bool = True) -> None:
    """Drag a vertex by pixels and wait until the mesh has followed."""
    x, y = place(shell, number)
    solves = shell.character.posing.live.solves
    drag(view(shell), (x, y), (x + dx, y + dy), release=False)
    wait_for(lambda: shell.character.posing.live.solves > solves)
    settle()
    if release:
        QTest.mouseRelease(view(shell), LEFT, pos=at(x + dx, y + dy))


def test_the_motion_is_seen_frame_by_frame(posed: Shell) -> None:
    """Another frame shows another pose and another picture; the state is said."""
    first = view(posed).vertices.copy()
    image = view(posed).grab().toImage()
    QTest.keyClick(posed, Qt.Key.Key_Right)
    wait_for(lambda: posed.character.frame == 11)
    settle()
    assert not np.array_equal(view(posed).vertices, first)
    assert view(posed).grab().toImage() != image
    assert posed.character.mesh.notes.right[0] == "up to date"


def test_click_selects_a_vertex_and_shows_what_it_follows(posed: Shell) -> None:
    """A click on the nose's handle selects its vertex; the inspector names the point and its place."""
    nose = vertex(posed, "nose")
    QTest.mouseClick(view(posed), LEFT, pos=at(*place(posed, nose)))
    assert posed.project.vertex == nose
    settle()
    inspector = posed.character.inspector
    assert inspector.vertex_name.text() == "nose"
    assert inspector.follows.currentText() == "nose"
    assert inspector.place[0].value == pytest.approx(view(posed).vertices[nose][0], abs=6e-4)


def test_the_mesh_follows_the_mouse_before_anything_is_decided(posed: Shell) -> None:
    """During the drag the vertex is under the mouse, its neighbours come along, the document is untouched."""
    nose = vertex(posed, "nose")
    before = pose(posed, 10)
    entries = len(posed.project.session.history.versions)
    x, y = place(posed, nose)
    drag_vertex(posed, nose, 30, -40, release=False)
    wait_for(lambda: np.hypot(*np.subtract(place(posed, nose), (x + 30, y - 40))) < 1.5)
    moved = np.linalg.norm(view(posed).vertices - before, axis=1)
    near = np.linalg.norm(before - before[nose], axis=1)
    assert moved[np.argsort(near)[:10]].min() > 0.3 * moved[nose]
    assert moved[np.argmax(near)] < 0.4 * moved[nose]
    assert len(posed.project.session.history.versions) == entries
    QTest.keyClick(view(posed), Qt.Key.Key_Escape)
    QTest.mouseRelease(view(posed), LEFT, pos=at(x + 30, y - 40))
    wait_for(lambda: np.array_equal(view(posed).vertices, before))
    assert len(posed.project.session.history.versions) == entries


def test_release_commits_one_entry_and_spreads(posed: Shell) -> None:
    """The vertex is where it was put, exactly; neighbouring frames change; far ends keep to the pose edit's reach."""
    nose = vertex(posed, "nose")
    old = [pose(posed, frame) for frame in range(24)]
    entries = len(posed.project.session.history.versions)
    drag_vertex(posed, nose, 25, -45)
    wait_for(lambda: 10 in character(posed).edits)
    assert len(posed.project.session.history.versions) == entries + 1
    assert posed.project.session.history.undo_label.endswith("frame 10")
    wait_for(lambda: done(posed), 60)
    settle()
    put = character(posed).edits[10].moves[nose].place
    assert np.allclose(pose(posed, 10)[nose], put, atol=1e-6)
    for frame in (8, 9, 11, 12):
        assert np.linalg.norm(pose(posed, frame)[nose] - old[frame][nose]) > 1e-3
    assert posed.character.mesh.notes.right[0] == "up to date"
    lane = next(each for each in posed.timeline.lanes.lanes if each.id == "poses")
    assert [mark.frame for mark in lane.rows[0].diamonds] == [10]
    assert posed.character.inspector.frames.count() == 1


def test_results_stream_in_outward(posed: Shell) -> None:
    """While propagation runs, frames near the edit arrive before frames far from it."""
    nose = vertex(posed, "nose")
    order: list[int] = []
    posed.project.partial.connect(
        lambda stage, value: order.append(int(value[0])) if stage.name.startswith("animation/") else None
    )
    drag_vertex(posed, nose, 25, -45)
    wait_for(lambda: 10 in character(posed).edits)
    wait_for(lambda: done(posed), 60)
    settle()
    away = [abs(frame - 10) for frame in order]
    assert len(order) > 5
    assert away[: len(away) // 3] == sorted(away[: len(away) // 3])
    assert max(away) == away[-1]


def test_undo_while_propagation_runs_gives_the_old_motion(posed: Shell) -> None:
    """Ctrl+Z right after the release: the old motion is there at once, from the cache, and stays."""
    nose = vertex(posed, "nose")
    old = [pose(posed, frame) for frame in range(24)]
    drag_vertex(posed, nose, 25, -45)
    wait_for(lambda: 10 in character(posed).edits)
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    settle()
    assert not character(posed).edits
    assert all(np.array_equal(pose(posed, frame), old[frame]) for frame in range(24))
    wait_for(lambda: not posed.project.progress, 60)
    settle()
    assert all(np.array_equal(pose(posed, frame), old[frame]) for frame in range(24))
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL | Qt.KeyboardModifier.ShiftModifier)
    wait_for(lambda: done(posed), 60)
    settle()
    assert not np.array_equal(pose(posed, 11), old[11])


def test_a_second_drag_replaces_the_running_propagation(posed: Shell) -> None:
    """A new edit while frames stream in: both moves are in the document and the end result is up to date."""
    nose, tail = vertex(posed, "nose"), vertex(posed, "tail root")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    drag_vertex(posed, tail, 10, -20)
    wait_for(lambda: len(character(posed).edits[10].moves) == 2)
    wait_for(lambda: done(posed), 60)
    settle()
    moves = character(posed).edits[10].moves
    for number in (nose, tail):
        assert np.allclose(pose(posed, 10)[number], moves[number].place, atol=1e-6)


def test_without_propagation_on_release_several_vertices_are_moved_first(posed: Shell) -> None:
    """With the box unticked nothing runs until Propagate is pressed."""
    QTest.mouseClick(posed.character.inspector.automatic, LEFT, pos=at(10, 8))
    assert not posed.character.inspector.automatic.isChecked()
    drag_vertex(posed, vertex(posed, "nose"), 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    settle(100)
    assert not posed.project.progress
    assert posed.character.mesh.notes.right[0] == "waiting"
    QTest.mouseClick(posed.character.inspector.run, LEFT)
    wait_for(lambda: done(posed), 60)


def test_a_typed_place_is_an_edit(posed: Shell) -> None:
    """A number typed in the inspector moves the vertex there."""
    nose = vertex(posed, "nose")
    QTest.mouseClick(view(posed), LEFT, pos=at(*place(posed, nose)))
    settle()
    field = posed.character.inspector.place[2]
    target = round(field.value + 0.1, 3)
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, f"{target}")
    QTest.keyClick(field, Qt.Key.Key_Return)
    wait_for(lambda: 10 in character(posed).edits)
    assert character(posed).edits[10].moves[nose].place[2] == pytest.approx(target)
    wait_for(lambda: done(posed), 60)


def test_mute_delete_and_reset(posed: Shell) -> None:
    """A move is muted, counts again, is deleted; undo brings it back; reset takes the whole frame."""
    nose = vertex(posed, "nose")
    old = pose(posed, 10)
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    wait_for(lambda: done(posed), 60)
    settle()
    inspector = posed.character.inspector
    QTest.mouseClick(inspector.mute_button, LEFT)
    assert character(posed).edits[10].moves[nose].muted
    wait_for(lambda: done(posed), 60)
    settle()
    assert np.allclose(pose(posed, 10), old, atol=1e-9)
    QTest.mouseClick(inspector.mute_button, LEFT)
    wait_for(lambda: not character(posed).edits[10].moves[nose].muted)
    wait_for(lambda: done(posed), 60)
    settle()
    assert not np.allclose(pose(posed, 10)[nose], old[nose], atol=1e-3)
    QTest.keyClick(posed, Qt.Key.Key_Delete)
    assert 10 not in character(posed).edits
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    assert 10 in character(posed).edits
    wait_for(lambda: done(posed), 60)
    settle()
    QTest.mouseClick(inspector.forget, LEFT)
    assert 10 not in character(posed).edits
    wait_for(lambda: done(posed), 60)
    settle()
    assert np.array_equal(pose(posed, 10), old)


def test_committing_anew_does_not_hold_the_window_up(posed: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """A muted move that counts again is solved in another thread; what was done meanwhile is not lost."""
    from app.actions import posing

    nose = vertex(posed, "nose")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    wait_for(lambda: done(posed), 60)
    settle()
    inspector = posed.character.inspector
    QTest.mouseClick(inspector.mute_button, LEFT)
    threads, go, solve = [], threading.Event(), posing.committed_anew

    def slow(*values: object) -> object:
        threads.append(threading.current_thread())
        assert go.wait(20)
        return solve(*values)

    monkeypatch.setattr("app.window.character.posing.actions.committed_anew", slow)
    settle()
    QTest.mouseClick(inspector.mute_button, LEFT)
    wait_for(lambda: threads)
    assert threads[0] is not threading.main_thread()
    posed.project.edit(characters.rename_character, character(posed).id, "Fido")
    go.set()
    wait_for(lambda: not character(posed).edits[10].moves[nose].muted)
    assert character(posed).name == "Fido"
    assert character(posed).edits[10].committed
    assert len(threads) == 2, "the document had changed, so it was solved for the new one"
    wait_for(lambda: done(posed), 60)


def test_looking_through_the_recovered_camera(posed: Shell) -> None:
    """1 shows the mesh over the video: handles lie on the tracked points; 2 looks from the side; 3 orbits."""
    QTest.keyClick(posed, Qt.Key.Key_1)
    settle()
    viewport = view(posed)
    assert viewport.through_camera
    reading = posed.character.tracks.reading
    camera = posed.project.result(posed.project.session.stages.world).cameras[10]
    gaps = []
    for track in posed.project.document.tracks:
        number = character(posed).pairs[track.id]
        expected = viewport.view.to_widget(camera.project(viewport.vertices[number]))
        assert np.allclose(place(posed, number), expected, atol=1e-6)
        gaps.append(
            np.hypot(*(np.subtract(place(posed, number), viewport.view.to_widget(reading.track(track).positions[10]))))
        )
    assert np.median(gaps) / viewport.view.scale < 8.0, "the character lies on the tracked points"
    image = viewport.grab().toImage()
    assert image.pixelColor(5, viewport.height() // 2).lightness() > 25, "the video is behind the mesh"
    QTest.keyClick(posed, Qt.Key.Key_2)
    settle()
    assert viewport.looking == "side"
    assert viewport.grab().toImage() != image
    QTest.keyClick(posed, Qt.Key.Key_3)
    assert viewport.looking == "orbit"


def test_opacity_and_ghosts_change_the_picture(posed: Shell) -> None:
    """O makes the character see-through over the video, G shows the neighbouring frames."""
    QTest.keyClick(posed, Qt.Key.Key_1)
    settle(400)
    solid = view(posed).grab().toImage()
    QTest.keyClick(posed, Qt.Key.Key_O)
    settle(400)
    thin = view(posed).grab().toImage()
    assert thin != solid
    QTest.keyClick(posed, Qt.Key.Key_G)
    settle(400)
    assert view(posed).grab().toImage() != thin


def test_pairing_by_two_clicks(posed: Shell) -> None:
    """With Pair on: a click on a track, a click on the mesh, and the pair is another one; undo takes it back."""
    tracks = posed.character.tracks
    track = next(each for each in posed.project.document.tracks if each.name == "back")
    before = character(posed).pairs[track.id]
    QTest.mouseClick(tracks.pair_button, LEFT)
    mark = next(each for each in tracks._marks if each.name == track.id)
    QTest.mouseClick(tracks.canvas, LEFT, pos=at(*tracks.canvas.view.point(*mark.at(10))))
    assert posed.project.track_id == track.id
    assert "back" in posed.status.hint.text()
    taken = set(character(posed).pairs.values())
    pixels = view(posed).lens().to_widget(view(posed).vertices)
    middle = np.array(place(posed, before))
    for number in np.argsort(np.hypot(*(pixels - middle).T)):
        clicked = at(*pixels[number])  # whole pixels, as a click has
        found = view(posed).vertex_at((clicked.x(), clicked.y()))
        if found == number and number not in taken:
            break
    QTest.mouseClick(view(posed), LEFT, pos=clicked)
    assert character(posed).pairs[track.id] not in (before, *(taken - {before}))
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    assert character(posed).pairs[track.id] == before
    posed.project.cancel_work()


def test_aligning_by_numbers_is_undoable(posed: Shell) -> None:
    """A typed scale is one entry and the placed character grows."""
    field = posed.character.inspector.scale
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, "1.2")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert character(posed).alignment.scale == pytest.approx(1.2)
    posed.project.cancel_work()
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    assert character(posed).alignment.scale == 1.0
    settle()
    assert field.value == 1.0


def test_dragging_before_there_is_a_motion_says_what_to_do(posed: Shell) -> None:
    """Without a solved motion the drag is refused in one sentence with a button."""
    posed.project.session.cache._held.clear()
    posed.project.session.cache.store = None
    nose = vertex(posed, "nose")
    x, y = place(posed, nose)
    drag(view(posed), (x, y), (x + 30, y))
    assert "no motion yet" in posed.character.mesh.errors.sentence.text()
    assert posed.character.mesh.errors.isVisible()
    assert not character(posed).edits
