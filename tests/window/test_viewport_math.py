"""The 3D view's mathematics: lens, orbit, picking, dragging."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.window.canvas.view import View
from app.window.viewport.closed import is_closed
from app.window.viewport.drag import VertexChosen, VertexDrag, VertexMoved, VertexMoving, VertexReleased, place_under
from app.window.viewport.lens import Lens, clipped, framed
from app.window.viewport.orbit import Orbit, around, beside
from app.window.viewport.picking import pick_vertex
from imitation.geometry import Camera

angles = st.floats(-3.1, 3.1)
orbits = st.builds(
    Orbit,
    st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-2, 2)),
    st.floats(1, 20),
    angles,
    st.floats(-1.5, 1.5),
    st.floats(0.2, 1.5),
)


def camera_of(skew: float = 3.0) -> Camera:
    """A camera with everything odd: fx != fy, an off-centre principal point, skew, a turned pose."""
    K = [[900.0, skew, 410.0], [0, 870.0, 300.0], [0, 0, 1]]
    return Camera(K, Orbit((0.1, 0.2, 0.4), 5.0, 0.7, 0.3).camera((960, 540)).R, [0.3, -0.2, 4.0])


@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3), min_size=1, max_size=8))
def test_projection_matrix_agrees_with_the_camera(points: list[tuple[float, float, float]]) -> None:
    """Through OpenGL's matrices a point lands on the pixel that K, R, T say."""
    camera, size = camera_of(), (800, 600)
    lens = Lens(camera, size, 0.1, 100.0)
    world = np.array(points)
    local = world @ camera.R.T + camera.T
    eye = local * (1, -1, -1)
    clip = np.column_stack([eye, np.ones(len(eye))]) @ lens.projection().T
    normal = clip[:, :3] / clip[:, 3:]
    pixels = np.column_stack([(normal[:, 0] + 1) / 2 * size[0], (1 - normal[:, 1]) / 2 * size[1]])
    assert np.allclose(pixels, camera.project(world), atol=1e-8)
    assert (np.abs(normal[:, 2]) <= 1).all()


@given(st.floats(0.1, 5), st.floats(-300, 300), st.floats(-300, 300))
def test_framed_camera_follows_the_picture(scale: float, x: float, y: float) -> None:
    """A point seen at a pixel of the video lies on that pixel in the widget, at any zoom and pan."""
    camera, view = camera_of(), View(scale, x, y)
    point = np.array([0.2, -0.1, 0.3])
    assert np.allclose(framed(camera, view).project(point), view.to_widget(camera.project(point)), atol=1e-6)


@given(orbits)
def test_orbit_looks_at_its_target(orbit: Orbit) -> None:
    """The target is in the middle of the picture, at the orbit's distance, and up is up."""
    camera = orbit.camera((800, 600))
    target = np.array(orbit.target)
    assert np.allclose(camera.project(target), (400, 300), atol=1e-6)
    assert np.isclose(camera.depth(target), orbit.distance)
    assert np.allclose(camera.R @ camera.R.T, np.eye(3), atol=1e-12)
    assert np.isclose(np.linalg.det(camera.R), 1)
    assert camera.R[1, 2] <= 1e-9


@given(orbits, st.floats(-300, 300), st.floats(-300, 300))
def test_panning_an_orbit_follows_the_mouse(orbit: Orbit, dx: float, dy: float) -> None:
    """What was in the middle moves by exactly the mouse's pixels."""
    moved = orbit.shifted(dx, dy, 600).camera((800, 600))
    assert np.allclose(moved.project(np.array(orbit.target)), (400 + dx, 300 + dy), atol=1e-6)


@given(orbits, st.integers(0, 10))
def test_around_shows_every_point(orbit: Orbit, seed: int) -> None:
    """After fitting, all points are inside the picture."""
    points = np.random.default_rng(seed).normal(size=(30, 3)) * (1, 2, 3)
    places = around(points, orbit, aspect=4 / 3).camera((800, 600)).project(points)
    assert np.isfinite(places).all()
    assert (places >= 0).all()
    assert (places[:, 0] <= 800).all()
    assert (places[:, 1] <= 600).all()


def test_beside_looks_across_the_recovered_camera() -> None:
    """From the side, the camera's own direction lies across the picture."""
    camera = Orbit((0, 0, 0.5), 4.0, 0.4, 0.1).camera((960, 540))
    side = beside(camera, (0, 0, 0.5), Orbit()).camera((800, 600))
    assert abs(float(side.R[2] @ camera.R[2])) < 0.25


def test_clipped_encloses_the_scene() -> None:
    """Near is in front of the nearest point, far behind the farthest."""
    camera = Orbit((0, 0, 0), 5.0, 0.3, 0.2).camera((800, 600))
    points = np.random.default_rng(1).uniform(-1, 1, (50, 3))
    lens = clipped(camera, (800, 600), points)
    depths = camera.depth(points)
    assert 0 < lens.near < depths.min()
    assert lens.far > depths.max()


