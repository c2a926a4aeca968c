"""Dense depth against the truth of a filmed room, and what may not change it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from imitation import CameraPath, Cancelled
from imitation.depth import DepthSolver, background_depth
from tests.imitation.depth.conftest import KEYS, Solved

QUICK = [3, 6, 9]


def errors(solved: Solved, depth: np.ndarray, frame: int) -> np.ndarray:
    """Relative errors of all pixels off the subject and its rim."""
    hidden = solved.background.pictures.hidden(frame) > 0
    truth = solved.world.depth(frame)
    return np.abs(depth - truth)[~hidden] / truth[~hidden]


def test_depth_is_exact_to_a_percent(solved: Solved) -> None:
    """Of every pixel off the subject: mean error, share within 1 and 5 %."""
    found = np.concatenate([errors(solved, each.depth, each.frame) for each in solved.maps])
    assert np.isfinite(found).all()
    assert found.mean() < 0.018
    assert (found < 0.01).mean() > 0.83
    assert (found < 0.05).mean() > 0.97


def test_the_second_pass_is_better_than_the_first(solved: Solved) -> None:
    """Like for like: the same views, with and without the prior."""
    world = solved.world
    solver = DepthSolver(world.frames, world.cameras, world.masks)
    first = {frame: solver.first(frame, KEYS) for frame in KEYS}
    second = solver.second(6, first)
    before, after = (errors(solved, 1 / each.inverse, 6) for each in (first[6], second))
    assert (after < 0.01).mean() > (before < 0.01).mean() + 0.005


def test_confirmed_depths_are_better(solved: Solved) -> None:
    """What three of five other key frames agree with is most of the picture and has fewer outliers."""
    each = solved.maps[2]
    hidden = solved.background.pictures.hidden(each.frame) > 0
    truth = solved.world.depth(each.frame)
    off = np.abs(each.depth - truth) / truth > 0.05
    assert each.sure(3)[~hidden].mean() > 0.85
    assert off[each.sure(3)].mean() < 0.75 * off[~hidden].mean()


def test_under_the_mask_there_is_nothing(solved: Solved) -> None:
    """NaN and no confidence where the subject is, a number everywhere else."""
    for each in solved.maps:
        mask = solved.world.masks[each.frame]
        assert np.isnan(each.depth[mask]).all()
        assert not each.confidence[mask].any()
        assert np.isfinite(each.depth[~mask]).all()
        assert each.depth.dtype == np.float32


def test_what_the_subject_looks_like_does_not_matter(solved: Solved) -> None:
    """Another picture under the mask: the same bits everywhere else."""
    world = solved.world
    other = world.frames.copy()
    other[world.masks] = np.random.default_rng(1).integers(0, 256, (int(world.masks.sum()), 3))
    keys = QUICK
    reach = DepthSolver(world.frames, world.cameras, world.masks).reach
    sketches = [DepthSolver(f, world.cameras, world.masks, reach=reach).first(6, keys) for f in (world.frames, other)]
    hidden = solved.background.pictures.hidden(6) > 0
    np.testing.assert_array_equal(sketches[0].inverse[~hidden], sketches[1].inverse[~hidden])


def test_scale_and_pose_of_the_world_do_not_matter(solved: Solved) -> None:
    """Ten times the size, turned and moved: ten times the depth."""
    world = solved.world
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    moved = world.cameras.transformed(10.0, turn, np.array([5.0, -3.0, 2.0]))
    one, ten = (
        background_depth(world.frames, cameras, masks=world.masks, frames_to_solve=QUICK)[1].depth
        for cameras in (world.cameras, moved)
    )
    seen = np.isfinite(one)
    assert (np.abs(ten[seen] / one[seen] / 10 - 1) < 1e-3).mean() > 0.99


def test_a_drifting_exposure_does_no_harm(solved: Solved) -> None:
    """Frames 8 % brighter or darker by turns: nearly the same depth."""
    world = solved.world
    gain = np.where(np.arange(len(world.frames)) % 2, 1.08, 0.92)
    lit = np.clip(np.rint(world.frames * gain[:, None, None, None]), 0, 255).astype(np.uint8)
    found = background_depth(lit, world.cameras, masks=world.masks, frames_to_solve=QUICK)[1]
    share = (errors(solved, found.depth, 6) < 0.02).mean()
    plain = background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=QUICK)[1]
    assert share > (errors(solved, plain.depth, 6) < 0.02).mean() - 0.03


def test_the_same_bits_with_any_number_of_threads(solved: Solved) -> None:
    """Two solves side by side give what one gives."""
    world = solved.world

    def solve(_: int) -> np.ndarray:
        return background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=QUICK)[1].depth

    alone = solve(0)
    with ThreadPoolExecutor(2) as pool:
        for depth in pool.map(solve, range(2)):
            np.testing.assert_array_equal(depth, alone)


def test_threads_share_a_solver(solved: Solved, monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames of one solver on four threads, while hardly any signal stays in memory: the bits of one thread."""
    world = solved.world
    monkeypatch.setattr("imitation.depth.pictures.KEPT", 2)
    solver = DepthSolver(world.frames, world.cameras, world.masks, longest=96)
    alone = {frame: solver.first(frame, KEYS).inverse for frame in KEYS}
    shared = DepthSolver(world.frames, world.cameras, world.masks, longest=96, reach=solver.reach)
    with ThreadPoolExecutor(4) as pool:
        for _ in range(3):
            for frame, sketch in zip(KEYS, pool.map(lambda t: shared.first(t, KEYS), KEYS), strict=True):
                np.testing.assert_array_equal(sketch.inverse, alone[frame])


