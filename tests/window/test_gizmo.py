"""The gizmo that places a character: what each part means, as pure geometry, and by a real mouse."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.actions.aligning import stood
from app.window.viewport import Gizmo, GizmoMoved, GizmoMoving, GizmoReleased, Viewport
from app.window.viewport.gizmo import SIZE, GizmoDrag
from app.window.viewport.orbit import Orbit
from imitation.geometry import Camera
from tests.window.conftest import at, drag, settle

CENTRE = (0.2, -0.1, 0.8)
CAMERA = Orbit((0, 0, 0.8), 4.0, 0.6, 0.3).camera((800, 600))


def dragged(mode: str, part: str, start: tuple[float, float], end: tuple[float, float], **keys: bool) -> object:
    """A press at start, a move to end, and letting go there."""
    held = GizmoDrag(CAMERA, Gizmo(mode, CENTRE), part)  # type: ignore[arg-type]
    held.press(start)
    held.hold(shift=keys.get("shift", False), control=keys.get("control", False))
    assert held.move(end) is not None
    done = held.release(end)
    assert isinstance(done, GizmoMoved)
    return done.change


def pixel(place: object) -> tuple[float, float]:
    """Where a place is seen."""
    x, y = CAMERA.project(np.asarray(place, float))
    return float(x), float(y)


@pytest.mark.parametrize("axis", range(3))
def test_an_axis_moves_along_itself_and_stays_under_the_mouse(axis: int) -> None:
    """The shift is along the axis alone, and its end is seen where the mouse is."""
    wanted = np.array(CENTRE) + 0.4 * np.eye(3)[axis]
    change = dragged("move", "xyz"[axis], pixel(CENTRE), pixel(wanted))
    assert np.allclose(change.shift, 0.4 * np.eye(3)[axis], atol=1e-6)
    assert change.scale == 1.0


def test_the_body_moves_in_the_plane_of_the_picture_and_by_shift_along_its_ray() -> None:
    """The centre is under the mouse at its own depth; with Shift it keeps its pixel and comes nearer."""
    x, y = pixel(CENTRE)
    change = dragged("move", "body", (x, y), (x + 60, y - 40))
    moved = np.add(CENTRE, change.shift)
    assert np.allclose(pixel(moved), (x + 60, y - 40))
    assert math.isclose(CAMERA.depth(moved), CAMERA.depth(np.array(CENTRE)))
    pulled = np.add(CENTRE, dragged("move", "body", (x, y), (x, y + 80), shift=True).shift)
    assert np.allclose(pixel(pulled), (x, y))
    assert CAMERA.depth(pulled) < CAMERA.depth(np.array(CENTRE))


@pytest.mark.parametrize("axis", range(3))
def test_a_ring_turns_about_its_axis_by_the_angle_of_the_mouse(axis: int) -> None:
    """A point of the ring that is carried 0.5 radians on along it turns the character by as much."""
    gizmo = Gizmo("rotate", CENTRE)
    u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
    ring = [np.array(CENTRE) + gizmo.length(CAMERA) * (math.cos(a) * u + math.sin(a) * v) for a in (0.3, 0.8)]
    change = dragged("rotate", "xyz"[axis], pixel(ring[0]), pixel(ring[1]))
    assert np.allclose(change.turn, 0.5 * np.eye(3)[axis], atol=1e-6)
    assert np.allclose(dragged("rotate", "xyz"[axis], pixel(ring[0]), pixel(ring[1]), control=True).turn,
                       math.radians(30) * np.eye(3)[axis], atol=1e-9)  # fmt: skip


def test_a_ring_seen_from_its_edge_turns_with_its_near_side() -> None:
    """The near side of the character goes where the mouse goes, one radian for the gizmo's size."""
    level = Orbit((0, 0, 0.8), 4.0, 0.6, 0.0).camera((800, 600))
    held = GizmoDrag(level, Gizmo("rotate", (0, 0, 0.8)), "z")
    held.press((400, 300))
    held.move((400 + SIZE / 2, 300))
    turn = held.change().turn
    near = np.array([0, 0, 0.8]) - 0.2 * level.R[2]
    after = stood(near[None], (0, 0, 0.8), shift=(0, 0, 0), turn=turn, scale=1.0)[0]
    assert abs(turn[2]) == pytest.approx(0.5, rel=0.05)
    assert level.project(after)[0] > level.project(near)[0]


def test_the_centre_turns_as_the_mouse_goes_round_it() -> None:
    """A quarter round the centre, clockwise as it is seen, is a quarter about the line of sight."""
    x, y = pixel(CENTRE)
    change = dragged("rotate", "body", (x + 90, y), (x, y + 90))
    assert np.allclose(change.turn, math.pi / 2 * CAMERA.R[2], atol=1e-6)