def brute_force(camera: Camera, vertices: np.ndarray, faces: np.ndarray, place: tuple[float, float]) -> int | None:
    """The nearest vertex within 10 pixels that a ray from the camera reaches first."""
    pixels, centre = camera.project(vertices), camera.centre
    away = np.hypot(*(pixels - place).T)
    for vertex in np.lexsort((camera.depth(vertices), away)):
        if not away[vertex] <= 10:
            return None
        ray = vertices[vertex] - centre
        hidden = False
        for a, b, c in faces:
            if vertex in (a, b, c):
                continue
            e1, e2 = vertices[b] - vertices[a], vertices[c] - vertices[a]
            p = np.cross(ray, e2)
            det = e1 @ p
            if abs(det) < 1e-14:
                continue
            s = centre - vertices[a]
            u, q = s @ p / det, np.cross(s, e1)
            v, t = ray @ q / det, e2 @ q / det
            hidden |= bool(u > 0 and v > 0 and u + v < 1 and 0 < t < 1 - 1e-3)
        if not hidden:
            return int(vertex)
    return None


@settings(max_examples=30)
@given(st.integers(0, 1000), st.floats(250, 550), st.floats(150, 450))
def test_picking_agrees_with_rays(seed: int, x: float, y: float) -> None:
    """The picked vertex is the one that rays find, hidden ones are passed over."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=2)
    vertices = np.asarray(ball.vertices) * np.random.default_rng(seed).uniform(0.8, 1.2, (len(ball.vertices), 1))
    faces = np.asarray(ball.faces, np.int32)
    camera = Orbit((0, 0, 0), 4.0, 0.1 * seed, 0.3).camera((800, 600))
    assert pick_vertex(camera, vertices, faces, (x, y)) == brute_force(camera, vertices, faces, (x, y))


def test_nothing_is_picked_beside_the_mesh() -> None:
    """A place without a vertex near gives nothing; one behind the camera too."""
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    camera = Orbit((0, 0, 0), 4.0).camera((800, 600))
    faces = np.array([[0, 1, 2]], np.int32)
    assert pick_vertex(camera, vertices, faces, (10, 10)) is None
    behind = Camera(camera.K, camera.R, -camera.R @ (2 * camera.centre * -1))
    assert pick_vertex(behind, vertices, faces, (400, 300)) in (None, 0)


@given(st.floats(-100, 100), st.floats(-100, 100))
def test_plane_drag_follows_the_mouse_and_keeps_the_depth(dx: float, dy: float) -> None:
    """The vertex moves by exactly the mouse's pixels, at its own depth."""
    camera, start = camera_of(0.0), np.array([0.2, 0.1, 0.3])
    moved = place_under(camera, start, (10, 10), (10 + dx, 10 + dy), "plane")
    assert np.isclose(camera.depth(moved), camera.depth(start))
    assert np.allclose(camera.project(moved) - camera.project(start), (dx, dy), atol=1e-6)


@given(st.floats(-200, 200))
def test_depth_drag_stays_on_the_ray(dy: float) -> None:
    """The pixel stays, the depth grows upwards."""
    camera, start = camera_of(0.0), np.array([0.2, 0.1, 0.3])
    moved = place_under(camera, start, (0, 0), (0, dy), "depth")
    assert np.allclose(camera.project(moved), camera.project(start), atol=1e-6)
    assert np.sign(camera.depth(moved) - camera.depth(start)) == -np.sign(dy) or abs(dy) < 1e-9


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_axis_drag_stays_on_the_axis_and_nearest_to_the_mouse(axis: str) -> None:
    """Two coordinates stay; no other place on the axis is nearer to the mouse's ray."""
    camera, start = camera_of(0.0), np.array([0.2, 0.1, 0.3])
    moved = place_under(camera, start, (0, 0), (40, -25), axis)  # type: ignore[arg-type]
    number = "xyz".index(axis)
    assert np.allclose(np.delete(moved, number), np.delete(start, number))
    ray = camera.rays(np.add(camera.project(start), (40, -25)))
    ray = ray / np.linalg.norm(ray)

    def gap(value: float) -> float:
        away = start + np.eye(3)[number] * value - camera.centre
        return float(np.linalg.norm(away - (away @ ray) * ray))

    best = moved[number] - start[number]
    assert gap(best) <= min(gap(best + 1e-3), gap(best - 1e-3))


def test_vertex_drag_states() -> None:
    """A click chooses, a drag moves, Escape gives up, an axis key changes the way."""
    camera, start = camera_of(0.0), np.array([0.2, 0.1, 0.3])
    drag = VertexDrag(camera, 7, start)
    drag.press((5, 5))
    assert drag.move((6, 5)) is None
    assert drag.release((6, 5)) == VertexChosen(7)
    drag.press((5, 5))
    assert isinstance(drag.move((30, 5)), VertexMoving)
    on_axis = drag.switch("z")
    assert on_axis is not None
    assert on_axis.place[:2] == pytest.approx((0.2, 0.1))
    assert isinstance(drag.release((30, 5)), VertexMoved)
    assert drag.cancel() == VertexReleased(7)


def test_closed_meshes_are_told_from_open_ones() -> None:
    """A ball is closed, also with a seam of doubled vertices; not with a hole, inside out or with a turned triangle."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=2)
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    assert is_closed(vertices, faces)
    assert is_closed(vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3))
    assert not is_closed(vertices, faces[1:])
    assert not is_closed(vertices, faces[:, ::-1])
    turned = faces.copy()
    turned[0] = turned[0, ::-1]
    assert not is_closed(vertices, turned)
    assert not is_closed(vertices, faces[:0])