def test_key_frames_are_sparse_and_cover_the_clip(solved: Solved) -> None:
    """First and last frame, not all; views are other frames, on both sides, at several baselines."""
    solver = DepthSolver(solved.world.frames, solved.world.cameras, solved.world.masks)
    keys = solver.key_frames()
    assert keys[0] == 0
    assert keys[-1] == 15
    assert 3 <= len(keys) <= 9
    views = solver.views(8, keys)
    assert 8 not in views
    assert 4 <= len(set(views)) == len(views) <= 8
    assert min(views) < 8 < max(views)


def test_larger_frames_are_solved_small_and_brought_back(solved: Solved) -> None:
    """At half size: the frames' size again, edges not blended, a few percent."""
    world = solved.world
    found = background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=QUICK, longest=128)[1]
    assert found.depth.shape == (144, 256)
    assert (errors(solved, found.depth, 6) < 0.03).mean() > 0.8


def test_progress_rises_to_one_and_can_cancel(solved: Solved) -> None:
    """Fractions in order; an exception from the callback leaves at once."""
    world, seen = solved.world, []
    background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=[3, 6], progress=seen.append)
    assert seen == sorted(seen)
    assert seen[0] == 0
    assert seen[-1] == 1

    def stop(fraction: float) -> None:
        if fraction > 0.2:
            raise Cancelled

    with pytest.raises(Cancelled):
        background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=[3, 6], progress=stop)


def test_points_of_the_cameras_give_the_range(solved: Solved) -> None:
    """Given background points, the range of depths is theirs, widened."""
    world = solved.world
    truth = world.depth(8)
    rows, columns = np.mgrid[4:140:6, 4:250:6]
    points = world.cameras[8].lift(np.stack([columns.ravel(), rows.ravel()], 1), truth[rows, columns].ravel())
    cameras = CameraPath(K=world.cameras.K, R=world.cameras.R, T=world.cameras.T, points=points)
    reach = DepthSolver(world.frames, cameras, world.masks).reach
    assert reach.near == pytest.approx(0.8 * np.percentile(truth, 1), rel=0.1)
    assert reach.far == pytest.approx(1.4 * np.percentile(truth, 99), rel=0.1)
