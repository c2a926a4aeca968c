"""The Video workspace as a person uses it: real mouse and keys on a real project."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.window.shell import Shell
from tests.window.conftest import at, drag, hover, settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton


def place_of(shell: Shell, track_id: str) -> tuple[float, float]:
    """Where a track's point is on the canvas now."""
    mark = next(mark for mark in shell.video._marks if mark.name == track_id)
    place = mark.at(shell.video.frame)
    assert place is not None
    return shell.video.canvas.view.point(*place)


def go(shell: Shell, frame: int) -> None:
    """Show a frame and wait for its picture."""
    assert shell.project is not None
    shell.project.show_frame(frame)
    wait_for(lambda: shell.video.frame == frame)
    settle()


def states(shell: Shell, track_id: str) -> dict[str, str]:
    """Span -> state."""
    assert shell.project is not None
    return {stage.name: shell.project.state(stage) for stage in shell.project.session.stages.spans(track_id)}


def keys_of(shell: Shell) -> dict[str, str]:
    """Span -> key, of all tracks."""
    assert shell.project is not None
    stages = shell.project.session.stages
    return {stage.name: stage.key for track in shell.project.document.tracks for stage in stages.spans(track.id)}


def quiet(shell: Shell) -> bool:
    """Whether no work is under way."""
    return shell.project is not None and not shell.project.progress


def test_scrubbing_never_shows_a_frame_with_the_marks_of_another(shell: Shell) -> None:
    """While the ruler is dragged, the number on the picture and the picture belong together."""
    lanes = shell.timeline.lanes
    y = 10
    QTest.mousePress(lanes, LEFT, pos=at(lanes.axis.x(0), y))
    for frame in (3, 9, 15, 22, 12):
        hover(lanes, at(lanes.axis.x(frame), y))
        settle(10)
        assert shell.video.notes.text.startswith(f"Frame {shell.video.frame} of")
    QTest.mouseRelease(lanes, LEFT, pos=at(lanes.axis.x(12), y))
    wait_for(lambda: shell.video.frame == 12)
    assert shell.timeline.transport.number.text() == "12"


def test_arrow_keys_and_space(shell: Shell) -> None:
    """Right steps, End goes to the last frame, Space plays from the first again and pauses."""
    QTest.keyClick(shell, Qt.Key.Key_Right)
    QTest.keyClick(shell, Qt.Key.Key_Right)
    assert shell.project.frame == 2
    QTest.keyClick(shell, Qt.Key.Key_End)
    assert shell.project.frame == 23
    QTest.keyClick(shell, Qt.Key.Key_Space)
    wait_for(lambda: 2 < shell.project.frame < 23, 5)
    QTest.keyClick(shell, Qt.Key.Key_Space)
    frame = shell.project.frame
    settle(120)
    assert shell.project.frame == frame
    QTest.keyClick(shell, Qt.Key.Key_Home)
    QTest.keyClick(shell, Qt.Key.Key_Down)
    assert shell.project.frame == 8, "the next click of any point lies in frame 8"
    QTest.keyClick(shell, Qt.Key.Key_Left, Qt.KeyboardModifier.AltModifier)
    assert shell.project.frame == 0


def test_a_new_point_is_followed_through_the_clip(shell: Shell) -> None:
    """P, a click on the subject: the point gets a name, a row, and in the end a path through all frames."""
    go(shell, 4)
    count = len(shell.project.document.tracks)
    start = place_of(shell, shell.project.document.tracks[1].id)
    QTest.keyClick(shell, Qt.Key.Key_P)
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(start[0] + 22, start[1] + 14))
    assert len(shell.project.document.tracks) == count + 1
    track = shell.project.document.tracks[-1]
    assert shell.project.track_id == track.id
    assert shell.video.inspector.name.text() == track.name
    wait_for(lambda: set(states(shell, track.id).values()) == {"fresh"} and quiet(shell), 60)
    known = shell.video.reading.track(track)
    assert known.complete
    assert np.isfinite(known.positions).all(1).sum() >= 20
    settle()
    assert any(mark.name == track.id and mark.clicked for mark in shell.video._marks)


