"""The 3D view on the screen, with its off-screen host, driven by a real mouse."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from app.window.viewport import Handle, VertexChosen, VertexMoved, VertexMoving, Viewport
from app.window.viewport.orbit import Orbit
from imitation.geometry import Camera
from tests.window.conftest import at, drag, settle, wait_for


@pytest.fixture
def ball() -> tuple[np.ndarray, np.ndarray]:
    """A ball of 642 vertices round (0, 0, 1)."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=3)
    return np.add(mesh.vertices, (0, 0, 1)), np.asarray(mesh.faces, np.int32)


@pytest.fixture
def view(qapp: QApplication, ball: tuple[np.ndarray, np.ndarray]) -> Iterator[Viewport]:
    """A viewport that shows the ball."""
    view = Viewport("raster")
    view.resize(600, 450)
    view.show()
    view.show_mesh(*ball, None)
    view.fit()
    settle()
    yield view
    view.close()
    view.deleteLater()


def front_vertex(view: Viewport) -> int:
    """A vertex that looks at the camera, a little off the middle."""
    camera = view.lens().camera
    pixels = camera.project(view.vertices)
    away = np.hypot(*(pixels - (330, 200)).T) + 1e3 * (
        camera.depth(view.vertices) > camera.depth(np.array([0, 0, 1.0]))
    )
    return int(np.argmin(away))


def test_the_mesh_is_seen_in_the_middle(view: Viewport) -> None:
    """The ball is lit clay in the middle, the ground's gradient in the corner."""
    image = view.grab().toImage()
    assert image.pixelColor(300, 225).lightness() > 100
    assert image.pixelColor(5, 5).lightness() < 70


def test_click_chooses_the_vertex_under_the_mouse(view: Viewport) -> None:
    """The chosen vertex is the one whose projection was clicked."""
    events: list[object] = []
    view.happened.connect(events.append)
    vertex = front_vertex(view)
    x, y = view.lens().to_widget(view.vertices[vertex])
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=at(x, y))
    assert events == [VertexChosen(vertex)]


def test_drag_reports_live_and_at_the_end(view: Viewport) -> None:
    """The place reported at the end projects to where the mouse was let go."""
    events: list[object] = []
    view.happened.connect(events.append)
    vertex = front_vertex(view)
    x, y = view.lens().to_widget(view.vertices[vertex])
    drag(view, (x, y), (x + 60, y - 30))
    assert isinstance(events[0], VertexMoving)
    assert isinstance(events[-1], VertexMoved)
    end = view.lens().to_widget(np.array(events[-1].place))
    assert np.hypot(*(end - (x + 60, y - 30))) < 1.5


def test_moving_the_mesh_changes_the_picture(view: Viewport) -> None:
    """An update in place is drawn at the next paint, without a new actor."""
    actors = view.scene.renderer.GetActors().GetNumberOfItems()
    before = view.grab().toImage()
    view.move_mesh(np.add(view.vertices, (0.3, 0.0, 0.0)))
    settle()
    assert view.grab().toImage() != before
    assert view.scene.renderer.GetActors().GetNumberOfItems() == actors


def test_many_changes_are_drawn_once(view: Viewport) -> None:
    """Ten updates between two paints cost one render."""
    settle(400)
    before = view.host.renders
    for step in range(10):
        view.move_mesh(view.vertices + 0.001 * step)
    QApplication.processEvents()
    assert view.host.renders - before == 1


def test_leaving_out_what_faces_away_changes_no_pixel(view: Viewport, ball: tuple[np.ndarray, np.ndarray]) -> None:
    """A closed ball looks the same drawn whole; of an open one the inside is drawn also while it moves."""
    window, pixels = view.host.stage.render_window, vtkUnsignedCharArray()

    def pictures() -> list[np.ndarray]:
        made = []
        for left_out in (True, False):
            view.scene.leave_out_hidden(left_out)
            window.Render()
            window.GetRGBACharPixelData(0, 0, view.width() - 1, view.height() - 1, 0, pixels)
            made.append(vtk_to_numpy(pixels).copy())
        return made

    view._draw(fine=False)
    look = view.scene._actors["mesh"].GetProperty()
    assert look.GetBackfaceCulling()
    moving, whole = pictures()
    assert np.array_equal(moving, whole)
    vertices, faces = ball
    middle = vertices[faces].mean(1)
    eye = view.lens().camera.centre
    view.show_mesh(vertices, faces[((middle - (0, 0, 1)) @ (eye - (0, 0, 1))) < 0], None)
    view._draw(fine=False)
    assert not view.scene._actors["mesh"].GetProperty().GetBackfaceCulling()
    assert view.host._picture.pixelColor(300, 225).alpha() == 255


