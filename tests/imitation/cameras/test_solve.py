"""Solving cameras from pictures: verdicts, accuracy, determinism, and what is said about bad input."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from imitation.cameras import CameraPath, solve_cameras
from imitation.errors import Cancelled, InputError
from tests.imitation.cameras.compare import path_error, turn_error
from tests.imitation.cameras.scenes import Film, film, handheld, room, wall

SIZE = (384, 216)
FRAMES = 18


@pytest.fixture(scope="module")
def walked() -> Film:
    """A walk of 1.4 m past stairs and boxes, a moving blob masked."""
    return film(room(21), handheld(FRAMES, SIZE, seed=21), SIZE, blob=True, seed=21)


@pytest.fixture(scope="module")
def solved(walked: Film) -> CameraPath:
    """Its cameras, solved."""
    return solve_cameras(walked.frames, masks=walked.masks)


def test_parallax_gives_every_pose_and_the_focal_length(walked: Film, solved: CameraPath) -> None:
    """Verdict ok, every frame posed; focal 2 %, path 0.15 % of its length, turns 0.1 degrees, on a tiny picture."""
    truth = walked.cameras
    assert solved.verdict == "ok", solved.reason
    assert len(solved) == FRAMES
    assert np.isfinite(solved.residuals).all()
    assert solved.residuals.max() < 0.4
    assert solved.K[0, 0, 0] == pytest.approx(truth.K[0, 0, 0], rel=0.02)
    assert path_error(solved.centres, truth.centres) < 0.0015
    assert turn_error(solved.R, truth.R).max() < 0.1
    assert "scale is unknown" in solved.reason


def test_points_are_seen_where_the_observations_say(solved: CameraPath) -> None:
    """Projected points fall on their observations; their rms per frame is the residual."""
    frames = solved.observations[:, 0].astype(int)
    for t in (0, 7, FRAMES - 1):
        here = frames == t
        off = solved[t].project(solved.points[solved.observed[here]]) - solved.observations[here, 1:]
        assert np.sqrt((off**2).sum(1).mean()) == pytest.approx(solved.residuals[t], abs=1e-6)


def test_world_is_upright_and_of_a_handy_size(solved: CameraPath) -> None:
    """Up is within a few degrees of the truth, the first camera looks along +Y from above the origin."""
    assert np.degrees(np.arccos(-solved.R[:, 1, 2].mean())) < 15
    assert solved.R[0, 2, 0] == pytest.approx(0, abs=1e-9)
    assert solved.R[0, 2, 1] > 0.9
    assert solved.centres[0, :2] == pytest.approx([0, 0], abs=1e-9)
    assert np.median(solved[0].depth(solved.points)) == pytest.approx(5.0, rel=1e-6)


def test_same_clip_same_bits(walked: Film, solved: CameraPath) -> None:
    """A second run, with another number of threads in the picture library, gives the same bits."""
    import cv2

    threads = cv2.getNumThreads()
    try:
        cv2.setNumThreads(1 if threads > 1 else 2)
        again = solve_cameras(walked.frames, masks=walked.masks)
    finally:
        cv2.setNumThreads(threads)
    for name in ("K", "R", "T", "points", "residuals", "observations"):
        assert getattr(again, name).tobytes() == getattr(solved, name).tobytes(), name


def test_given_focal_is_kept(walked: Film) -> None:
    """A known focal length comes back exactly and the path fits it."""
    focal = float(walked.cameras.K[0, 0, 0])
    path = solve_cameras(walked.frames, masks=walked.masks, focal=focal)
    assert path.K[0, 0, 0] == pytest.approx(focal, rel=1e-12)
    assert path_error(path.centres, walked.cameras.centres) < 0.0015


def test_a_still_camera_is_static_with_a_moving_subject_unmasked() -> None:
    """Identity poses, and the reason says what is unknown, although a large blob moves without a mask."""
    one = handheld(1, SIZE, seed=3)
    still = CameraPath(K=np.tile(one.K, (10, 1, 1)), R=np.tile(one.R, (10, 1, 1)), T=np.tile(one.T, (10, 1)))
    clip = film(room(3), still, SIZE, blob=True, seed=3)
    path = solve_cameras(clip.frames)
    assert path.verdict == "static"
    assert (np.eye(3) == path.R).all()
    assert (path.T == 0).all()
    assert path.residuals.max() < 1
    assert "depth, up and scale are unknown" in path.reason


def test_a_turning_camera_gives_rotations_and_focal_length() -> None:
    """All centres coincide; turns 0.05 degrees, focal 1 %."""
    clip = film(room(4), handheld(14, SIZE, travel=0, turn=3.0, seed=4), SIZE, blob=True, seed=4)
    path = solve_cameras(clip.frames, masks=clip.masks)
    assert path.verdict == "rotation"
    assert np.ptp(path.centres, axis=0).max() < 1e-12
    assert turn_error(path.R, clip.cameras.R).max() < 0.05
    assert path.K[0, 0, 0] == pytest.approx(clip.cameras.K[0, 0, 0], rel=0.01)
    assert path.residuals.max() < 0.5
    assert "no depth" in path.reason


def test_a_flat_scene_is_called_planar() -> None:
    """A walk past one wall: poses fit, the verdict warns."""
    clip = film(wall(5), handheld(16, SIZE, travel=2.0, seed=5), SIZE, seed=5)
    path = solve_cameras(clip.frames, focal=float(clip.cameras.K[0, 0, 0]))
    assert path.verdict == "planar"
    assert path_error(path.centres, clip.cameras.centres) < 0.01
    assert "one plane" in path.reason


def test_a_cut_is_named(walked: Film) -> None:
    """Two places in one clip: the first frame of the second is named."""
    other = film(room(99), handheld(6, SIZE, seed=99), SIZE, seed=99)
    path = solve_cameras(np.concatenate([walked.frames[:8], other.frames]))
    assert path.verdict == "failed"
    assert "cuts to another picture at frame 8" in path.reason


def test_a_blank_clip_fails_with_a_reason() -> None:
    """Nothing to follow: failed, and still one usable camera a frame."""
    frames = np.full((5, 120, 160, 3), 128, np.uint8)
    path = solve_cameras(frames)
    assert path.verdict == "failed"
    assert len(path) == 5
    assert "too few features" in path.reason


def test_masks_over_everything_fail_with_a_reason(walked: Film) -> None:
    """No background left: the reason names the masks."""
    path = solve_cameras(walked.frames[:4], masks=np.ones((4, *walked.frames.shape[1:3]), bool))
    assert path.verdict == "failed"
    assert "masks" in path.reason


def test_one_frame_is_static(walked: Film) -> None:
    """One picture shows no motion, and the focal length that is given is kept."""
    path = solve_cameras(walked.frames[:1], focal=300.0)
    assert (path.verdict, len(path), path.K[0, 0, 0]) == ("static", 1, 300.0)
    assert "One frame" in path.reason


@pytest.mark.parametrize(
    ("frames", "options", "said"),
    [
        ([], {}, "no frames"),
        (np.zeros((2, 40, 60, 3), np.uint8), {}, "at least 64"),
        (np.zeros((2, 100, 100, 3)), {}, "uint8 RGB"),
        (np.zeros((2, 100, 100, 3), np.uint8), {"masks": np.zeros((3, 100, 100), bool)}, "3 masks for 2 frames"),
        (np.zeros((2, 100, 100, 3), np.uint8), {"masks": np.zeros((2, 50, 100), bool)}, "mask of frame 0"),
        (np.zeros((2, 100, 100, 3), np.uint8), {"focal": -5.0}, "focal length must be"),
        ([np.zeros((100, 100, 3), np.uint8), np.zeros((90, 100, 3), np.uint8)], {}, "Frame 1 has shape"),
    ],
)
def test_bad_input_gets_one_sentence(frames: object, options: dict, said: str) -> None:
    """Each kind of bad input is named, with what was found."""
    with pytest.raises(InputError, match=said):
        solve_cameras(frames, **options)


@pytest.mark.parametrize("when", [0.1, 0.4, 0.62, 0.75, 0.95])
def test_cancel_leaves_nothing_running(walked: Film, when: float) -> None:
    """Cancelling in any stage raises at once, and no thread of the mapper stays behind."""

    def progress(fraction: float) -> None:
        if fraction >= when:
            raise Cancelled

    with pytest.raises(Cancelled):
        solve_cameras(walked.frames, masks=walked.masks, progress=progress)
    assert not [t for t in threading.enumerate() if t.name == "camera mapping"]


def test_progress_rises_and_is_asked_often(walked: Film) -> None:
    """Fractions never fall, end at 1, and are at most a good part of a second of work apart."""
    seen: list[tuple[float, float]] = []
    solve_cameras(walked.frames, masks=walked.masks, progress=lambda f: seen.append((f, time.process_time())))
    fractions = np.array([f for f, _ in seen])
    assert (np.diff(fractions) >= -1e-12).all()
    assert fractions[-1] == 1.0
    assert len(seen) > 60
