"""The space-time solve, its derivatives, the polish and the flags."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.cameras import CameraPath
from imitation.motion import lift_tracks, pixel_noise, polish
from imitation.motion.ambiguity import limb_parents, runs_of
from imitation.motion.kernels import energy, normal_equations
from imitation.motion.keys import fill_gaps
from imitation.motion.lifting import LiftSettings, prepare_lift
from imitation.motion.polishing import denoise_tracks
from imitation.motion.rays import depths_of, lift_points, pixel_size, project_points, rays_of

PAIRS = np.array([[0, 1], [1, 2], [2, 3], [0, 4], [1, 4], [2, 4]], np.int32)


def moving_cameras(count: int, seed: int = 0) -> CameraPath:
    """Cameras three units away that shake and drift, looking along +y."""
    random = np.random.default_rng(seed)
    R = np.tile(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), (count, 1, 1))
    centres = np.array([0, -3.0, 0]) + 0.002 * random.normal(size=(count, 3)) + np.linspace(0, 0.3, count)[:, None]
    K = np.tile(np.array([[900.0, 0, 480], [0, 900, 270], [0, 0, 1]]), (count, 1, 1))
    return CameraPath(K=K, R=R, T=-np.einsum("nij,nj->ni", R, centres))


def swinging_body(count: int) -> np.ndarray:
    """Five points of a nearly rigid body of size 1 that turns to and fro and walks."""
    rest = np.array([[-0.5, 0, 0], [0.0, 0, 0.1], [0.5, 0.05, 0], [0.5, 0, -0.4], [0.0, 0.3, -0.1]])
    time = np.arange(count) / 30
    angle = 0.6 * np.sin(2 * np.pi * time)
    turn = np.zeros((count, 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 0, 1], turn[:, 1, 0], turn[:, 2, 2] = -np.sin(angle), np.sin(angle), 1
    return np.einsum("nij,kj->nki", turn, rest) + np.stack([0.3 * time, 0.1 * time, 0 * time], axis=1)[:, None]


@pytest.fixture(scope="module")
def solved():
    """Truth, cameras and lift of the swinging body; point 3 is known in depth in some frames."""
    points, cameras = swinging_body(61), moving_cameras(61)
    pixels = project_points(cameras, points)
    anchors = np.full((61, 5), np.nan)
    anchors[[0, 1, 2, 30, 31, 59, 60], 3] = depths_of(cameras, points)[[0, 1, 2, 30, 31, 59, 60], 3]
    lift = lift_tracks(pixels, cameras, points[0], PAIRS, 1.0, anchors=anchors)
    return points, cameras, pixels, anchors, lift


def test_rigid_motion_is_lifted(solved) -> None:
    """Depths of a turning body come out within a percent of its size, exactly on the rays."""
    points, cameras, pixels, _, lift = solved
    assert np.linalg.norm(lift.points - points, axis=2).mean() < 0.01
    np.testing.assert_allclose(project_points(cameras, lift.points), pixels, atol=1e-6)
    np.testing.assert_allclose(depths_of(cameras, lift.points), lift.depths, atol=1e-9)


def test_anchors_and_frame_0_are_kept(solved) -> None:
    """Known depths are met to a thousandth of the size."""
    points, cameras, _, anchors, lift = solved
    known = np.isfinite(anchors)
    assert np.abs(lift.depths[known] - anchors[known]).max() < 1e-3
    np.testing.assert_allclose(lift.depths[0], depths_of(cameras, points)[0], atol=1e-3)


def test_doubtful_rays_do_not_take_their_neighbours_along(solved) -> None:
    """Rays 30 px off in some frames, known to be doubtful, move the others' depths far less than believed ones do."""
    points, cameras, pixels, anchors, lift = solved
    wrong, spread = pixels.copy(), np.zeros(pixels.shape[:2])
    wrong[20:26, 4] += (30.0, 0.0)
    spread[20:26, 4] = 30.0
    others = [0, 1, 2, 3]
    believed, doubted = (
        lift_tracks(wrong, cameras, points[0], PAIRS, 1.0, anchors=anchors, spread=given) for given in (None, spread)
    )
    moved = [np.abs(made.depths - lift.depths)[:, others].max() for made in (believed, doubted)]
    assert moved[1] < 0.02
    assert moved[1] < 0.5 * moved[0]


def test_tracks_without_doubt_are_lifted_as_exact_ones(solved) -> None:
    """A spread of nothing gives the same bits as none."""
    points, cameras, pixels, anchors, lift = solved
    same = lift_tracks(pixels, cameras, points[0], PAIRS, 1.0, anchors=anchors, spread=np.zeros(pixels.shape[:2]))
    np.testing.assert_array_equal(same.depths, lift.depths)


def test_lifting_scales_with_the_world(solved) -> None:
    """The unit of length does not matter: a world ten times as large has depths ten times as large."""
    points, cameras, pixels, anchors, lift = solved
    large = lift_tracks(
        pixels, cameras.transformed(10.0, np.eye(3), np.zeros(3)), 10 * points[0], PAIRS, 10.0, anchors=10 * anchors
    )
    np.testing.assert_allclose(large.depths / 10, lift.depths, rtol=1e-6)