def test_edges_are_smooth_at_rest(view: Viewport) -> None:
    """A quarter of a second after the last change the picture is drawn once more, finer."""
    view.move_mesh(view.vertices)
    QApplication.processEvents()
    coarse, count = view.grab().toImage(), view.host.renders
    wait_for(lambda: view.host.renders > count, 3)
    settle()
    assert view.host._size[0] == 2 * coarse.width()
    count = view.host.renders
    settle(400)
    assert view.host.renders == count, "nothing may be drawn while nothing changes"


def test_the_fine_picture_waits_for_the_end_of_work(view: Viewport) -> None:
    """While something is computed nothing is drawn beyond what changes; afterwards the fine picture comes."""
    busy = True
    view.calm = lambda: not busy
    view.move_mesh(view.vertices)
    settle(400)
    assert view.host._size[0] == view.width()
    busy = False
    wait_for(lambda: view.host._size[0] == 2 * view.width(), 3)


def test_empty_space_turns_and_the_wheel_goes_closer(view: Viewport) -> None:
    """A drag beside the mesh turns the orbit; Shift moves the target."""
    before = view.orbit
    drag(view, (20, 20), (80, 20))
    assert view.orbit.azimuth != before.azimuth
    turned = view.orbit
    drag(view, (20, 20), (60, 20), keys=Qt.KeyboardModifier.ShiftModifier)
    assert view.orbit.target != turned.target
    assert view.orbit.azimuth == turned.azimuth


def test_handles_are_picked_first_and_drawn(view: Viewport) -> None:
    """A handle in front of nothing is found at its place, and its colour is there."""
    place = tuple(float(each) for each in view.vertices[front_vertex(view)])
    view.show_handles([Handle(3, "paw", place, "edited")])
    settle()
    x, y = view.lens().to_widget(np.array(place))
    assert view.vertex_at((float(x) + 4, float(y))) == 3
    assert view.grab().toImage().pixelColor(int(x), int(y)).red() > 200


def test_escape_puts_a_drag_back(view: Viewport) -> None:
    """After Escape the release decides nothing."""
    events: list[object] = []
    view.happened.connect(events.append)
    x, y = view.lens().to_widget(view.vertices[front_vertex(view)])
    drag(view, (x, y), (x + 60, y), release=False)
    assert view.cancel()
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=at(x + 60, y))
    assert not any(isinstance(event, VertexMoved) for event in events)


def test_mesh_lies_on_the_video_through_the_recovered_camera(view: Viewport) -> None:
    """Small balls drawn through an odd camera are centred on K[R|T]X to a few hundredths of a pixel."""
    import trimesh

    base = Orbit((0, 0, 1), 4.5, 0.5, 0.25).camera((600, 450))
    camera = Camera([[700.0, 0, 333.0], [0, 660.0, 190.0], [0, 0, 1]], base.R, base.T)
    centres = np.array([[0.4, 0.2, 1.1], [-0.5, 0.1, 0.8], [0.1, -0.4, 1.4], [0.0, 0.3, 0.6]])
    picture = QImage(600, 450, QImage.Format.Format_RGB32)
    picture.fill(QColor(0, 0, 0))
    small = trimesh.creation.icosphere(subdivisions=3, radius=0.03)
    worst = 0.0
    for centre in centres:
        view.show_mesh(np.asarray(small.vertices) + centre, np.asarray(small.faces, np.int32), None)
        view.show_camera(camera, picture)
        view.look("camera")
        settle()
        view._draw(fine=True)
        rows = view.host._rows[::-1, :, 3].astype(float)
        scale = rows.shape[1] / 600
        ys, xs = np.mgrid[: rows.shape[0], : rows.shape[1]]
        seen = np.array([(rows * xs).sum(), (rows * ys).sum()]) / rows.sum()
        seen = (seen + 0.5) / scale
        # The centre of a ball's outline is not the projection of its centre: compare with its vertices' hull.
        outline = camera.project(np.asarray(small.vertices) + centre) + 0.5
        from scipy.spatial import ConvexHull

        ring = outline[ConvexHull(outline).vertices]
        following = np.roll(ring, -1, axis=0)
        cross = ring[:, 0] * following[:, 1] - following[:, 0] * ring[:, 1]
        expected = ((ring + following) * cross[:, None]).sum(0) / (3 * cross.sum())
        worst = max(worst, float(np.hypot(*(seen - expected))))
    assert worst < 0.05, worst