def test_scale_follows_the_distance_to_the_centre() -> None:
    """Twice as far out is twice as large; Ctrl goes in steps; it never vanishes."""
    x, y = pixel(CENTRE)
    assert dragged("scale", "x", (x + 60, y), (x + 120, y)).scale == pytest.approx(2.0)
    assert dragged("scale", "x", (x + 60, y), (x + 92, y), control=True).scale == pytest.approx(1.55)
    assert dragged("scale", "x", (x + 60, y), (x - 300, y)).scale > 0
    assert dragged("scale", "body", (x, y), (x, y - 50)).scale > 1.2


def test_parts_are_found_where_they_are_drawn() -> None:
    """The ends of the axes, the middle, a point of a ring; nothing beside them."""
    gizmo = Gizmo("move", CENTRE)
    for name, line in gizmo.lines(CAMERA).items():
        assert gizmo.part_at(CAMERA, tuple(line[1])) == name
        assert np.linalg.norm(line[1] - line[0]) < 1.2 * SIZE
    assert gizmo.part_at(CAMERA, pixel(CENTRE)) == "body"
    assert gizmo.part_at(CAMERA, (5.0, 5.0)) is None
    rings = Gizmo("rotate", CENTRE)
    found = {name: rings.part_at(CAMERA, tuple(line[10])) for name, line in rings.lines(CAMERA).items()}
    assert found == {"x": "x", "y": "y", "z": "z"}


@pytest.fixture
def view(qapp: QApplication) -> Iterator[Viewport]:
    """A viewport with a ball and a gizmo on it."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=3)
    view = Viewport("raster")
    view.resize(600, 450)
    view.show()
    view.show_mesh(np.add(mesh.vertices, (0, 0, 1)), np.asarray(mesh.faces, np.int32), None)
    view.fit()
    view.show_gizmo(Gizmo("move", (0.0, 0.0, 1.0)))
    settle()
    yield view
    view.close()
    view.deleteLater()


def lens_of(view: Viewport) -> Camera:
    """What the view looks through."""
    return view.lens().camera


def test_the_mouse_takes_an_axis_and_the_body(view: Viewport) -> None:
    """A drag of the arrow reports a shift along it, live and at the end; a drag of the mesh itself moves it whole."""
    events: list[object] = []
    view.happened.connect(events.append)
    line = view.gizmo.lines(lens_of(view))["z"]
    x, y = (float(value) for value in line[1])
    drag(view, (x, y), (x, y - 50))
    assert isinstance(events[0], GizmoMoving)
    assert isinstance(events[-1], GizmoMoved)
    assert events[-1].change.shift[:2] == pytest.approx((0, 0))
    assert events[-1].change.shift[2] > 0.1
    events.clear()
    x, y = (float(value) for value in lens_of(view).project(np.array([0.0, 0.0, 1.0])))
    drag(view, (x - 70, y + 60), (x - 20, y + 60))
    moved = lens_of(view).project(np.array([0.0, 0.0, 1.0]) + events[-1].change.shift)
    assert moved == pytest.approx((x + 50, y), abs=1.0)


def test_escape_gives_the_gizmo_up_and_keys_hold_an_axis(view: Viewport) -> None:
    """X during a drag of the body holds it to x; Escape takes it back, and the release decides nothing."""
    events: list[object] = []
    view.happened.connect(events.append)
    x, y = (float(value) for value in lens_of(view).project(np.array([0.0, 0.0, 1.0])))
    drag(view, (x, y), (x + 60, y - 30), release=False)
    QTest.keyClick(view, Qt.Key.Key_X)
    assert events[-1].change.shift[1:] == pytest.approx((0, 0))
    QTest.keyClick(view, Qt.Key.Key_Escape)
    assert isinstance(events[-1], GizmoReleased)
    count = len(events)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=at(x + 60, y - 30))
    assert len(events) == count


def test_the_gizmo_is_drawn_in_the_colours_of_the_axes(view: Viewport) -> None:
    """Its three tips are seen, for each thing it does."""
    for mode in ("move", "scale"):
        view.show_gizmo(Gizmo(mode, (0.0, 0.0, 1.0)))  # type: ignore[arg-type]
        settle()
        picture = view.grab().toImage()
        for name, colour in (("x", "red"), ("y", "green"), ("z", "blue")):
            x, y = view.gizmo.lines(lens_of(view))[name][1]
            seen = picture.pixelColor(round(x) + 4, round(y) + 3)
            strongest = max(("red", "green", "blue"), key=lambda part, seen=seen: getattr(seen, part)())
            assert strongest == colour, (mode, name, seen.name())
