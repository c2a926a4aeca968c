"""The 2D picture: view, hits and gestures as pure functions, and the widget with real events."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QImage, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.window.canvas import Canvas, TrackLayer, TrackMark, View, as_image, fitted
from app.window.canvas.gestures import (
    Cancelled,
    Chosen,
    DragGesture,
    Drawing,
    Drawn,
    LassoGesture,
    Moved,
    Moving,
    Placed,
    PlaceGesture,
)
from app.window.canvas.hits import inside, nearest_edge, nearest_point
from tests.window.conftest import at, drag, hover

places = st.floats(-2000, 2000)
views = st.builds(View, st.floats(0.06, 60), places, places)


@given(views, places, places)
def test_there_and_back(view: View, x: float, y: float) -> None:
    """A picture point survives the way to the widget and back."""
    assert np.allclose(view.to_picture(view.to_widget((x, y))), (x, y), atol=1e-6)


@given(views, st.floats(0.2, 5), places, places)
def test_zoom_keeps_the_place_under_the_mouse(view: View, factor: float, x: float, y: float) -> None:
    """Zooming at the mouse moves nothing under it."""
    before = view.to_picture((x, y))
    assert np.allclose(view.zoomed(factor, x, y).to_picture((x, y)), before, atol=1e-6 * (1 + np.abs(before).max()))


def test_pixel_centres_are_at_integers() -> None:
    """At scale 10 the centre of pixel (0, 0) is 5 widget pixels from the corner."""
    assert View(10.0, 0.0, 0.0).point(0, 0) == (5.0, 5.0)


@given(st.integers(1, 4000), st.integers(1, 4000), st.integers(50, 3000), st.integers(50, 3000))
def test_fit_shows_the_whole_picture_centred(w: int, h: int, width: int, height: int) -> None:
    """The fitted picture lies inside the widget and touches two of its borders."""
    view = fitted((w, h), (width, height))
    if 0.05 < view.scale < 64:
        assert view.x >= -1e-6
        assert view.y >= -1e-6
        assert min(abs(view.x), abs(view.y)) < 1e-6
        assert view.x + view.scale * w <= width + 1e-6


def test_nearest_point_ignores_what_is_absent_or_far() -> None:
    """NaN rows and rows out of reach are not found; of two near ones the nearer is."""
    rows = [(np.nan, np.nan), (10, 10), (13, 10), (100, 100)]
    found = nearest_point((12.5, 10), rows, ["a", "b", "c", "d"], 10)
    assert found is not None
    assert found.owner == "c"
    assert nearest_point((60, 60), rows, ["a", "b", "c", "d"], 10) is None
    assert nearest_point((0, 0), [], [], 10) is None


@given(st.floats(0.1, 0.9), st.floats(-3, 3))
def test_edges_are_hit_by_their_distance(share: float, off: float) -> None:
    """A place beside the first edge of a square is found at its true distance."""
    square = [(0, 0), (100, 0), (100, 100), (0, 100)]
    found = nearest_edge((100 * share, off), square, 5)
    assert found is not None
    assert found[1] == pytest.approx(abs(off), abs=1e-9)


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_inside_a_polygon(x: float, y: float) -> None:
    """The even-odd rule agrees with the circle that a fine polygon draws, away from its border."""
    angles = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    polygon = np.column_stack([np.cos(angles), np.sin(angles)])
    radius = math.hypot(x, y)
    if abs(radius - 1) > 0.01:
        assert inside((x, y), polygon) == (radius < 1)


def test_a_drag_keeps_its_distance_to_the_mouse() -> None:
    """The thing does not jump under the mouse at the press."""
    gesture = DragGesture("t1", (100.0, 50.0), slack=2.0)
    assert gesture.press((103.0, 52.0)) is None
    assert gesture.move((104.0, 52.0)) is None
    assert gesture.move((113.0, 62.0)) == Moving("t1", (110.0, 60.0), (100.0, 50.0))
    assert gesture.release((123.0, 72.0)) == Moved("t1", (120.0, 70.0), (100.0, 50.0))


def test_a_press_without_a_way_chooses() -> None:
    """A click is no drag."""
    gesture = DragGesture("t1", (100.0, 50.0))
    gesture.press((100.0, 50.0))
    gesture.move((101.0, 50.0))
    assert gesture.release((101.0, 50.0)) == Chosen("t1")


def test_escape_gives_a_drag_up() -> None:
    """A cancelled drag says so; one that never began says nothing."""
    gesture = DragGesture("t1", (0.0, 0.0))
    gesture.press((0.0, 0.0))
    assert gesture.cancel() is None
    gesture.move((50.0, 0.0))
    assert gesture.cancel() == Cancelled("t1")


def test_placing_needs_a_still_hand() -> None:
    """Moving away by much gives a new point up."""
    gesture = PlaceGesture(6.0)
    gesture.press((10.0, 10.0))
    assert gesture.release((12.0, 10.0)) == Placed((12.0, 10.0))
    gesture.press((10.0, 10.0))
    assert gesture.release((40.0, 10.0)) == Cancelled()


def test_lasso_closes_itself_and_refuses_a_line() -> None:
    """A round line is drawn, one around nothing is given up."""
    gesture = LassoGesture("add")
    assert isinstance(gesture.press((0.0, 0.0)), Drawing)
    for place in ((50.0, 0.0), (50.0, 50.0), (0.0, 50.0)):
        gesture.move(place)
    done = gesture.release((0.0, 10.0))
    assert isinstance(done, Drawn)
    assert done.mode == "add"
    assert len(done.points) == 4
    gesture.press((0.0, 0.0))
    for x in range(1, 9):
        gesture.move((10.0 * x, 0.0))
    assert gesture.release((90.0, 0.0)) == Cancelled()


@pytest.fixture
def canvas(qapp: QApplication) -> Canvas:
    """A canvas with a picture of 64 x 36 whose pixel (20, 10) is white; it drags whatever is pressed."""
    frame = np.zeros((36, 64, 3), np.uint8)
    frame[10, 20] = 255
    canvas = Canvas(lambda place, keys: DragGesture("t", place))
    canvas.resize(640, 400)
    canvas.show()
    canvas.show_picture(as_image(frame))
    yield canvas
    canvas.close()
    canvas.deleteLater()


def wheel(canvas: Canvas, x: float, y: float, steps: int) -> None:
    """Turn the wheel at a place."""
    place = QPointF(x, y)
    event = QWheelEvent(
        place,
        QPointF(canvas.mapToGlobal(place.toPoint())),
        QPoint(),
        QPoint(0, 120 * steps),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(canvas, event)


def test_a_pixel_is_painted_where_the_view_says(canvas: Canvas) -> None:
    """The white pixel appears at its widget place, after zooming too."""
    for turns in (0, 4):
        if turns:
            wheel(canvas, 200, 100, turns)
        x, y = canvas.view.point(20, 10)
        assert canvas.grab().toImage().pixelColor(int(x), int(y)).lightness() > 200


def test_wheel_zooms_at_the_cursor_and_double_click_fits(canvas: Canvas) -> None:
    """The picture point under the mouse stays; a double click shows everything again."""
    whole = canvas.view
    before = canvas.view.to_picture((200, 100))
    wheel(canvas, 200, 100, 3)
    assert canvas.view.scale > 1.5 * whole.scale
    assert np.allclose(canvas.view.to_picture((200, 100)), before, atol=1e-6)
    QTest.mouseDClick(canvas, Qt.MouseButton.LeftButton, pos=at(300, 200))
    assert canvas.view == whole


def test_middle_button_pans(canvas: Canvas) -> None:
    """The picture follows the mouse by as much as it moves."""
    before = canvas.view
    QTest.mousePress(canvas, Qt.MouseButton.MiddleButton, pos=at(100, 100))
    hover(canvas, at(140, 130))
    QTest.mouseRelease(canvas, Qt.MouseButton.MiddleButton, pos=at(140, 130))
    assert (canvas.view.x - before.x, canvas.view.y - before.y) == (40, 30)


def test_left_drag_gives_events_in_picture_places(canvas: Canvas) -> None:
    """What the gesture says arrives, in pixels of the picture."""
    events: list[object] = []
    canvas.happened.connect(events.append)
    start, end = canvas.view.point(20, 10), canvas.view.point(30, 20)
    drag(canvas, start, end)
    assert isinstance(events[-1], Moved)
    assert np.allclose(events[-1].place, (30, 20), atol=0.15)


def test_escape_cancels_the_gesture(canvas: Canvas) -> None:
    """Nothing is decided after Escape, not even at the release."""
    events: list[object] = []
    canvas.happened.connect(events.append)
    drag(canvas, (100, 100), (200, 200), release=False)
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=at(200, 200))
    assert events[-1] == Cancelled("t")


def test_tracks_are_drawn_where_they_are(canvas: Canvas) -> None:
    """The ring of a track appears round its position in its colour."""
    positions = np.tile((40.0, 20.0), (5, 1))
    canvas.show_layers([TrackLayer((TrackMark("t", "paw", "#FF0000", positions),), 2, paths=False, names=False)])
    x, y = canvas.view.point(40, 20)
    image = canvas.grab().toImage()
    reds = [image.pixelColor(int(x + dx), int(y)) for dx in range(-8, 9)]
    assert any(colour.red() > 200 and colour.green() < 90 for colour in reds)


def test_a_track_that_is_absent_draws_nothing(canvas: Canvas) -> None:
    """NaN positions leave the picture as it was."""
    empty = canvas.grab().toImage()
    mark = TrackMark("t", "paw", "#FF0000", np.full((5, 2), np.nan))
    canvas.show_layers([TrackLayer((mark,), 2)])
    assert canvas.grab().toImage() == empty


def test_magnifier_shows_the_place_under_the_mouse(canvas: Canvas) -> None:
    """The loupe at the white pixel is bright in its middle ring and absent when switched off."""
    x, y = canvas.view.point(20, 10)
    plain = canvas.grab().toImage()
    canvas.magnify = True
    hover(canvas, at(x, y))
    loupe = canvas.grab().toImage()
    assert loupe != plain
    canvas.magnify = False
    assert canvas.grab().toImage() == plain


def test_empty_canvas_takes_events(qapp: QApplication) -> None:
    """Without a picture nothing happens and nothing fails."""
    canvas = Canvas(lambda place, keys: DragGesture("t", place))
    canvas.resize(300, 200)
    canvas.show_picture(QImage())
    drag(canvas, (10, 10), (100, 100))
    wheel(canvas, 10, 10, 2)
    canvas.grab()
    canvas.deleteLater()
