"""Posing in the Character workspace, by mouse and keys: what a drag holds to, strokes, copies, lists, Escape."""

from __future__ import annotations

import time

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.window.shell import Shell
from app.window.timeline import TimelineHit
from app.window.work import Ears
from tests.window.conftest import _move, at, drag, settle, wait_for
from tests.window.test_character_workspace import (
    CONTROL,
    LEFT,
    character,
    done,
    drag_vertex,
    place,
    pose,
    posed,
    vertex,
    view,
)

__all__ = ["posed"]
pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
SHIFT = Qt.KeyboardModifier.ShiftModifier
PLAIN = Qt.KeyboardModifier.NoModifier


def carry(shell: Shell, number: int, dx: float, dy: float, keys: Qt.KeyboardModifier = PLAIN) -> tuple[float, float]:
    """Drag a vertex under held keys, wait until the mesh has followed, and let go; gives where the press was."""
    x, y = place(shell, number)
    solves = shell.character.posing.live.solves
    drag(view(shell), (x, y), (x + dx, y + dy), keys=keys, release=False)
    wait_for(lambda: shell.character.posing.live.solves > solves)
    settle()
    QTest.mouseRelease(view(shell), LEFT, keys, at(x + dx, y + dy))
    wait_for(lambda: 10 in character(shell).edits)
    return x, y


def stroke(shell: Shell, vertices: np.ndarray) -> float:
    """How far one stroke goes: a millimetre, or a thousandth of the character where no length is known."""
    world = shell.project.result(shell.project.session.stages.world)
    return 0.001 if world.metric else 0.001 * float(np.ptp(vertices[:, 2]))


def quiet(shell: Shell) -> None:
    """Wait until the motion is up to date."""
    wait_for(lambda: done(shell), 60)
    settle()


def test_a_plain_drag_stays_in_the_plane_of_the_view(posed: Shell) -> None:
    """The vertex is under the mouse, as far from the camera as it was."""
    nose = vertex(posed, "nose")
    camera, before = view(posed).lens().camera, pose(posed, 10)[nose]
    carry(posed, nose, 24, -30)
    put = np.array(character(posed).edits[10].moves[nose].place)
    assert camera.depth(put) == pytest.approx(float(camera.depth(before)), abs=1e-9)
    assert not character(posed).edits[10].moves[nose].on_ray
    assert np.allclose(camera.project(put), np.add(camera.project(before), (24, -30)), atol=1.5)
    posed.project.cancel_work()


def test_shift_pulls_along_the_ray(posed: Shell) -> None:
    """The pixel stays, the depth changes."""
    nose = vertex(posed, "nose")
    camera, before = view(posed).lens().camera, pose(posed, 10)[nose]
    carry(posed, nose, 0, 40, SHIFT)
    put = np.array(character(posed).edits[10].moves[nose].place)
    assert np.allclose(camera.project(put), camera.project(before), atol=1e-6)
    assert camera.depth(put) < camera.depth(before) - 0.05
    posed.project.cancel_work()


def test_ctrl_holds_the_image_point_only(posed: Shell) -> None:
    """Through the recovered camera: the pixel is the mouse's, the depth the mesh's own; the handle is a large ring."""
    QTest.keyClick(posed, Qt.Key.Key_1)
    settle()
    nose = vertex(posed, "nose")
    film = view(posed).camera
    wanted = film.project(pose(posed, 10)[nose]) + np.array((20.0, -16.0)) / view(posed).view.scale
    carry(posed, nose, 20, -16, CONTROL)
    move = character(posed).edits[10].moves[nose]
    assert move.on_ray
    assert np.allclose(film.project(np.array(move.place)), wanted, atol=1.5 / view(posed).view.scale)
    quiet(posed)
    handle = next(each for each in view(posed).handles if each.vertex == nose)
    assert handle.kind == "edited ray"
    rows = posed.character.inspector.frames.entries
    assert [row.caption for row in rows] == ["", "2D"]
    assert posed.character.inspector.vertex.kind.currentIndex() == 1


