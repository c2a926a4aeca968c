"""Occlusion with soft edges, motion blur, light and grain taken from the clip."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import Camera, InputError
from imitation.geometry.rotations import rotation_of
from imitation.rendering import (
    Look,
    Renderer,
    add_grain,
    blurred,
    extended_depth,
    grain_of,
    match_look,
    pose_at,
    render_mesh,
    render_sequence,
    visibility,
)
from imitation.rendering.motion_blur import camera_at
from tests.imitation.rendering.worlds import SIZE, ball, off_centre_camera


def half_hidden() -> tuple[np.ndarray, np.ndarray]:
    """A disc of depth 5 and a wall of depth 4 over its left half, with stray wrong depths."""
    rows, columns = np.mgrid[:80, :80]
    depth = np.where((rows - 40) ** 2 + (columns - 40) ** 2 < 900, 5.0, np.inf)
    wall = np.where(columns < 40, 4.0, 9.0)
    wall[::9, ::11] = np.where(columns[::9, ::11] < 40, 9.0, 4.0)
    return depth, wall


def test_stray_depths_are_voted_down_and_the_edge_is_soft() -> None:
    """Away from the edge all or nothing; at the edge between; the hard test keeps the strays."""
    depth, wall = half_hidden()
    matte, hard = visibility(depth, wall), visibility(depth, wall, soft=False)
    assert matte[20:60, 15:36].max() == 0
    assert matte[20:60, 44:65].min() == 1
    edge = matte[30:50, 38:42]
    assert ((edge > 0.02) & (edge < 0.98)).any()
    assert np.abs(edge.mean(axis=0) + edge.mean(axis=0)[::-1] - 1).max() < 0.1
    assert hard[20:60, 15:36].max() == 1


def test_no_ghost_of_a_hidden_outline() -> None:
    """A character wholly behind a wall leaves nothing, at its outline too."""
    depth, _ = half_hidden()
    assert visibility(depth, np.full(depth.shape, 4.0)).max() == 0
    extended = extended_depth(depth)
    np.testing.assert_array_equal(extended, np.full(depth.shape, 5.0, np.float32))
    assert np.isinf(extended_depth(np.full((8, 8), np.inf))).all()


def test_unknown_background_hides_nothing_and_sizes_must_match() -> None:
    """NaN does not hide; another size is refused."""
    depth, _ = half_hidden()
    assert visibility(depth, np.full(depth.shape, np.nan)).min() == 1
    with pytest.raises(InputError, match="depth is"):
        visibility(depth, np.zeros((3, 3)))


def test_poses_between_frames() -> None:
    """Whole frames are themselves; a parabola is met between them; the ends hold."""
    time = np.arange(6.0)
    poses = np.stack([time, time**2, 0 * time], axis=1)[:, None]
    for frame in range(6):
        np.testing.assert_array_equal(pose_at(poses, frame), poses[frame])
    np.testing.assert_allclose(pose_at(poses, 2.4)[0], [2.4, 2.4**2, 0], atol=1e-12)
    np.testing.assert_array_equal(pose_at(poses, 9.0), poses[5])


def test_a_moving_ball_is_smeared_along_its_way_and_a_still_one_is_not() -> None:
    """Longer along the motion, as wide across, the same covered light; no motion, the same bits."""
    camera = off_centre_camera(0)
    vertices, faces = ball(np.zeros(3), 0.35)
    step = 0.5 * camera.R[0]
    moving = np.stack([vertices - step, vertices, vertices + step])
    with Renderer(faces, SIZE) as renderer:
        sharp = renderer.draw(vertices, camera)
        smeared = blurred(renderer, moving, 1, camera, shutter=1.0)
        still = blurred(renderer, np.stack([vertices] * 3), 1, camera, shutter=1.0)
        with pytest.raises(InputError, match="shutter"):
            blurred(renderer, moving, 1, camera, shutter=1.5)
    np.testing.assert_array_equal(still.rgba, sharp.rgba)
    one, many = sharp.rgba[..., 3] / 255.0, smeared.rgba[..., 3] / 255.0

    def spread(alpha: np.ndarray, axis: int) -> float:
        share = alpha.sum(axis=axis) / alpha.sum()
        place = np.arange(len(share))
        return float(np.sqrt((share * (place - (share * place).sum()) ** 2).sum()))

    assert spread(many, 0) > 1.15 * spread(one, 0)
    assert spread(many, 1) == pytest.approx(spread(one, 1), rel=0.05)
    assert many.sum() == pytest.approx(one.sum(), rel=0.03)


def test_what_the_camera_follows_stays_sharp_and_what_it_passes_is_smeared() -> None:
    """The shutter of a moving camera: its way counts as the character's does, and both may cancel."""
    camera = off_centre_camera(0)
    vertices, faces = ball(np.zeros(3), 0.35)
    step = 0.5 * camera.R[0]
    moving = np.stack([vertices + k * step for k in range(-2, 3)])
    still = np.stack([vertices] * 5)
    following = [Camera(camera.K, camera.R, camera.T - camera.R @ (k * step)) for k in range(-2, 3)]
    with Renderer(faces, SIZE) as renderer:
        sharp = renderer.draw(vertices, camera)
        followed = blurred(renderer, moving, 2, camera, shutter=1.0, cameras=following)
        passed = blurred(renderer, still, 2, camera, shutter=1.0, cameras=following)
        smeared = blurred(renderer, moving, 2, camera, shutter=1.0)
    np.testing.assert_array_equal(followed.rgba, sharp.rgba)
    assert (passed.rgba[..., 3] > 0).sum() > 1.1 * (sharp.rgba[..., 3] > 0).sum()
    assert np.abs(passed.rgba[..., 3].astype(float) - smeared.rgba[..., 3]).mean() < 1.5
    between = camera_at(following, 1.5)
    np.testing.assert_allclose(between.centre, camera.centre - 0.5 * step, atol=1e-9)
    np.testing.assert_array_equal(camera_at(following, 2).T, camera.T)
    turned = [camera, Camera(camera.K, rotation_of([0, 0.2, 0]) @ camera.R, camera.T)]
    half = camera_at(turned, 0.5)
    np.testing.assert_allclose(half.R, rotation_of([0, 0.1, 0]) @ camera.R, atol=1e-9)


