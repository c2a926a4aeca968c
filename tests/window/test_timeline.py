"""The timeline: axis, layout and hits as pure functions, and the lanes on the screen."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.window.lanes_of import span_bars
from app.window.timeline import Bar, Curve, Diamond, Lane, LaneView, Row, Transport
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import FEWEST, RULER, fitted, hit, layout, total_height
from tests.window.conftest import at, drag

axes = st.builds(lambda count, width: Axis().sized(width, count), st.integers(2, 5000), st.integers(500, 3000))

LANES = (
    Lane("video", "Video", "video", (Row("masks", (), (Diamond(0), Diamond(50))),), 12, 1, thumbnails=True),
    Lane(
        "tracks",
        "Points",
        "tracks",
        (
            Row("t1", (Bar(0, 40, "#58C4DD"),), (Diamond(0), Diamond(20)), selected=True),
            Row("t2", (Bar(0, 99, "#F78FB3"),), (Diamond(10),)),
        ),
        9,
        8,
    ),
    Lane("curve", "Error", "reprojection", curve=Curve(np.linspace(0, 5, 100), 3.0)),
)


@given(axes, st.floats(0.3, 4), st.floats(0, 1))
def test_zoom_keeps_the_frame_under_the_mouse(axis: Axis, factor: float, share: float) -> None:
    """The frame under the mouse stays, unless the clip's ends are reached."""
    x = axis.left + share * axis.room
    zoomed = axis.zoomed(4.0, x)
    again = zoomed.zoomed(factor, x)
    limit = max(again.count - 1 - again.room / again.pixels, 0)
    if 1e-6 < again.first < limit - 1e-6:
        before = zoomed.first + (x - zoomed.left) / zoomed.pixels
        assert again.first + (x - again.left) / again.pixels == pytest.approx(before, abs=1e-6)
    assert 0 <= again.first <= limit + 1e-6


@given(axes, st.data())
def test_frames_and_places_are_inverse(axis: Axis, data: st.DataObject) -> None:
    """The frame found at a frame's own place is that frame; the clip fits its room."""
    frame = data.draw(st.integers(0, axis.count - 1))
    assert axis.frame(axis.x(frame)) == frame
    assert axis.x(axis.count - 1) <= axis.width


@given(axes, st.floats(0, 1), st.data())
def test_showing_brings_a_frame_into_sight(axis: Axis, share: float, data: st.DataObject) -> None:
    """After zooming anywhere, any frame can be brought into sight."""
    zoomed = axis.zoomed(6.0, axis.left + share * axis.room)
    frame = data.draw(st.integers(0, axis.count - 1))
    shown = zoomed.showing(frame)
    assert shown.first - 1e-6 <= frame <= shown.last + 1e-6


@given(axes)
def test_ticks_stand_apart(axis: Axis) -> None:
    """Numbered ticks have room for their numbers, small ones divide them."""
    large, small = axis.ticks()
    assert large * axis.pixels >= 63.9
    assert large % small == 0


def test_lanes_stack_without_overlap() -> None:
    """Lanes follow each other, rows lie inside their lane, the selected row is taller."""
    placed = layout(LANES)
    for above, below in itertools.pairwise(placed):
        assert above.top + above.height == below.top
    for each in placed:
        for _, top, height in each.rows:
            assert each.top <= top
            assert top + height <= each.top + each.height
    rows = placed[1].rows
    assert rows[0][2] > rows[1][2]
    assert total_height(placed) >= placed[-1].top + placed[-1].height


def test_hits() -> None:
    """A diamond is found before its bar, labels and ruler are told apart."""
    axis, placed = Axis().sized(1000, 100), layout(LANES)
    (_, top, height), (_, second, _) = placed[1].rows
    middle = top + height / 2
    found = hit(placed, axis, axis.x(20) + 5, middle)
    assert (found.kind, found.row, found.frame) == ("diamond", "t1", 20)
    assert hit(placed, axis, axis.x(33), middle).kind == "bar"
    assert hit(placed, axis, axis.x(70), middle).kind == "row"
    assert hit(placed, axis, axis.x(70), second + 4).kind == "bar"
    assert hit(placed, axis, 20, middle).kind == "label"
    assert hit(placed, axis, axis.x(70), 10).kind == "ruler"
    assert hit(placed, axis, axis.x(70), 10_000) is None


def test_a_span_is_hatched_where_it_is_not_sure() -> None:
    """Bars change where confidence or state changes, and cover the span without gaps."""

    class Plan:
        first, last = 10, 19

    class Span:
        plan = Plan
        confidence = np.array([1.0, 0.9, 0.8, 0.3, 0.2, 0.9, 0.9, 0.9, 0.9, 1.0])
        state = np.array(["visible"] * 7 + ["occluded"] * 2 + ["visible"])

    bars = span_bars(Span, "#FFFFFF")
    assert [(bar.first, bar.last, bar.style) for bar in bars] == [
        (10, 13, "solid"),
        (13, 15, "hatch"),
        (15, 17, "solid"),
        (17, 19, "dim"),
        (19, 19, "solid"),
    ]


@pytest.fixture
def lanes(qapp: QApplication) -> LaneView:
    """The lanes of a clip of 100 frames on the screen."""
    view = LaneView()
    view.resize(1000, 240)
    view.show_lanes(LANES, 100)
    view.show()
    view.grab()
    yield view
    view.close()
    view.deleteLater()


