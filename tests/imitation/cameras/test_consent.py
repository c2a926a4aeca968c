"""A path whose scale breaks is told by the matches that it contradicts."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.cameras.consent import ENOUGH, consent, least, worst_pair

FOCAL, CENTRE, FRAMES = 450.0, np.array([426.5, 239.5]), list(range(0, 40, 4))


def walked(broken: bool) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """A walk that turns; broken: the second half's steps are ten times as long beside the same near things."""
    poses, centre = {}, np.zeros(3)
    for k, frame in enumerate(FRAMES):
        turn = 0.03 * k
        R = np.array([[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]])
        poses[frame] = (R, -R @ centre)
        # Where only far things were seen, the walk may as well have gone any way.
        step = np.array([0.3, -0.02, 0.3]) if not (broken and k == 4) else np.array([-2.0, 1.0, 2.0])
        centre = centre + step
    return poses


def matches(seed: int) -> dict[tuple[int, int], tuple[np.ndarray, np.ndarray]]:
    """Half of the matches lie on far houses, half on the near ground; noise of half a pixel."""
    random, poses = np.random.default_rng(seed), walked(False)
    made = {}
    for i in range(len(FRAMES)):
        for j in range(i + 1, min(i + 3, len(FRAMES))):
            R, T = poses[FRAMES[i]]
            seen = random.uniform([0, 0], [853, 479], (400, 2))
            depth = np.where(np.arange(400) % 2, random.uniform(300, 500, 400), random.uniform(3, 9, 400))
            rays = np.concatenate([(seen - CENTRE) / FOCAL, np.ones((400, 1))], axis=1)
            points = (rays * depth[:, None] - T) @ R
            R2, T2 = poses[FRAMES[j]]
            there = points @ R2.T + T2
            other = FOCAL * there[:, :2] / there[:, 2:] + CENTRE
            made[i, j] = seen, other + random.normal(0, 0.5, other.shape)
    return made


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_sound_path_is_obeyed_and_a_broken_one_is_found_where_it_breaks(seed: int) -> None:
    """The pair that a path is to begin with anew lies over the break."""
    verified = matches(seed)
    sound = consent(FOCAL, walked(False), FRAMES, verified, CENTRE)
    assert least(sound) > 0.98
    assert worst_pair(sound, verified, []) is None
    broken = consent(FOCAL, walked(True), FRAMES, verified, CENTRE)
    assert least(broken) < ENOUGH
    worst = worst_pair(broken, verified, [])
    assert worst is not None
    assert worst[0] <= 4 < worst[1]
    assert worst[1] - worst[0] == 2


def test_a_place_that_was_tried_is_not_tried_again() -> None:
    """One break, one place to begin at."""
    verified = matches(4)
    broken = consent(FOCAL, walked(True), FRAMES, verified, CENTRE)
    worst = worst_pair(broken, verified, [])
    assert worst is not None
    assert worst_pair(broken, verified, [worst]) is None


def test_pairs_without_poses_or_matches_have_no_say() -> None:
    """What was not mapped, and a handful of matches."""
    verified = matches(5)
    poses = {frame: pose for frame, pose in walked(True).items() if frame < 16}
    assert all(j < 4 for _, j in consent(FOCAL, poses, FRAMES, verified, CENTRE))
    few = {pair: (first[:10], second[:10]) for pair, (first, second) in verified.items()}
    assert least(consent(FOCAL, walked(True), FRAMES, few, CENTRE)) == 1.0