def test_closing_twice_and_drawing_after_the_end_do_no_harm(
    qapp: QApplication, ball: tuple[np.ndarray, np.ndarray]
) -> None:
    """Finishing is idempotent; a finished view ignores what comes late."""
    view = Viewport("raster")
    view.resize(300, 200)
    view.show()
    view.show_mesh(*ball, None)
    settle()
    view.finish()
    view.finish()
    view.host.draw(view.lens(), fine=False)
    view.close()
    view.deleteLater()


def test_many_views_one_after_the_other(qapp: QApplication, ball: tuple[np.ndarray, np.ndarray]) -> None:
    """Ten views opened and closed: all work, none stays."""
    for _ in range(10):
        view = Viewport("raster")
        view.resize(200, 150)
        view.show()
        view.show_mesh(*ball, None)
        view.fit()
        settle(5)
        assert view.grab().toImage().pixelColor(100, 75).lightness() > 60
        view.close()
        view.deleteLater()


def test_layers_over_the_film_are_chosen_apart_from_those_in_space(view: Viewport) -> None:
    """Switched off in space the shadow is gone there; over the film the picture itself can be hidden."""
    base = Orbit((0, 0, 1), 6.0, 0.5, 0.25).camera((600, 450))
    film = QImage(600, 450, QImage.Format.Format_RGB32)
    film.fill(QColor(200, 40, 40))
    view.show_camera(base, film)
    shadow = view.scene._actors["shadow"]
    assert shadow.GetVisibility()
    view.show_layer("shadow", False)
    assert not shadow.GetVisibility()
    view.show_layer("shadow", True)
    view.look("camera")
    settle()
    assert not shadow.GetVisibility()
    assert view.grab().toImage().pixelColor(5, 225).red() > 150
    view.show_layer("film", False)
    settle()
    assert view.grab().toImage().pixelColor(5, 225).red() < 100
    view.show_layer("ground", True)
    view.look("orbit")
    assert shadow.GetVisibility()


def test_the_background_mesh_is_seen_and_never_cut_off(view: Viewport) -> None:
    """A far wall behind the ball is drawn in its own colour, and gone when its layer is off."""
    eye = view.lens().camera
    middle = np.array([0, 0, 1.0]) + 14 * eye.R[2]
    wall = middle + np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ np.array([30 * eye.R[0], 30 * eye.R[1]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    view.scene.set_background(wall, faces, np.tile(np.array([10, 200, 30], np.uint8), (4, 1)))
    view.show_layer("background", True)
    settle()
    seen = view.grab().toImage().pixelColor(40, 60)
    assert seen.green() > 150
    assert seen.red() < 60
    view.show_layer("background", False)
    settle()
    assert view.grab().toImage().pixelColor(40, 60).green() < 100


def test_a_mesh_painted_for_now_gets_its_own_colours_back(view: Viewport) -> None:
    """Red while it is painted, clay as before afterwards."""
    before = view.grab().toImage().pixelColor(300, 225)
    view.paint(np.tile(np.array([230, 20, 20], np.uint8), (len(view.vertices), 1)))
    settle()
    painted = view.grab().toImage().pixelColor(300, 225)
    assert painted.red() > 3 * painted.green()
    view.paint(None)
    settle(400)
    after = view.grab().toImage().pixelColor(300, 225)
    assert abs(after.green() - before.green()) < 12