@pytest.mark.parametrize(("key", "axis"), [(Qt.Key.Key_X, 0), (Qt.Key.Key_Y, 1), (Qt.Key.Key_Z, 2)])
def test_an_axis_key_holds_the_drag(posed: Shell, key: Qt.Key, axis: int) -> None:
    """Pressed in the window during the drag it locks that axis, and does nothing else the key stands for."""
    nose = vertex(posed, "nose")
    before = pose(posed, 10)[nose]
    x, y = place(posed, nose)
    drag(view(posed), (x, y), (x + 26, y - 22), release=False)
    QTest.keyClick(view(posed), key)
    solves = posed.character.posing.live.solves
    _move(view(posed), at(x + 30, y - 26), LEFT, PLAIN)
    wait_for(lambda: posed.character.posing.live.solves > solves)
    QTest.mouseRelease(view(posed), LEFT, pos=at(x + 30, y - 26))
    wait_for(lambda: 10 in character(posed).edits)
    moved = np.array(character(posed).edits[10].moves[nose].place) - before
    assert abs(moved[axis]) > 1e-3
    assert np.allclose(np.delete(moved, axis), 0, atol=1e-9)
    assert not posed.character.tracks.canvas.magnify
    assert len(posed.character.mesh.panes.panes) == 1
    posed.project.cancel_work()


def test_the_end_of_an_axis_is_a_handle(posed: Shell) -> None:
    """A drag of the arrow's end of the selected vertex goes along that axis."""
    from app.window.viewport.handles import axis_tips

    nose = vertex(posed, "nose")
    QTest.mouseClick(view(posed), LEFT, pos=at(*place(posed, nose)))
    settle()
    before = pose(posed, 10)[nose]
    chosen = next(each for each in view(posed).handles if each.selected)
    x, y = axis_tips(view(posed).lens(), chosen)["z"]
    solves = posed.character.posing.live.solves
    drag(view(posed), (x, y), (x + 9, y - 30), release=False)
    wait_for(lambda: posed.character.posing.live.solves > solves)
    QTest.mouseRelease(view(posed), LEFT, pos=at(x + 9, y - 30))
    wait_for(lambda: 10 in character(posed).edits)
    moved = np.array(character(posed).edits[10].moves[nose].place) - before
    assert moved[2] > 0.01
    assert np.allclose(moved[:2], 0, atol=1e-9)
    posed.project.cancel_work()


def test_strokes_of_keys_move_the_selected_vertex(posed: Shell) -> None:
    """Four strokes are one entry, a millimetre each, ten with Shift; Ctrl+Z right after takes them back uncommitted."""
    nose = vertex(posed, "nose")
    before = pose(posed, 10)[nose]
    camera = view(posed).lens().camera
    QTest.mouseClick(view(posed), LEFT, pos=at(*place(posed, nose)))
    entries = len(posed.project.session.history.versions)
    for _ in range(3):
        QTest.keyClick(posed, Qt.Key.Key_Up, CONTROL)
    QTest.keyClick(posed, Qt.Key.Key_Right, CONTROL | SHIFT)
    wait_for(lambda: 10 in character(posed).edits)
    moved = np.array(character(posed).edits[10].moves[nose].place) - before
    unit = stroke(posed, pose(posed, 10))
    assert np.allclose(moved, unit * (10 * camera.R[0] - 3 * camera.R[1]), atol=0.02 * unit)
    assert len(posed.project.session.history.versions) == entries + 1
    quiet(posed)
    edit = character(posed).edits[10]
    QTest.keyClick(posed, Qt.Key.Key_Left, CONTROL)
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    settle(700)
    assert character(posed).edits[10] == edit
    assert len(posed.project.session.history.versions) == entries + 1


def test_a_stroke_over_the_film_is_a_quarter_of_its_pixel(posed: Shell) -> None:
    """Looking through the recovered camera, four strokes are one pixel of the picture."""
    nose = vertex(posed, "nose")
    QTest.mouseClick(view(posed), LEFT, pos=at(*place(posed, nose)))
    QTest.keyClick(posed, Qt.Key.Key_1)
    settle()
    film, before = view(posed).camera, pose(posed, 10)[nose]
    for _ in range(4):
        QTest.keyClick(posed, Qt.Key.Key_Right, CONTROL)
    wait_for(lambda: 10 in character(posed).edits)
    put = np.array(character(posed).edits[10].moves[nose].place)
    assert np.allclose(film.project(put) - film.project(before), (1.0, 0.0), atol=0.02)
    posed.project.cancel_work()