def test_ruler_seeks_while_the_mouse_moves(lanes: LaneView) -> None:
    """Pressing and dragging in the ruler asks for the frames under the mouse."""
    sought: list[int] = []
    lanes.sought.connect(sought.append)
    drag(lanes, (lanes.axis.x(10), 10), (lanes.axis.x(60), 10), steps=10)
    assert sought[0] == 10
    assert sought[-1] == 60
    assert sought == sorted(sought)


def test_a_click_on_a_diamond_goes_there(lanes: LaneView) -> None:
    """The frame of the diamond is asked for, even when the mouse is some pixels beside it."""
    sought, clicked = [], []
    lanes.sought.connect(sought.append)
    lanes.clicked.connect(clicked.append)
    _, top, height = lanes.placed[1].rows[0]
    QTest.mouseClick(lanes, Qt.MouseButton.LeftButton, pos=at(lanes.axis.x(20) + 4, top + height / 2))
    assert sought == [20]
    assert clicked[0].row == "t1"


def test_only_the_playhead_is_drawn_anew(lanes: LaneView) -> None:
    """Playing does not draw the lanes again; another lane does."""
    count = lanes.still_paints
    for frame in range(30):
        lanes.show_frame(frame)
        lanes.grab()
    assert lanes.still_paints == count
    lanes.show_lanes(LANES[:2], 100)
    lanes.grab()
    assert lanes.still_paints == count + 1


def test_a_lane_that_changes_is_drawn_alone(lanes: LaneView) -> None:
    """The others stay as they are, and the picture is the same as if all were drawn anew."""
    lanes.grab()
    stills, alone = lanes.still_paints, lanes.lane_paints
    first = LANES[1].rows[0]
    changed = replace(LANES[1], rows=(replace(first, bars=(Bar(5, 60, "accent"),)), *LANES[1].rows[1:]))
    lanes.show_lanes((LANES[0], changed, *LANES[2:]), 100)
    image = lanes.grab().toImage()
    assert (lanes.still_paints, lanes.lane_paints) == (stills, alone + 1)
    lanes.refresh()
    assert lanes.grab().toImage() == image
    assert lanes.still_paints == stills + 1


def test_equal_lanes_cost_nothing(lanes: LaneView) -> None:
    """Lanes that are the same values are not drawn again."""
    count = lanes.still_paints
    lanes.show_lanes(tuple(LANES), 100)
    lanes.grab()
    assert lanes.still_paints == count


def test_colours_of_bars_are_on_the_screen(lanes: LaneView) -> None:
    """The bar of a track is painted in its colour at its place."""
    _, top, height = lanes.placed[1].rows[1]
    image = lanes.grab().toImage()
    colour = image.pixelColor(int(lanes.axis.x(70)), int(top + height / 2))
    assert colour.name().upper() == "#F78FB3"
    assert image.pixelColor(LABELS + 3, RULER + 2).name() != colour.name()


def test_transport_asks(qapp: QApplication) -> None:
    """Buttons name what is wanted; the frame number is shown with its seconds."""
    bar, wanted = Transport(), []
    bar.wanted.connect(wanted.append)
    bar.resize(1000, 38)
    bar.show()
    for name in ("play", "next", "last"):
        QTest.mouseClick(bar.buttons[name], Qt.MouseButton.LeftButton)
    assert wanted == ["play", "next", "last"]
    bar.show_frame(50, 101, 25, 2.0)
    assert bar.number.text() == "50"
    assert "of 100" in bar.of.text()
    assert "2.00 s" in bar.of.text()
    bar.close()
    bar.deleteLater()


def test_lanes_show_fewer_rows_where_there_is_little_room() -> None:
    """The lane with most rows gives way first, says so, and keeps three; what has room is left as it is."""
    rows = tuple(Row(f"t{number}", (Bar(0, 99, "#58C4DD"),)) for number in range(20))
    lanes = (replace(LANES[1], rows=rows, counted=True), replace(LANES[1], id="contacts", rows=rows[:6]), LANES[2])
    whole = total_height(layout(lanes))
    assert fitted(lanes, whole) == lanes
    for room in range(whole - 1, 150, -7):
        fit = fitted(lanes, room)
        shown = [min(lane.shown_rows, len(lane.rows)) for lane in fit[:2]]
        assert total_height(layout(fit)) <= room or shown == [FEWEST, FEWEST]
        assert abs(shown[0] - shown[1]) <= 1 or shown[1] == 6, "the one with most rows first"
    assert fitted(lanes, 0)[0].words == f"Points, {FEWEST} of 20"
    placed = layout(fitted(lanes, whole - 9), {"tracks": 13})
    assert placed[0].rows[-1][0].id == "t19", "a lane scrolled to its end with fewer rows shows its end"


def test_a_row_is_scrolled_to_where_few_rows_are_shown(lanes: LaneView) -> None:
    """A point chosen elsewhere is brought into sight in the rows that there is room for."""
    rows = tuple(Row(f"t{number}", (Bar(0, 99, "#58C4DD"),)) for number in range(8))
    lanes.show_lanes((replace(LANES[1], rows=rows), LANES[2]), 100)
    lanes.show_room(100)
    assert len(lanes.placed[0].rows) < 8
    lanes.show_row("tracks", "t7")
    assert "t7" in [row.id for row, _, _ in lanes.placed[0].rows]
    lanes.show_room(1000)
    assert [row.id for row, _, _ in lanes.placed[0].rows] == [row.id for row in rows]
