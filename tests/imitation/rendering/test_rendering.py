"""Pictures of meshes: exactly where the camera says, the same bits, lit and shadowed plausibly."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from imitation.errors import Cancelled, InputError
from imitation.geometry.projection import Camera
from imitation.rendering import (
    Footing,
    Layer,
    Plane,
    Renderer,
    composite,
    footing_at,
    ground_shadow,
    render_mesh,
    render_sequence,
    side_by_side,
    side_cameras,
    side_view,
)
from imitation.rendering.raster import rasterise
from tests.imitation.rendering.worlds import SIZE, VtkRenderer, ball, bumpy, off_centre_camera


def centroid(alpha: np.ndarray) -> np.ndarray:
    """The centre (x, y) of what is covered."""
    rows, columns = np.mgrid[: alpha.shape[0], : alpha.shape[1]]
    return np.array([(columns * alpha).sum(), (rows * alpha).sum()]) / alpha.sum()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("size", [(320, 240), (241, 317)])
def test_balls_are_drawn_where_the_camera_projects_them(seed: int, size: tuple[int, int]) -> None:
    """The centroid of a small ball lies within 0.05 px of K [R | T] X, at any window shape and principal point."""
    camera = off_centre_camera(seed, size)
    centre = np.random.default_rng(seed).uniform(-0.6, 0.6, 3)
    vertices, faces = ball(centre, 0.08)
    alpha = render_mesh(vertices, faces, camera, size, samples=4).rgba[..., 3] / 255.0
    assert np.linalg.norm(centroid(alpha) - camera.project(centre)) < 0.05


@settings(deadline=None, max_examples=60)
@example(seed=112944)  # a surface 0.05 in front of the camera
@given(seed=st.integers(0, 10**6))
def test_depth_and_weights_are_those_of_the_ray(seed: int) -> None:
    """Each sample's weights and depth are those of its ray, though corners lie behind the camera."""
    rng = np.random.default_rng(seed)
    camera = off_centre_camera(seed % 7, (40, 30))
    camera = Camera(camera.K * np.array([[0.125], [0.125], [1]]), camera.R, camera.T)
    vertices = rng.normal(0, 4, (6, 3))
    faces = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    seen = rasterise(vertices, faces, camera, (40, 30))
    rays = camera.rays(np.stack(np.meshgrid(np.arange(40), np.arange(30)), axis=-1))
    nearest = 1.001e-3 * np.abs(camera.depth(vertices)).max()  # what is closer is not drawn
    expected = np.full((30, 40), np.inf)
    for corners in vertices[faces]:
        # camera.centre + z ray = corner0 + s edge1 + t edge2
        system = np.stack([rays, *np.broadcast_to((corners[0] - corners[1:])[:, None, None], (2, 30, 40, 3))], axis=-1)
        z, s, t = np.moveaxis(np.linalg.solve(system, (corners[0] - camera.centre)[None, None, :, None])[..., 0], -1, 0)
        inside = (s > 1e-6) & (t > 1e-6) & (s + t < 1 - 1e-6) & (z > nearest)
        expected = np.where(inside, np.minimum(expected, z), expected)
    found = np.isfinite(expected)
    np.testing.assert_allclose(seen.depth[found], expected[found], rtol=1e-4)
    where = seen.face >= 0
    corners = vertices[faces[seen.face[where]]]
    a, b = seen.weights[where].T.astype(float)
    points = a[:, None] * corners[:, 0] + b[:, None] * corners[:, 1] + (1 - a - b)[:, None] * corners[:, 2]
    np.testing.assert_allclose(camera.depth(points), seen.depth[where], rtol=1e-3, atol=1e-3)


def test_no_gaps_between_neighbouring_triangles() -> None:
    """A flat sheet of many triangles covers every sample inside its outline."""
    x, y = np.meshgrid(np.linspace(-1, 1, 23), np.linspace(-1, 1, 17))
    vertices = np.stack([x, y, 0.1 * x], axis=-1).reshape(-1, 3)
    index = np.arange(23 * 17).reshape(17, 23)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    camera = off_centre_camera(1)
    seen = rasterise(vertices, faces.astype(np.int32), camera, SIZE).face >= 0
    for row in seen:
        covered = np.flatnonzero(row)
        assert not len(covered) or row[covered[0] : covered[-1] + 1].all()


@pytest.fixture
def vtk() -> Iterator[VtkRenderer]:
    """VTK's renderer of the bumpy ball."""
    vertices, faces = bumpy()
    renderer = VtkRenderer(vertices, faces, SIZE, samples=4)
    yield renderer
    renderer.close()