def test_gradient_is_that_of_the_energy(solved) -> None:
    """Half the gradient of the kernel agrees with central differences of the energy."""
    points, cameras, pixels, anchors, lift = solved
    problem, depths, acceleration, stretch = prepare_lift(
        pixels, cameras, points[0], PAIRS, 1.0, anchors, lift.depths + 0.02, lift.depths, LiftSettings()
    )
    arguments = (
        problem.centres, problem.directions, problem.pairs, problem.lengths,
        1 / (stretch**2 + problem.doubt), 1 / acceleration**2, problem.target, problem.weight,
    )  # fmt: skip
    depths = depths + 0.01 * np.random.default_rng(1).normal(size=depths.shape)
    band, gradient = np.zeros((11, depths.size)), np.zeros(depths.size)
    normal_equations(depths, *arguments, band, gradient)
    for entry in (0, 7, 150, depths.size - 1):
        step = np.zeros(depths.size)
        step[entry] = 1e-6
        step = step.reshape(depths.shape)
        slope = (energy(depths + step, *arguments) - energy(depths - step, *arguments)) / 2e-6
        assert gradient[entry] == pytest.approx(slope / 2, rel=1e-4, abs=1e-3 * np.abs(gradient).max())
    assert (band[0] > 0).all()


def test_noise_is_estimated_and_taken_out(solved) -> None:
    """The jitter of each track is found within a quarter, and the polish takes most of it out."""
    points, cameras, pixels, _, _ = solved
    given = np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    noisy = pixels + given[:, None] * np.random.default_rng(5).normal(size=pixels.shape)
    lifted = lift_points(cameras, noisy, depths_of(cameras, points))
    noise = pixel_noise(lifted, cameras, np.ones(pixels.shape[:2], bool))
    np.testing.assert_allclose(noise, given, atol=0.25 * given.max() / 2 + 0.05)
    clean = polish(lifted, cameras, rays_of(cameras, noisy)[1], 1.0, noise=noise)
    before = np.linalg.norm(lifted - points, axis=2).mean(axis=0)[1:]
    after = np.linalg.norm(clean - points, axis=2).mean(axis=0)[1:]
    assert (after < 0.85 * before).all()


def test_polish_leaves_clean_tracks_and_stops_planted_feet(solved) -> None:
    """Without noise nothing moves by more than a thousandth; in a contact the point stands still."""
    points, cameras, pixels, _, _ = solved
    planted = np.zeros(pixels.shape[:2], bool)
    still = polish(points, cameras, rays_of(cameras, pixels)[1], 1.0, noise=np.zeros(5), planted=planted)
    assert np.linalg.norm(still - points, axis=2).max() < 2e-3
    planted[20:30, 3] = True
    jitter = points.copy()
    jitter[20:30, 3] = points[25, 3] + 0.002 * np.random.default_rng(2).normal(size=(10, 3))
    made = polish(jitter, cameras, rays_of(cameras, pixels)[1], 1.0, noise=np.full(5, 0.3), planted=planted)
    assert np.linalg.norm(np.diff(made[21:29, 3], axis=0), axis=1).max() < 2e-4


def test_denoised_tracks_are_nearer_to_the_truth(solved) -> None:
    """Taking the jitter out of 2D tracks at a constant depth needs no lifting."""
    points, cameras, pixels, _, _ = solved
    noisy = pixels + np.random.default_rng(6).normal(size=pixels.shape)
    seen = np.ones(pixels.shape[:2], bool)
    clean, noise = denoise_tracks(noisy, cameras, cameras[0].depth(points[0]), 1.0, seen)
    assert np.abs(noise - 1).max() < 0.4
    assert np.sqrt(((clean - pixels) ** 2).mean()) < 0.7 * np.sqrt(((noisy - pixels) ** 2).mean())


def test_gaps_are_filled_in_the_company_of_the_others() -> None:
    """A gap of a point that shares the others' motion is filled exactly, also at both ends."""
    count = 20
    sway = np.stack([np.sin(np.arange(count)), np.cos(np.arange(count))], axis=1) * 7
    pixels = sway[:, None] + np.array([[10.0, 20], [30, 40], [50, 60]])
    observed = np.ones((count, 3), bool)
    observed[[0, 7, 8, 9, 19], 1] = False
    gapped = np.where(observed[..., None], pixels, np.nan)
    np.testing.assert_allclose(fill_gaps(gapped, observed), pixels, atol=1e-9)


def test_batch_geometry_agrees_with_one_camera() -> None:
    """Rays, lifts, depths and projections of whole clips are those of the single cameras."""
    cameras = moving_cameras(7)
    points = np.random.default_rng(0).uniform(-1, 1, (7, 4, 3))
    pixels, depths = project_points(cameras, points), depths_of(cameras, points)
    np.testing.assert_allclose(lift_points(cameras, pixels, depths), points, atol=1e-12)
    np.testing.assert_allclose(rays_of(cameras, pixels)[1][3], cameras[3].rays(pixels[3]), atol=1e-12)
    np.testing.assert_allclose(pixel_size(cameras, points), depths / 900, atol=1e-12)


def test_limb_tree_and_runs() -> None:
    """The most central point is the root; runs of True are found at the ends as well."""
    rest = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [2, 1, 0]])
    parents = limb_parents(rest, np.array([[0, 1], [1, 2], [2, 3], [2, 4]], np.int32))
    assert parents.tolist() == [1, 2, -1, 2, 2]
    assert runs_of(np.array([True, True, False, True])) == [(0, 1), (3, 3)]
    assert runs_of(np.zeros(3, bool)) == []
