"""Changes made in the lanes with a real mouse: contacts painted and trimmed, masks retimed, the range, proposals."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import scene
from app.model.values import Interval
from app.window.lanes_of import worst_near
from app.window.shell import Shell
from app.window.timeline import Bar, Diamond, Lane, LaneEdit, Row
from app.window.timeline.axis import Axis
from app.window.timeline.drags import LaneDrag, drag_from
from app.window.timeline.lanes import RULER, hit, layout
from tests.window.conftest import at, drag, settle

LEFT = Qt.MouseButton.LeftButton
LANES = (
    Lane("video", "Video", "video", (Row("masks", (), (Diamond(10),)),), 12, 1, edits=("retime",)),
    Lane(
        "contacts",
        "Contacts",
        "contact",
        (Row("t1", (Bar(20, 40, "contact"), Bar(60, 70, "contact", "hatch"))),),
        9,
        6,
        edits=("paint", "trim"),
    ),
)


def test_what_a_press_takes_hold_of() -> None:
    """Ends of runs, diamonds, empty places and handles; a proposal has no ends to trim."""
    axis, placed = Axis().sized(1200, 100), layout(LANES)
    _, top, height = placed[1].rows[0]
    y, range_ = top + height / 2, (5, 90)

    def held(x: float, y: float) -> LaneDrag | None:
        found = hit(placed, axis, x, y, range_=range_)
        return None if found is None else drag_from(found, placed, range_)

    assert held(axis.x(20), y) == LaneDrag("trim", "contacts", "t1", 20, (20, 40), "first")
    assert held(axis.x(40) + 3, y) == LaneDrag("trim", "contacts", "t1", 40, (20, 40), "last")
    assert held(axis.x(30), y) is None
    assert held(axis.x(60), y) is None
    assert held(axis.x(50), y) == LaneDrag("paint", "contacts", "t1", 50)
    assert held(axis.x(10), placed[0].rows[0][1] + 5) == LaneDrag("retime", "video", "masks", 10)
    assert held(axis.x(5) - 3, RULER - 2) == LaneDrag("range", "", "", 5, (5, 90), "first")
    assert held(axis.x(90) + 3, RULER - 2) == LaneDrag("range", "", "", 90, (5, 90), "last")
    assert held(axis.x(5), 8) is None


def test_what_a_drag_means() -> None:
    """Back where it began is nothing; a run is painted in either direction; ends never cross."""
    paint = LaneDrag("paint", "contacts", "t1", 50)
    assert paint.edit(50) is None
    assert paint.edit(44) == LaneEdit("paint", "contacts", "t1", 50, 44, 50)
    trim = LaneDrag("trim", "contacts", "t1", 20, (20, 40), "first")
    assert trim.edit(70) == LaneEdit("trim", "contacts", "t1", 40, 40, 40)
    assert trim.edit(15) == LaneEdit("trim", "contacts", "t1", 40, 15, 40)


def test_the_worst_frame_near_a_click() -> None:
    """Only frames within reach count; where nothing is known it is the frame itself."""
    values = np.array([0.1, 5.0, 0.2, 0.3, 0.9, np.nan, 0.1])
    assert worst_near(values, 3, 1) == 4
    assert worst_near(values, 3, 2) == 1
    assert worst_near(np.full(7, np.nan), 3, 2) == 3


def row_place(shell: Shell, lane: str, row: str, frame: int) -> tuple[float, float]:
    """Where a frame of a row is in the lanes."""
    lanes = shell.timeline.lanes
    placed = next(each for each in lanes.placed if each.lane.id == lane)
    _, top, height = next(each for each in placed.rows if each[0].id == row)
    return lanes.axis.x(frame), top + height / 2


@pytest.fixture
def still(shell: Shell) -> Shell:
    """The window, in which nothing is computed of its own accord."""
    shell.opened.keeper.automatic = False
    settle()
    return shell


def spans(shell: Shell, track_id: str) -> list[tuple[int, int]]:
    """The contacts of a track."""
    return [(each.span.first, each.span.last) for each in shell.project.document.track(track_id).contacts]


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_a_contact_is_painted_trimmed_and_undone(still: Shell) -> None:
    """Over the row of the selected point a drag paints, a drag of the end trims: one entry each; Escape gives up."""
    shell, lanes = still, still.timeline.lanes
    track = next(each for each in shell.project.document.tracks if not each.contacts)
    shell.project.select_track(track.id)
    settle()
    entries, before = len(shell.project.session.history.versions), shell.project.document
    drag(lanes, row_place(shell, "contacts", track.id, 4), row_place(shell, "contacts", track.id, 9))
    assert spans(shell, track.id) == [(4, 9)]
    settle(80)
    drag(lanes, row_place(shell, "contacts", track.id, 9), row_place(shell, "contacts", track.id, 13))
    assert spans(shell, track.id) == [(4, 13)]
    assert len(shell.project.session.history.versions) == entries + 2
    assert shell.project.session.history.undo_label.startswith("Trim contact")
    settle(80)
    start, end = row_place(shell, "contacts", track.id, 4), row_place(shell, "contacts", track.id, 11)
    drag(lanes, start, end, release=False)
    assert lanes.preview == LaneEdit("trim", "contacts", track.id, 13, 11, 13)
    QTest.keyClick(shell, Qt.Key.Key_Escape)
    QTest.mouseRelease(lanes, LEFT, pos=at(*end))
    assert spans(shell, track.id) == [(4, 13)]
    shell.do("undo")
    shell.do("undo")
    assert shell.project.document == before


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_shift_c_marks_frame_by_frame(still: Shell) -> None:
    """Without the mouse: one frame, its neighbour joins, a frame in the middle parts them."""
    shell = still
    track = next(each for each in shell.project.document.tracks if not each.contacts)
    shell.project.select_track(track.id)
    for frame in (3, 4, 5):
        shell.project.show_frame(frame)
        settle()
        QTest.keyClick(shell, Qt.Key.Key_C, Qt.KeyboardModifier.ShiftModifier)
    assert spans(shell, track.id) == [(3, 5)]
    shell.project.show_frame(4)
    settle()
    QTest.keyClick(shell, Qt.Key.Key_C, Qt.KeyboardModifier.ShiftModifier)
    assert spans(shell, track.id) == [(3, 3), (5, 5)]


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_the_range_by_its_handles_and_by_keys(still: Shell) -> None:
    """The in handle is dragged; ] ends the range here; the backslash takes it away."""
    shell, lanes = still, still.timeline.lanes
    drag(lanes, (lanes.axis.x(0) - 3, RULER - 3), (lanes.axis.x(6), RULER - 3))
    assert shell.project.document.range == Interval(6, 23)
    shell.project.show_frame(15)
    QTest.keyClick(shell, Qt.Key.Key_BracketRight)
    assert shell.project.document.range == Interval(6, 15)
    QTest.keyClick(shell, Qt.Key.Key_Backslash)
    assert shell.project.document.range is None


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_a_mask_is_retimed_and_refused_where_one_is(still: Shell) -> None:
    """Its diamond is dragged to another frame; onto another mask it says why not."""
    shell, lanes = still, still.timeline.lanes
    for frame in (2, 12):
        shell.project.edit(scene.add_lasso, frame, [(60, 40), (140, 40), (140, 100)])
    settle(80)
    drag(lanes, row_place(shell, "video", "masks", 2), row_place(shell, "video", "masks", 7))
    assert list(shell.project.document.masks) == [7, 12]
    settle(80)
    drag(lanes, row_place(shell, "video", "masks", 7), row_place(shell, "video", "masks", 12))
    assert list(shell.project.document.masks) == [7, 12]
    assert "has a mask already" in shell.video.errors.sentence.text()


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_proposals_are_hatched_and_accepted_one_by_one_or_all(still: Shell) -> None:
    """A double click accepts one; Shift+Return the rest as one entry; what is marked is proposed no more."""
    shell, lanes = still, still.timeline.lanes
    one, other = [each for each in shell.project.document.tracks if not each.contacts][:2]
    shell.video.proposals.found = {one.id: [Interval(2, 6), Interval(10, 14)], other.id: [Interval(4, 8)]}
    shell.video.lanes_changed.emit()
    settle(120)
    lane = next(each for each in lanes.lanes if each.id == "contacts")
    assert sum(bar.style == "hatch" for row in lane.rows for bar in row.bars) == 3
    QTest.mouseDClick(lanes, LEFT, pos=at(*row_place(shell, "contacts", one.id, 4)))
    assert spans(shell, one.id) == [(2, 6)]
    assert shell.project.document.track(one.id).contacts[0].accepted
    settle(120)
    assert shell.video.accept_button.text() == "Accept all 2"
    entries = len(shell.project.session.history.versions)
    QTest.keyClick(shell, Qt.Key.Key_Return, Qt.KeyboardModifier.ShiftModifier)
    assert (spans(shell, one.id), spans(shell, other.id)) == ([(2, 6), (10, 14)], [(4, 8)])
    assert len(shell.project.session.history.versions) == entries + 1
    assert shell.project.session.history.undo_label == "Accept 2 contacts"


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_n_goes_where_a_click_helps_and_keys_mark_the_point(still: Shell) -> None:
    """N chooses a point and a frame without a click; X hides it there, E ends it, Shift+H keeps it undrawn."""
    shell = still
    shell.project.select_track("")
    QTest.keyClick(shell, Qt.Key.Key_N)
    track_id, frame = shell.project.track_id, shell.project.frame
    assert track_id
    assert frame not in shell.project.document.track(track_id).clicks
    settle()
    QTest.keyClick(shell, Qt.Key.Key_X)
    assert shell.project.document.track(track_id).occluded == (Interval(frame, frame),)
    QTest.keyClick(shell, Qt.Key.Key_X)
    assert shell.project.document.track(track_id).occluded == ()
    shell.project.show_frame(20)
    settle()
    QTest.keyClick(shell, Qt.Key.Key_E)
    assert shell.project.document.track(track_id).absent == (Interval(20, 23),)
    QTest.keyClick(shell, Qt.Key.Key_H, Qt.KeyboardModifier.ShiftModifier)
    assert not shell.project.document.track(track_id).visible