def test_vtk_draws_the_same_outline(vtk: VtkRenderer) -> None:
    """VTK with an explicit projection matrix covers the same parts of pixels."""
    vertices, faces = bumpy()
    for seed in range(4):
        camera = off_centre_camera(seed)
        theirs = vtk.draw(vertices, camera)[..., 3] / 255
        ours = render_mesh(vertices, faces, camera, SIZE, samples=4).rgba[..., 3] / 255
        assert ours.mean() > 0.05
        assert np.abs(theirs - ours).max() < 0.13  # two of sixteen samples
        assert np.abs(theirs - ours).mean() < 1e-4
        assert np.linalg.norm(centroid(theirs) - centroid(ours)) < 0.005


def test_same_input_same_bits_from_any_thread() -> None:
    """Four threads with a renderer each, and bands of a few rows, draw the same bytes."""
    vertices, faces = bumpy()
    camera = off_centre_camera(2)
    reference = render_mesh(vertices, faces, camera, SIZE)
    results = []
    threads = [
        threading.Thread(target=lambda: results.append(render_mesh(vertices, faces, camera, SIZE))) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result.rgba, reference.rgba) for result in results)


def test_bands_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    """Drawing in bands of a few rows, which bounds memory, changes nothing."""
    vertices, faces = bumpy()
    camera = off_centre_camera(2)
    whole = render_mesh(vertices, faces, camera, SIZE)
    monkeypatch.setattr("imitation.rendering.mesh._BAND", 20_000)
    banded = render_mesh(vertices, faces, camera, SIZE)
    assert np.abs(banded.rgba.astype(int) - whole.rgba).max() <= 1
    np.testing.assert_allclose(banded.depth, whole.depth, rtol=1e-6)


def test_light_from_above_left_shades_the_other_side() -> None:
    """The side of a ball towards the key light is brighter than the other, and colours tint it."""
    vertices, faces = ball(np.zeros(3), 0.8, 24)
    camera = off_centre_camera(0)
    grey = np.full((len(vertices), 3), 180, np.uint8)
    rendering = render_mesh(vertices, faces, camera, SIZE, colors=grey)
    inside = rendering.rgba[..., 3] == 255
    brightness = rendering.rgba[..., :3].mean(axis=2)
    x, y = camera.project(np.zeros(3))
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]]
    upper_left = inside & (rows < y - 15) & (columns < x - 10)
    lower_right = inside & (rows > y + 15) & (columns > x + 10)
    assert brightness[upper_left].mean() > brightness[lower_right].mean() + 60
    red = render_mesh(vertices, faces, camera, SIZE, colors=grey * np.array([1, 0, 0], np.uint8))
    assert red.rgba[inside][:, 0].mean() > red.rgba[inside][:, 1].mean() + 60


def test_shadow_touches_the_feet_and_softens_away() -> None:
    """The ground is darkest under a ball that touches it, untouched far away, and a raised ball casts less."""
    camera = off_centre_camera(0)
    dark = {}
    for height in (0.3, 1.2):
        vertices, faces = ball(np.array([0, 0, height]), 0.3)
        with Renderer(faces, SIZE) as renderer:
            lights = renderer.lights(vertices, camera)
            shade = ground_shadow(vertices, lights, camera, SIZE, Plane([0, 0, 0]), renderer.look, renderer.up)
        x, y = np.rint(camera.project(np.zeros(3))).astype(int)
        dark[height] = float(shade[y, x])
        far = np.rint(camera.project(np.array([0.0, -1.5, 0.0]))).astype(int)
        assert shade[np.clip(far[1], 0, SIZE[1] - 1), np.clip(far[0], 0, SIZE[0] - 1)] < 0.02
        assert shade.min() >= 0
        assert shade.max() <= 1
    assert dark[0.3] > 0.5
    assert dark[1.2] < 0.5 * dark[0.3]


def test_shadow_on_a_depth_map_equals_shadow_on_its_plane() -> None:
    """Ground given as depth a pixel receives the same shadow as the plane it samples."""
    camera = off_centre_camera(0)
    vertices, faces = ball(np.array([0, 0, 0.3]), 0.3)
    rays = camera.rays(np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), axis=-1))
    depth = np.where(rays[..., 2] < 0, -camera.centre[2] / rays[..., 2], np.nan)
    with Renderer(faces, SIZE) as renderer:
        lights = renderer.lights(vertices, camera)
        on_plane = ground_shadow(vertices, lights, camera, SIZE, Plane([0, 0, 0]), renderer.look, renderer.up)
        on_depth = ground_shadow(vertices, lights, camera, SIZE, depth, renderer.look, renderer.up)
    assert on_plane.max() > 0.4
    assert np.abs(on_plane - on_depth).max() < 0.15
    assert np.abs(on_plane - on_depth).mean() < 0.01