def test_dragging_a_point_solves_the_two_spans_beside_it_and_nothing_else(shell: Shell) -> None:
    """In frame 12 the paw is dragged: spans 8-12 and 12-16 are new, every other key is as before; one entry."""
    go(shell, 12)
    track = shell.project.document.tracks[2]
    before, entries = keys_of(shell), len(shell.project.session.history.versions)
    old = shell.video.reading.track(track).positions
    x, y = place_of(shell, track.id)
    drag(shell.video.canvas, (x, y), (x + 16, y - 8), release=False)
    assert shell.video.shown.dragged is not None
    assert len(shell.project.session.history.versions) == entries, "nothing is decided while the button is down"
    QTest.mouseRelease(shell.video.canvas, LEFT, pos=at(x + 16, y - 8))
    assert len(shell.project.session.history.versions) == entries + 1
    assert shell.project.session.history.undo_label == f"Correct {track.name}, frame 12"
    kept = shell.video.shown.before if track.id in shell.video.shown.before else shell.video.shown.compared
    assert np.array_equal(kept[track.id], old, equal_nan=True), "the old path is shown, thin once the new one is there"
    after = keys_of(shell)
    changed = {name for name in after if before.get(name) != after[name]}
    assert changed == {f"span/{track.id}/8-12", f"span/{track.id}/12-16"}
    wait_for(lambda: set(states(shell, track.id).values()) == {"fresh"} and quiet(shell), 60)
    settle()
    new = shell.video.reading.track(shell.project.document.track(track.id)).positions
    scale = shell.video.canvas.view.scale
    assert np.allclose(new[12] - old[12], (16 / scale, -8 / scale), atol=0.5)
    assert np.array_equal(new[:9], old[:9], equal_nan=True)
    assert np.array_equal(new[16:], old[16:], equal_nan=True)
    assert track.id not in shell.video.shown.before


def test_undo_brings_the_old_path_back_without_solving(shell: Shell) -> None:
    """After a correction is solved, undo and redo swap results from the cache."""
    go(shell, 12)
    track = shell.project.document.tracks[2]
    old = shell.video.reading.track(track).positions.copy()
    x, y = place_of(shell, track.id)
    drag(shell.video.canvas, (x, y), (x + 16, y - 8))
    wait_for(lambda: set(states(shell, track.id).values()) == {"fresh"} and quiet(shell), 60)
    QTest.keyClick(shell, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    settle()
    assert set(states(shell, track.id).values()) == {"fresh"}
    assert np.array_equal(shell.video.reading.track(shell.project.document.track(track.id)).positions, old)
    QTest.keyClick(shell, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    settle()
    assert set(states(shell, track.id).values()) == {"fresh"}
    assert not np.array_equal(shell.video.reading.track(shell.project.document.track(track.id)).positions, old)


def test_escape_puts_a_dragged_point_back(shell: Shell) -> None:
    """Escape during a drag: no entry, the point is where it was."""
    go(shell, 12)
    track = shell.project.document.tracks[2]
    x, y = place_of(shell, track.id)
    entries = len(shell.project.session.history.versions)
    drag(shell.video.canvas, (x, y), (x + 40, y), release=False)
    QTest.keyClick(shell.video.canvas, Qt.Key.Key_Escape)
    QTest.mouseRelease(shell.video.canvas, LEFT, pos=at(x + 40, y))
    settle()
    assert len(shell.project.session.history.versions) == entries
    assert np.allclose(place_of(shell, track.id), (x, y))


def test_delete_and_undo_of_a_point(shell: Shell) -> None:
    """Delete takes the click of this frame, in another frame the whole point; undo brings each back."""
    track = shell.project.document.tracks[0]
    go(shell, 8)
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place_of(shell, track.id)))
    assert shell.project.track_id == track.id
    QTest.keyClick(shell, Qt.Key.Key_Delete)
    assert 8 not in shell.project.document.track(track.id).clicks
    go(shell, 9)
    QTest.keyClick(shell, Qt.Key.Key_Delete)
    assert track.id not in {each.id for each in shell.project.document.tracks}
    shell.do("undo")
    shell.do("undo")
    assert shell.project.document.track(track.id) == track


def test_lasso_draws_adds_and_takes_away(shell: Shell) -> None:
    """Round the subject: one key mask; Alt takes a piece away; each is one entry."""
    shell.do("tool_lasso")
    canvas = shell.video.canvas
    entries = len(shell.project.session.history.versions)

    def round_(x: float, y: float, radius: float, keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        places = [(x + radius * np.cos(a), y + radius * np.sin(a)) for a in np.linspace(0, 6, 20)]
        QTest.mousePress(canvas, LEFT, keys, at(*places[0]))
        for place in places[1:]:
            from tests.window.conftest import _move

            _move(canvas, at(*place), LEFT, keys)
        QTest.mouseRelease(canvas, LEFT, keys, at(*places[-1]))

    round_(400, 250, 90)
    round_(380, 240, 20, Qt.KeyboardModifier.AltModifier)
    lassos = shell.project.document.masks[0].lassos
    assert [lasso.subtract for lasso in lassos] == [False, True]
    assert len(shell.project.session.history.versions) == entries + 2
    shell.project.cancel_work()
    round_(420, 250, 60)
    assert len(shell.project.document.masks[0].lassos) == 1, "without a key the mask is begun anew"
    assert len(shell.project.session.history.versions) == entries + 3


def test_contact_by_two_clicks(shell: Shell) -> None:
    """C, the point in frame 3, the point in frame 7: a contact 3-7; a click inside takes it away."""
    track = next(each for each in shell.project.document.tracks if not each.contacts)
    shell.project.select_track(track.id)
    go(shell, 3)
    QTest.keyClick(shell, Qt.Key.Key_C)
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place_of(shell, track.id)))
    assert "frame 3" in shell.status.hint.text()
    go(shell, 7)
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place_of(shell, track.id)))
    spans = [contact.span for contact in shell.project.document.track(track.id).contacts]
    assert [(span.first, span.last) for span in spans] == [(3, 7)]
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place_of(shell, track.id)))
    assert not shell.project.document.track(track.id).contacts