def lit_corner(sun: np.ndarray, shade: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A picture and depth of a ground and two walls, lit by a sun, as ``off_centre_camera(0)`` sees them."""
    camera = off_centre_camera(0)
    columns, rows = np.meshgrid(np.arange(SIZE[0], dtype=float), np.arange(SIZE[1], dtype=float))
    rays = camera.rays(np.stack([columns, rows], -1))
    depth, light = np.full(rows.shape, np.inf), np.zeros(rows.shape)
    for normal, offset in ((np.array([0, 0, 1.0]), -1.2), (np.array([1.0, 0, 0]), -2.0), (np.array([0, 1.0, 0]), -2.0)):
        with np.errstate(divide="ignore", invalid="ignore"):
            z = (offset - camera.centre @ normal) / (rays @ normal)
        nearer = (z > 0) & (z < depth)
        depth[nearer], light[nearer] = z[nearer], 0.12 + 0.3 * max(0.0, float(normal @ sun))
    colour = light[..., None] * shade
    encoded = np.where(colour <= 0.0031308, 12.92 * colour, 1.055 * np.maximum(colour, 1e-9) ** (1 / 2.4) - 0.055)
    return np.clip(np.rint(255 * encoded), 0, 255).astype(np.uint8), depth


def test_the_light_of_a_plate() -> None:
    """The key comes from the side that is bright; a warm plate warms the lights, a dark one dims them."""
    camera, grey = off_centre_camera(0), np.ones(3)
    for sun in (np.array([0.7, 0.1, 0.7]), np.array([0.1, 0.7, 0.7])):
        picture, depth = lit_corner(sun, grey)
        look = match_look(picture, depth, camera)
        assert look.key is not None
        assert (look.key[0] > look.key[1]) == (sun[0] > sun[1])
        assert np.linalg.norm(look.key) == pytest.approx(1)
        assert look.key[2] > 0.4
    warm = match_look(*_with(lit_corner(sun, np.array([1.0, 0.7, 0.45]))), camera)
    assert warm.key_light[0] / warm.key_light[2] > look.key_light[0] / look.key_light[2]
    dark = match_look(*_with(lit_corner(sun, 0.3 * grey)), camera)
    assert dark.key_light[1] < look.key_light[1]
    nothing = match_look(picture, np.full(depth.shape, np.nan), camera)
    assert nothing == Look()


def _with(pair: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    return pair


def test_grain_is_measured_and_added_only_over_the_character() -> None:
    """Noise of three levels is found within a third; it is added where alpha is, by the seed."""
    random = np.random.default_rng(3)
    flat = np.full((120, 160, 3), 120.0) + np.linspace(0, 40, 160)[:, None]
    noisy = np.clip(np.rint(flat + 3 * random.normal(size=flat.shape)), 0, 255).astype(np.uint8)
    assert grain_of(noisy) == pytest.approx(3, rel=0.34)
    alpha = np.zeros((120, 160), np.float32)
    alpha[:60] = 1
    once, again, other = (add_grain(noisy, alpha, 3.0, seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(once, again)
    np.testing.assert_array_equal(once[60:], noisy[60:])
    assert (once[:60] != other[:60]).any()


def test_a_sequence_behind_a_wall_with_blur_and_grain() -> None:
    """All together: hidden where the wall is, the wall's pixels untouched there."""
    camera = off_centre_camera(0)
    vertices, faces = ball(np.zeros(3), 0.6)
    moving = np.stack([vertices + 0.1 * t * camera.R[0] for t in range(3)])
    frame = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8)
    middle = round(camera.project(np.zeros(3))[0])
    wall = np.full((SIZE[1], SIZE[0]), 50.0)
    wall[:, :middle] = 1.0
    shown = list(
        render_sequence(moving, faces, [camera] * 3, [frame] * 3, background=[wall] * 3, shutter=0.5, grain=2.0)
    )
    assert len(shown) == 3
    for picture in shown:
        assert (picture[:, : middle - 3] == 90).all()
        assert (picture[:, middle + 3 :] != 90).any()
    assert render_mesh(vertices, faces, camera, SIZE).rgba[:, : middle - 3, 3].any()