def test_each_foot_shades_its_own_step() -> None:
    """Ground known near two feet of different height darkens under each, as its own plane would, and not far away."""
    camera = off_centre_camera(0)
    feet = np.array([[0.4, 0.0, 0.0], [-0.4, 0.0, 0.5]])
    parts = [ball(foot + np.array([0, 0, 0.2]), 0.2) for foot in feet]
    vertices = np.concatenate([part[0] for part in parts])
    faces = np.concatenate([parts[0][1], parts[1][1] + len(parts[0][0])])
    with Renderer(faces, SIZE) as renderer:
        lights = renderer.lights(vertices, camera)
        more = (camera, SIZE, Footing(feet), renderer.look, renderer.up)
        shade = ground_shadow(vertices, lights, *more)
    for foot in feet:
        x, y = np.rint(camera.project(foot)).astype(int)
        assert shade[y, x] > 0.4
    x, y = np.rint(camera.project(np.array([0.0, -1.2, 0.0]))).astype(int)
    assert shade[y, x] < 0.02
    with pytest.raises(InputError, match="near the feet"):
        Footing([[0, np.nan, 0]])


def test_the_ground_near_the_feet_follows_the_contacts() -> None:
    """A standing foot's ground is its contact; between two contacts the level changes evenly; none without contacts."""
    contacts = {"left": [(10, 20, (1.0, 0, 0.2)), (0, 5, (0.0, 0, 0))], "right": [(0, 30, (0, 1.0, 0))], "tail": []}
    for frame, place in [(0, (0, 0, 0)), (5, (0, 0, 0)), (7.5, (0.5, 0, 0.1)), (15, (1, 0, 0.2)), (40, (1, 0, 0.2))]:
        footing = footing_at(contacts, frame)
        assert footing is not None
        np.testing.assert_allclose(footing.points, [place, (0, 1, 0)], atol=1e-9)
    assert footing_at({"tail": []}, 3) is None


def test_the_background_hides_what_is_behind_it() -> None:
    """A wall before half the picture hides the character there and nowhere else."""
    vertices, faces = ball(np.zeros(3), 0.8)
    camera = off_centre_camera(0)
    rendering = render_mesh(vertices, faces, camera, SIZE)
    frame = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8)
    middle = round(camera.project(np.zeros(3))[0])
    wall = np.full((SIZE[1], SIZE[0]), np.nan)
    wall[:, :middle] = 1.0
    out = composite(frame, [Layer(rendering)], background=wall)
    plain = composite(frame, [Layer(rendering)])
    assert (out[:, :middle] == 90).all()
    np.testing.assert_array_equal(out[:, middle:], plain[:, middle:])
    assert (plain[:, :middle] != 90).any()


def test_the_nearer_character_covers_the_farther() -> None:
    """Two layers give the same picture in either order, and the nearer is in front."""
    camera = off_centre_camera(0)
    away = camera.R[2]
    pair = []
    for shift, color in ((-1.0, (255, 0, 0)), (1.0, (0, 255, 0))):
        vertices, faces = ball(shift * away, 0.5)
        colors = np.tile(np.array(color, np.uint8), (len(vertices), 1))
        pair.append(Layer(render_mesh(vertices, faces, camera, SIZE, colors=colors)))
    frame = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8)
    out = composite(frame, pair)
    np.testing.assert_array_equal(out, composite(frame, pair[::-1]))
    x, y = np.rint(camera.project(np.zeros(3))).astype(int)
    assert out[y, x, 0] > out[y, x, 1] + 50


def test_empty_layers_leave_the_frame_alone() -> None:
    """No layer, or a character out of sight, changes no pixel."""
    frame = np.random.default_rng(0).integers(0, 255, (SIZE[1], SIZE[0], 3), np.uint8)
    vertices, faces = ball(np.array([0, 0, 900.0]), 0.5)
    rendering = render_mesh(vertices, faces, off_centre_camera(0), SIZE)
    np.testing.assert_array_equal(composite(frame, []), frame)
    np.testing.assert_array_equal(composite(frame, [Layer(rendering)]), frame)