def test_name_and_colour(shell: Shell) -> None:
    """A typed name and a clicked colour are edits; single letters do not trigger tools while typing."""
    track = shell.project.document.tracks[0]
    shell.project.select_track(track.id)
    settle()
    field = shell.video.inspector.name
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, "paw cv")
    assert shell.video.tool == "select"
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert shell.project.document.track(track.id).name == "paw cv"
    QTest.mouseClick(shell.video.inspector.colours, LEFT, pos=at(20 * 5 + 10, 12))
    assert shell.project.document.track(track.id).colour == 5
    field.selectAll()
    QTest.keyClicks(field, shell.project.document.tracks[1].name)
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert "already called" in shell.video.errors.sentence.text()
    assert shell.video.errors.isVisible()
    assert field.text() == "paw cv"


def test_nudging_is_one_entry(shell: Shell) -> None:
    """Four strokes of Ctrl+Right move the click by one pixel and undo together."""
    track = shell.project.document.tracks[0]
    shell.project.select_track(track.id)
    go(shell, 8)
    before = track.clicks[8]
    entries = len(shell.project.session.history.versions)
    for _ in range(4):
        QTest.keyClick(shell, Qt.Key.Key_Right, Qt.KeyboardModifier.ControlModifier)
    x, y = shell.project.document.track(track.id).clicks[8]
    assert (x - before[0], y - before[1]) == pytest.approx((1.0, 0.0))
    assert len(shell.project.session.history.versions) == entries + 1


def test_point_windows_show_the_point_and_jump(shell: Shell) -> None:
    """The column has the click before and after; a click on its last window goes there."""
    track = shell.project.document.tracks[1]
    shell.project.select_track(track.id)
    go(shell, 11)
    frames = [window.frame for window in shell.video.windows.windows]
    assert frames[0] == 8
    assert frames[-1] == 16
    assert 11 in frames
    step = shell.video.windows._step()
    QTest.mouseClick(shell.video.windows, LEFT, pos=at(40, 34 + step * (len(frames) - 1) + 20))
    assert shell.project.frame == 16


def test_toggles_change_the_picture(shell: Shell) -> None:
    """Paths, names and all marks can be hidden; each changes what is seen."""
    go(shell, 10)
    seen = shell.video.canvas.grab().toImage()
    QTest.mouseClick(shell.video.paths_button, LEFT)
    settle()
    without = shell.video.canvas.grab().toImage()
    assert without != seen
    QTest.keyClick(shell, Qt.Key.Key_O)
    settle()
    bare = shell.video.canvas.grab().toImage()
    assert bare != without
    QTest.keyClick(shell, Qt.Key.Key_O)
    QTest.mouseClick(shell.video.paths_button, LEFT)
    settle()
    assert shell.video.canvas.grab().toImage() == seen


def test_a_row_of_the_timeline_selects_its_point(shell: Shell) -> None:
    """A click on a bar selects the point and goes to the frame."""
    lanes = shell.timeline.lanes
    lane = next(each for each in lanes.placed if each.lane.id == "tracks")
    row, top, height = lane.rows[3]
    QTest.mouseClick(lanes, LEFT, pos=at(lanes.axis.x(13), top + height / 2))
    assert shell.project.track_id == row.id
    assert shell.project.frame == 13


def test_what_is_done_takes_one_line_beside_a_point(shell: Shell) -> None:
    """With a point chosen the list of steps keeps to what is not done; without one it has all of them again."""
    rows = shell.video.steps._rows

    def titles() -> list[str]:
        return [row[1].text() for row in rows if row[1].isVisible()]

    settle(50)
    everything = titles()
    assert {"Points", "Camera", "Ground", "Pairs", "Motion"} <= set(everything)
    shell.project.select_track(shell.project.document.tracks[0].id)
    settle(50)
    assert titles()[0] == "Done"
    assert "camera" in rows[0][2].text()
    assert "Masks" in titles(), "they are not drawn yet"
    assert "Camera" not in titles()
    shell.project.select_track("")
    settle(50)
    assert titles() == everything
