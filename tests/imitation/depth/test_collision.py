"""The measured background as a surface: what stands on it, what sinks into it, what is only behind it."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import InputError, NoSolution
from imitation.depth import BackgroundMesh, Collider, joined_mesh, penetration
from tests.imitation.depth.conftest import Solved
from tests.imitation.depth.scenes import ray_cast


def board(spacing: float = 0.05) -> BackgroundMesh:
    """A level board of 2 x 2 at height 0, seen from above."""
    ticks = np.arange(-1, 1 + spacing / 2, spacing)
    x, y = np.meshgrid(ticks, ticks)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    index = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (each.ravel() for each in (index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)]).astype(np.int32)
    return BackgroundMesh(vertices, faces, np.full((len(vertices), 3), 128, np.uint8))


def test_distances_behind_a_board_are_exact() -> None:
    """Below is positive, above negative; beyond the rim and the reach nothing is known."""
    collider = Collider(board(), 0.4)
    points = [(0.1, 0.2, -0.1), (0.1, 0.2, 0.1), (0, 0, -0.6), (1.4, 0, -0.05), (0.33, -0.71, 0)]
    behind = collider.behind(points)
    np.testing.assert_allclose(behind[[0, 1, 4]], [0.1, -0.1, 0.0], atol=1e-9)
    assert np.isnan(behind[[2, 3]]).all()
    assert collider.behind(np.zeros((0, 3))).shape == (0,)


def test_a_sinking_ball_sinks_as_deep_as_it_does() -> None:
    """A figure a frame: the deepest vertex, which it is, and how many are deeper than may be."""
    random = np.random.default_rng(0)
    ball = random.normal(size=(400, 3))
    ball *= 0.2 / np.linalg.norm(ball, axis=1, keepdims=True)
    heights = np.array([0.5, 0.2, 0.15, 0.1])
    seen: list[float] = []
    found = penetration(
        [ball + np.array([0, 0, high]) for high in heights],
        Collider(board(), 0.4),
        tolerance=0.02,
        progress=seen.append,
    )
    lowest = ball[:, 2].min()
    np.testing.assert_allclose(found.depth, np.maximum(-(heights + lowest), 0), atol=1e-9)
    assert list(found.vertex[2:]) == [int(ball[:, 2].argmin())] * 2
    assert found.share[0] == found.share[1] == 0
    assert found.share[3] > found.share[2] > 0
    assert seen[-1] == 1


def test_bad_colliders_are_refused() -> None:
    """No surface, no reach."""
    empty = BackgroundMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32), np.zeros((0, 3), np.uint8))
    with pytest.raises(InputError, match="no surface"):
        Collider(empty, 1.0)
    with pytest.raises(InputError, match="positive reach"):
        Collider(board(), 0.0)


def on_the_ground(solved: Solved, frame: int, count: int = 40) -> np.ndarray:
    """Pixels (k, 2) of a frame, not hidden, that show level surfaces with the same surface all round."""
    random = np.random.default_rng(1)
    world = solved.world
    depth, index = ray_cast(world.parts, world.cameras[frame], world.size)
    level = [
        i
        for i, part in enumerate(world.parts)
        if abs(np.cross(part.right, part.down)[2]) > 0.9 * np.linalg.norm(np.cross(part.right, part.down))
    ]
    rows, columns = np.nonzero(np.isin(index, level) & (depth < 7))
    kept = []
    for pick in random.permutation(len(rows)):
        y, x = rows[pick], columns[pick]
        around = index[max(0, y - 5) : y + 6, max(0, x - 5) : x + 6]
        if (around == index[y, x]).all() and around.size == 121 and not world.masks[frame][y, x]:
            kept.append((x + random.uniform(-0.5, 0.5), y + random.uniform(-0.5, 0.5)))
        if len(kept) == count:
            break
    return np.array(kept)


def true_place(solved: Solved, frame: int, pixel: np.ndarray) -> np.ndarray:
    """Where the ray of a pixel meets the room."""
    camera = solved.world.cameras[frame]
    ray = camera.rays(pixel[None])[0]
    depths = []
    for part in solved.world.parts:
        normal = np.cross(part.right, part.down)
        z = ((part.corner - camera.centre) @ normal) / (ray @ normal)
        local = camera.centre + z * ray - part.corner
        a, b = local @ part.right / (part.right @ part.right), local @ part.down / (part.down @ part.down)
        if z > 0 and 0 <= a <= 1 and 0 <= b <= 1:
            depths.append(z)
    return np.asarray(camera.centre + min(depths) * ray)


def test_places_on_the_background_are_sub_pixel(solved: Solved) -> None:
    """Floor and treads: places at fractions of a pixel, better than the depth of the nearest pixel, with a residual."""
    own, nearest, told = [], [], []
    for frame in (6, 7):
        surface = solved.background.everywhere(frame)
        for pixel in on_the_ground(solved, frame):
            truth = true_place(solved, frame, pixel)
            camera = solved.world.cameras[frame]
            place, residual = solved.background.place(frame, pixel)
            np.testing.assert_allclose(camera.project(place), pixel, atol=1e-6)
            away = float(camera.depth(truth))
            own.append(np.linalg.norm(place - truth) / away)
            x, y = np.rint(pixel).astype(int)
            nearest.append(np.linalg.norm(camera.lift(pixel, float(surface.depth[y, x])) - truth) / away)
            told.append(residual / away)
    assert np.median(own) < 0.01
    assert np.median(own) < np.median(nearest)
    assert 0 < np.median(told) < 0.02


def test_the_ground_that_a_subject_hides_is_found_in_other_frames(solved: Solved) -> None:
    """Behind the mask a place comes from the key frames that show it; outside the picture there is none."""
    frame = 6
    mask = solved.world.masks[frame]
    rows, columns = np.nonzero(mask)
    off = []
    for pick in np.linspace(0, len(rows) - 1, 25).astype(int):
        pixel = np.array([columns[pick], rows[pick]], float)
        try:
            place, _ = solved.background.place(frame, pixel)
        except NoSolution:
            continue
        truth = true_place(solved, frame, pixel)
        off.append(np.linalg.norm(place - truth) / float(solved.world.cameras[frame].depth(truth)))
    assert len(off) > 12
    assert np.median(off) < 0.02
    with pytest.raises(NoSolution, match="No background depth"):
        solved.background.place(frame, (-40.0, 20.0))


def test_the_measured_stairs_hold_what_stands_on_them(solved: Solved) -> None:
    """Points above level surfaces are before the mesh, points below behind it, by as much as they are."""
    collider = Collider(joined_mesh(solved.maps, step=2), 0.5)
    frame = 6
    places = np.array([true_place(solved, frame, pixel) for pixel in on_the_ground(solved, frame)])
    for shift in (0.15, -0.15):
        behind = collider.behind(places + np.array([0, 0, shift]))
        known = behind[np.isfinite(behind)]
        assert len(known) > 0.7 * len(places)
        assert np.median(known) == pytest.approx(-shift, abs=0.04)