def _walk(frames: int = 6) -> tuple[np.ndarray, np.ndarray, list[Camera]]:
    vertices, faces = bumpy()
    steps = np.arange(frames)[:, None, None] * np.array([0.1, 0.0, 0.0])
    return 0.4 * vertices + [0, 0, 0.5] + steps, faces, [off_centre_camera(0)] * frames


def test_a_sequence_streams_frames_with_progress_and_cancel() -> None:
    """Frames come one by one; progress reaches 1; raising in it stops the drawing."""
    vertices, faces, cameras = _walk()
    film = np.full((6, SIZE[1], SIZE[0], 3), 100, np.uint8)
    seen: list[float] = []
    tracks = {"nose": np.array([[20.0, 30.0]] * 5 + [[np.nan, np.nan]])}
    pictures = list(
        render_sequence(
            vertices, faces, cameras, list(film), ground=Plane([0, 0, 0]), tracks=tracks, dim=0.5, progress=seen.append
        )
    )
    assert len(pictures) == 6
    assert seen[0] == 0
    assert seen[-1] == 1
    assert np.all(np.diff(seen) > 0)
    assert (pictures[0][30, 20] != pictures[5][30, 20]).any()
    assert (pictures[5][0, 0] == 98).all()

    def stop(fraction: float) -> None:
        if fraction > 0.3:
            raise Cancelled

    with pytest.raises(Cancelled):
        list(render_sequence(vertices, faces, cameras, film[0], progress=stop))


def test_the_side_view_is_turned_by_a_right_angle_and_follows() -> None:
    """Side cameras look level across the film's direction, upright, with the subject inside the picture."""
    vertices, faces, cameras = _walk(30)
    views = side_cameras(vertices, cameras, SIZE, tilt=0.0)
    ahead = cameras[0].R[2] * [1, 1, 0]
    for pose, view in zip(vertices, views, strict=True):
        assert abs(view.R[2] @ ahead) < 1e-9
        assert view.R[1] @ [0, 0, -1.0] == pytest.approx(1.0)
        np.testing.assert_allclose(view.R @ view.R.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(view.R) == pytest.approx(1.0)
        pixels = view.project(pose)
        assert ((pixels > 0) & (pixels < SIZE)).all()
    pictures = list(side_view(vertices[:3], faces, cameras[:3], SIZE, points=np.zeros((4, 3)), samples=1))
    assert [picture.shape for picture in pictures] == [(240, 320, 3)] * 3


def test_pictures_stand_side_by_side_with_labels() -> None:
    """Pictures of other heights are scaled to the first, labels are written, the gap is dark."""
    a, b = np.full((100, 150, 3), 200, np.uint8), np.full((50, 50, 3), 100, np.uint8)
    out = side_by_side([a, b], ["film", "side"], gap=6)
    assert out.shape == (100, 150 + 6 + 100, 3)
    assert (out[:, 150:156] < 40).all()
    assert (out[80:, :150] == 200).all()
    assert out[:20, :60].max() > 205
    assert side_by_side([a, a, a], columns=2).shape == (206, 306, 3)
    with pytest.raises(InputError, match="2 labels"):
        side_by_side([a], ["film", "side"])


def test_bad_input_to_rendering() -> None:
    """NaN vertices, no faces, wrong sizes and counts: one sentence each."""
    vertices, faces = ball(np.zeros(3))
    camera = off_centre_camera(0)
    broken = vertices.copy()
    broken[3] = np.nan
    for call, words in [
        (lambda: render_mesh(broken, faces, camera, SIZE), "finite vertices"),
        (lambda: render_mesh(vertices, faces[:0], camera, SIZE), "needs faces"),
        (lambda: render_mesh(vertices[:10], faces, camera, SIZE), "finite vertices"),
        (lambda: render_mesh(vertices, faces, camera, (0, 10)), "cannot be drawn"),
        (lambda: render_mesh(vertices, faces, camera, SIZE, colors=np.zeros((3, 3), np.uint8)), "colours for 3"),
        (lambda: list(render_sequence([vertices], faces, [], SIZE)), "1 poses, but 0 cameras"),
        (lambda: list(side_view([vertices], faces, [], SIZE)), "1 poses and 0 cameras"),
        (lambda: Plane([0, 0]), "three finite numbers"),
        (
            lambda: composite(np.zeros((9, 9, 3), np.uint8), [Layer(render_mesh(vertices, faces, camera, SIZE))]),
            "but the frame is",
        ),
    ]:
        with pytest.raises(InputError, match=words):
            call()
