"""A mesh that is another one in every frame: colours, pictures worn, see-through ghosts; nothing is left over."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication

from app.actions.performing_playback import ShownFrame, ready
from app.formats import write_image
from app.formats.tvm import FrameMesh, Texture
from app.window.viewport import Viewport
from app.window.viewport.orbit import Orbit
from tests.window.conftest import settle

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]
CORNERS = {
    "left top": (200, 30, 30),
    "right top": (30, 200, 30),
    "left bottom": (30, 30, 200),
    "right bottom": (0, 0, 0),
}


@pytest.fixture
def view(qapp: QApplication) -> Iterator[Viewport]:
    """A view that looks along +y at a wall in the plane of x and z."""
    made = Viewport("raster")
    made.resize(300, 300)
    made.orbit = Orbit((0.0, 0.0, 0.0), 4.0, -np.pi / 2, 0.0)
    made.show()
    yield made
    made.finish()
    made.close()
    made.deleteLater()


def wall(texture: Texture | None = None, colours: np.ndarray | None = None, depth: float = 0.0) -> ShownFrame:
    """Two triangles that face -y, 1 wide and high."""
    vertices = np.array([[-0.5, depth, -0.5], [0.5, depth, -0.5], [0.5, depth, 0.5], [-0.5, depth, 0.5]])
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return ready(FrameMesh(vertices, faces, colours, texture), 0, 0)


def seen(view: Viewport, x: float, z: float) -> QColor:
    """The colour at a place of the wall."""
    view.redraw()
    settle(40)
    px, py = view.lens().to_widget(np.array([x, 0.0, z]))
    return view.grab().toImage().pixelColor(round(float(px)), round(float(py)))


def strongest(colour: QColor) -> int:
    """Which of red, green and blue is largest."""
    return int(np.argmax([colour.red(), colour.green(), colour.blue()]))


def test_a_picture_lies_the_right_way_up(view: Viewport, tmp_path: Path) -> None:
    """Left and right, top and bottom are where the picture has them; another frame without one has its own colours."""
    from app.window.viewport.streamed import StreamedMesh

    picture = np.zeros((8, 8, 3), np.uint8)
    picture[:4, :4], picture[:4, 4:] = CORNERS["left top"], CORNERS["right top"]
    picture[4:, :4], picture[4:, 4:] = CORNERS["left bottom"], CORNERS["right bottom"]
    write_image(tmp_path / "wall.png", picture)
    coordinates = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    corners = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    worn = wall(Texture(coordinates, corners, (tmp_path / "wall.png",), np.zeros(2, np.int32)))
    assert worn.picture is not None
    assert worn.colours is None
    mesh = StreamedMesh(view.scene, "mesh")
    mesh.show(worn)
    assert strongest(seen(view, -0.3, 0.3)) == 0
    assert strongest(seen(view, 0.3, 0.3)) == 1
    assert strongest(seen(view, -0.3, -0.3)) == 2
    assert seen(view, 0.3, -0.3).lightness() < 60
    mesh.show(wall(colours=np.tile(np.array([[20, 180, 20]], np.uint8), (4, 1))))
    assert strongest(seen(view, -0.3, 0.3)) == 1
    assert strongest(seen(view, 0.3, -0.3)) == 1
    mesh.show(wall())
    plain = seen(view, 0.0, 0.1)
    assert plain.lightness() > 80
    assert abs(plain.red() - plain.blue()) < 60, "clay"
    mesh.hide()
    assert seen(view, 0.0, 0.1) != plain


def test_pictures_on_some_faces_become_colours(tmp_path: Path) -> None:
    """Several pictures, or faces without one, are sampled at the vertices, so that all of the mesh is coloured."""
    for number in range(2):
        write_image(tmp_path / f"{number}.png", np.full((4, 4, 3), 90 + 80 * number, np.uint8))
    coordinates = np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]])
    corners = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    images = (tmp_path / "0.png", tmp_path / "1.png")
    mixed = wall(Texture(coordinates, corners, images, np.array([0, 1], np.int32)))
    assert mixed.picture is None
    assert mixed.colours is not None
    assert set(mixed.colours[:, 0].tolist()) <= {90, 170}


def test_seams_double_vertices_and_large_pictures_are_made_smaller(tmp_path: Path) -> None:
    """One vertex with two places in the picture is two vertices; a picture is as large as a view can show."""
    write_image(tmp_path / "large.png", np.zeros((64, 2048, 3), np.uint8))
    coordinates = np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.5, 0.5], [1.0, 1.0], [0.0, 1.0]])
    corners = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    worn = wall(Texture(coordinates, corners, (tmp_path / "large.png",), np.zeros(2, np.int32)))
    assert len(worn.vertices) == len(worn.normals) == len(worn.coordinates) == 6
    assert worn.picture.shape == (32, 1024, 3)
    assert worn.faces.max() == 5


def test_ghosts_are_seen_through(view: Viewport) -> None:
    """What is behind a ghost shows through it."""
    from app.window.viewport.streamed import StreamedMesh

    empty = seen(view, 0.2, 0.2)
    ghost = StreamedMesh(view.scene, "ghost", opacity=0.3)
    ghost.show(wall(depth=-0.2))
    faint = seen(view, 0.2, 0.2)
    assert faint != empty
    solid = StreamedMesh(view.scene, "mesh")
    solid.show(wall(colours=np.tile(np.array([[200, 20, 20]], np.uint8), (4, 1))))
    both = seen(view, 0.2, 0.2)
    assert strongest(both) == 0
    ghost.hide()
    assert seen(view, 0.2, 0.2) != both


def test_a_quick_picture_is_the_same(view: Viewport) -> None:
    """What faces away is left out only where it is never seen; an open mesh is drawn whole."""
    import trimesh

    from app.window.viewport.streamed import StreamedMesh

    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    faces = np.asarray(ball.faces, np.int32)
    mesh = StreamedMesh(view.scene, "performer")

    def pictures(kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        frame = ready(FrameMesh(np.asarray(ball.vertices), kept), 0, 0)
        assert frame.closed == (len(kept) == len(faces))
        taken = []
        for quick in (False, True):
            mesh.show(frame, quick=quick)
            view.redraw()
            settle(40)
            taken.append(view.host._rows.copy())
        return taken[0], taken[1]

    whole, quick = pictures(faces)
    differ = (whole != quick).any(axis=2).sum()
    assert differ <= 0.002 * (whole[..., 3] > 0).sum(), f"{differ} pixels, of the outline alone"
    towards = np.asarray(ball.triangles_center)[:, 1] < -0.2
    whole, quick = pictures(faces[~towards])
    np.testing.assert_array_equal(whole, quick)
    assert (whole[whole.shape[0] // 2, whole.shape[1] // 2, 3]) == 255, "the inside is seen through the hole"


def test_only_see_through_meshes_are_blended_in_any_order(view: Viewport) -> None:
    """The lines of the ground look the same when they are blended as they are drawn, which is far cheaper."""
    from app.window.viewport.streamed import StreamedMesh

    renderer = view.scene.renderer
    view.scene.set_ground((0.0, 0.0), 3.0, -0.6)

    def picture() -> np.ndarray:
        view.redraw()
        settle(40)
        image = view.grab().toImage()
        return np.array([
            [image.pixelColor(x, y).getRgb()[:3] for x in range(0, image.width(), 3)]
            for y in range(image.height() // 2, image.height())
        ])  # fmt: skip

    assert not renderer.GetUseOIT()
    cheap = picture()
    assert np.ptp(cheap) > 30, "the ground is not seen"
    renderer.SetUseOIT(True)
    assert np.abs(picture() - cheap).max() <= 2
    ghost = StreamedMesh(view.scene, "ghost", opacity=0.4)
    renderer.SetUseOIT(False)
    ghost.show(wall())
    assert renderer.GetUseOIT()
    ghost.hide()
    assert not renderer.GetUseOIT()