def test_escape_during_propagation_keeps_what_is_finished(posed: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """The finished frames stay as they are, the rest is waiting; Ctrl+Return goes on to the end."""
    tell = Ears.partial

    def slowly(ears: Ears, *values: object) -> None:
        """A small mesh is done before a hand can stop it: every frame takes as long as one of a large mesh."""
        tell(ears, *values)
        time.sleep(0.05)

    monkeypatch.setattr(Ears, "partial", slowly)
    nose = vertex(posed, "nose")
    old = [pose(posed, frame) for frame in range(24)]
    seen: list[int] = []
    posed.project.partial.connect(lambda stage, value: seen.append(int(value[0])))

    def stop(stage: object, value: object) -> None:
        if len(seen) == 4:
            QTest.keyClick(posed, Qt.Key.Key_Escape)

    posed.project.partial.connect(stop)
    drag_vertex(posed, nose, 25, -45)
    wait_for(lambda: len(seen) >= 4 and not posed.project.progress, 60)
    settle(100)
    kept = seen[:4]
    assert len(posed.character.motion.streamed) < 24
    assert all(not np.array_equal(pose(posed, frame), old[frame]) for frame in kept)
    assert posed.character.mesh.notes.right[0] == "waiting"
    lane = next(each for each in posed.timeline.lanes.lanes if each.id == "solution")
    colours = {bar.colour for bar in lane.rows[0].bars}
    assert colours == {"ok", "warn"}
    QTest.keyClick(posed, Qt.Key.Key_Return, CONTROL)
    quiet(posed)
    assert posed.character.mesh.notes.right[0] == "up to date"


def test_feet_are_lifted_by_a_check_box(posed: Shell) -> None:
    """Ticked it is one entry of the history and the motion is solved so; undo takes the tick away."""
    box = posed.character.inspector.moves.lift
    assert not box.isChecked()
    QTest.mouseClick(box, LEFT, pos=at(10, box.height() // 2))
    assert character(posed).solve.lift_feet
    quiet(posed)
    assert box.isChecked()
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    assert not character(posed).solve.lift_feet
    wait_for(lambda: not box.isChecked(), 30)


def test_several_vertices_first_then_ctrl_return(posed: Shell) -> None:
    """Without propagation two vertices are moved in two frames; undo shows the frame as it was committed before."""
    QTest.mouseClick(posed.character.inspector.automatic, LEFT, pos=at(10, 8))
    nose, tail = vertex(posed, "nose"), vertex(posed, "tail root")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    settle(60)
    first = pose(posed, 10)
    drag_vertex(posed, tail, 10, -25)
    wait_for(lambda: len(character(posed).edits[10].moves) == 2)
    settle(60)
    assert not posed.project.progress
    moves = character(posed).edits[10].moves
    for number in (nose, tail):
        assert np.allclose(pose(posed, 10)[number], moves[number].place, atol=2e-3)
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    # What followed the mouse was nearly relaxed: to a few millimetres of a move of decimetres.
    wait_for(lambda: np.allclose(pose(posed, 10), first, atol=5e-3))
    assert np.array_equal(pose(posed, 10)[nose], character(posed).edits[10].moves[nose].place)
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL | SHIFT)
    QTest.keyClick(posed, Qt.Key.Key_Return, CONTROL)
    quiet(posed)
    for number in (nose, tail):
        assert np.allclose(pose(posed, 10)[number], moves[number].place, atol=1e-6)


def test_a_free_vertex_moves_like_a_point(posed: Shell) -> None:
    """A control vertex without a pair takes over a point's motion and lets it go again; a paired one has its own."""
    section = posed.character.inspector.vertex
    posed.project.select_vertex(vertex(posed, "nose"))
    settle(60)
    assert not section.like.isEnabled()
    view, taken = posed.character.mesh.viewport, set(character(posed).pairs.values())
    places = view.lens().to_widget(view.vertices)
    free = next(n for n, (x, y) in enumerate(places) if n not in taken and view.vertex_at((x, y)) == n)
    drag_vertex(posed, free, 12, -12)
    wait_for(lambda: 10 in character(posed).edits)
    moved = next(iter(character(posed).edits[10].moves))
    quiet(posed)
    posed.project.select_vertex(moved)
    wait_for(section.like.isEnabled)
    section.like.setFocus()
    QTest.keyClick(section.like, Qt.Key.Key_Down)
    track = posed.project.document.tracks[0]
    assert dict(character(posed).following) == {moved: track.id}
    assert posed.project.session.history.undo_label.endswith(f"follow {track.name}")
    QTest.keyClick(section.like, Qt.Key.Key_Up)
    assert not character(posed).following
    quiet(posed)


def test_moves_are_listed_by_frame(posed: Shell) -> None:
    """A row goes to its frame and vertex; its eye mutes, its bin deletes; the bin of the frame takes all."""
    nose, tail = vertex(posed, "nose"), vertex(posed, "tail root")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    drag_vertex(posed, tail, 10, -25)
    wait_for(lambda: len(character(posed).edits[10].moves) == 2)
    quiet(posed)
    rows = posed.character.inspector.frames
    names = ["nose", "tail root"] if nose < tail else ["tail root", "nose"]
    assert [row.text for row in rows.entries] == ["Frame 10", *names]
    posed.project.show_frame(3)
    settle()
    QTest.mouseClick(rows, LEFT, pos=rows.place_of(f"10/{nose}").toPoint())
    assert posed.project.frame == 10
    assert posed.project.vertex == nose
    QTest.mouseClick(rows, LEFT, pos=rows.place_of(f"10/{nose}", "mute").toPoint())
    wait_for(lambda: character(posed).edits[10].moves[nose].muted)
    quiet(posed)
    QTest.mouseClick(rows, LEFT, pos=rows.place_of(f"10/{nose}", "mute").toPoint())
    wait_for(lambda: not character(posed).edits[10].moves[nose].muted)
    quiet(posed)
    QTest.mouseClick(rows, LEFT, pos=rows.place_of(f"10/{nose}", "delete").toPoint())
    wait_for(lambda: nose not in character(posed).edits[10].moves)
    quiet(posed)
    QTest.mouseClick(rows, LEFT, pos=rows.place_of("10", "delete").toPoint())
    assert not character(posed).edits
    assert rows.count() == 0


def test_a_pose_is_copied_to_another_frame(posed: Shell) -> None:
    """Ctrl+C and Ctrl+V, one entry that names both frames; pasting nothing says so."""
    QTest.keyClick(posed, Qt.Key.Key_V, CONTROL)
    assert "No pose edit was copied" in posed.character.tracks.notes.message
    nose = vertex(posed, "nose")
    before = [pose(posed, frame)[nose] for frame in range(24)]
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    quiet(posed)
    QTest.keyClick(posed, Qt.Key.Key_C, CONTROL)
    assert "frame 10" in posed.character.tracks.notes.message
    posed.project.show_frame(18)
    wait_for(lambda: posed.character.frame == 18)
    QTest.keyClick(posed, Qt.Key.Key_V, CONTROL)
    wait_for(lambda: 18 in character(posed).edits)
    assert posed.project.session.history.undo_label.startswith("Paste pose of frame 10")
    moved = [np.subtract(character(posed).edits[frame].moves[nose].place, before[frame]) for frame in (10, 18)]
    assert np.linalg.norm(moved[0]) == pytest.approx(np.linalg.norm(moved[1]), rel=1e-6)
    quiet(posed)


def test_the_lane_of_pose_edits_copies_pastes_and_deletes(posed: Shell) -> None:
    """Its menu does what the keys do, in the frame that was clicked."""
    nose = vertex(posed, "nose")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    quiet(posed)

    def choose(frame: int, text: str) -> None:
        menu = posed.timeline.menu_for(TimelineHit("diamond", "poses", "poses", frame))
        next(action for action in menu.actions() if action.text() == text).trigger()
        menu.deleteLater()

    posed.project.show_frame(3)
    choose(10, "Copy this pose edit")
    assert posed.project.frame == 10
    choose(15, "Paste a pose edit here")
    wait_for(lambda: 15 in character(posed).edits)
    choose(10, "Delete this pose edit")
    assert set(character(posed).edits) == {15}
    posed.project.cancel_work()


def test_a_control_vertex_is_deleted_in_all_frames(posed: Shell) -> None:
    """The button takes its moves out of every frame, as one entry."""
    nose = vertex(posed, "nose")
    drag_vertex(posed, nose, 20, -30)
    wait_for(lambda: 10 in character(posed).edits)
    quiet(posed)
    posed.project.show_frame(16)
    wait_for(lambda: posed.character.frame == 16)
    settle()
    drag_vertex(posed, nose, 10, -20)
    wait_for(lambda: 16 in character(posed).edits)
    quiet(posed)
    entries = len(posed.project.session.history.versions)
    QTest.mouseClick(posed.character.inspector.vertex.forget_button, LEFT)
    wait_for(lambda: not character(posed).edits)
    assert len(posed.project.session.history.versions) == entries + 1
    assert "Delete control vertex" in posed.project.session.history.undo_label
    quiet(posed)
