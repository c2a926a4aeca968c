"""The ground of a place with several levels, and where a single plane stays what it is."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import CameraPath
from imitation.cameras import plane_ground
from imitation.cameras.levels import recovered_ground

STREET, PAVING = -1.6, -0.3


def panned(points: np.ndarray, spread: float = 50.0, roll: float = 0.0, height: float = 1.5) -> CameraPath:
    """Forty cameras that go sideways, turn by ``spread`` degrees in all, look down by 12, and roll by chance."""
    random = np.random.default_rng(3)
    frames = 40
    R = np.zeros((frames, 3, 3))
    for k, yaw in enumerate(np.radians(np.linspace(-spread / 2, spread / 2, frames))):
        pitch, lean = np.radians(12.0), np.radians(roll * random.normal())
        forward = np.array([np.sin(yaw) * np.cos(pitch), np.cos(yaw) * np.cos(pitch), -np.sin(pitch)])
        right = np.array([np.cos(yaw), -np.sin(yaw), 0.0])
        down = np.cross(forward, right)
        R[k] = [np.cos(lean) * right + np.sin(lean) * down, np.cos(lean) * down - np.sin(lean) * right, forward]
    centres = np.stack([np.linspace(-2, 2, frames), np.zeros(frames), np.full(frames, height)], axis=1)
    K = np.tile(np.array([[800, 0, 426.5], [0, 800, 239.5], [0, 0, 1.0]]), (frames, 1, 1))
    return CameraPath(K=K, R=R, T=-np.einsum("nij,nj->ni", R, centres), points=points)


def level(random: np.random.Generator, height: float, count: int, near: float, far: float) -> np.ndarray:
    """Points of a level floor, a little uneven."""
    return np.c_[
        random.uniform(-4, 4, count), random.uniform(near, far, count), height + 0.01 * random.normal(size=count)
    ]


def terraces(seed: int) -> np.ndarray:
    """A wall's top close by, paving behind it, a street below that, and fronts of houses."""
    random = np.random.default_rng(seed)
    fronts = np.c_[random.uniform(-6, 6, 500), random.uniform(14, 15, 500), random.uniform(STREET, 6, 500)]
    steps = np.concatenate([
        np.c_[random.uniform(-4, 4, 250), random.normal(y, 0.02, 250), random.uniform(low, high, 250)]
        for y, low, high in ((3.0, PAVING, 0.6), (7.0, STREET, PAVING))
    ])  # fmt: skip
    floors = [level(random, 0.6, 350, 2.4, 3.0), level(random, PAVING, 350, 3, 7), level(random, STREET, 350, 7, 14)]
    return np.concatenate([*floors, steps, fronts])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_plane_through_several_levels_is_no_ground(seed: int) -> None:
    """Up comes from the cameras then, and the lowest level with many points is the ground."""
    path = panned(terraces(seed), roll=0.2)
    through_all = plane_ground(path.points, up=(0, 0, 1), selected=False).plane
    assert through_all is not None
    ground = recovered_ground(path)
    assert ground.plane is not None
    assert np.degrees(np.arccos(through_all.normal[2])) > 10
    assert "as the camera was held" in ground.name
    assert abs(ground.plane.offset - STREET) < 0.05, "the street, for from the wall one sees things beneath it"
    assert ground.plane.normal[2] > np.cos(np.radians(1.0))


def test_a_hillside_stays_tilted() -> None:
    """A slope of 12 degrees leans against the cameras, too, but nothing is seen beneath it."""
    random = np.random.default_rng(5)
    slope = level(random, 0.0, 1200, 3, 12)
    slope[:, 2] += np.tan(np.radians(12)) * (slope[:, 1] - 3)
    wrong = np.c_[random.uniform(-4, 4, 60), random.uniform(3, 12, 60), random.uniform(-3, 0, 60)]
    path = panned(np.concatenate([slope, wrong]), roll=0.2)
    found = recovered_ground(path)
    assert "as the camera was held" not in found.name
    assert found.plane is not None
    assert np.degrees(np.arccos(found.plane.normal[2])) == pytest.approx(12, abs=0.5)


def test_cameras_that_hardly_turn_do_not_say_what_is_up() -> None:
    """With 2 degrees of turn and half a degree of roll, the rows leave more open than any plane."""
    path = panned(terraces(1), spread=2.0, roll=0.5)
    old = plane_ground(path.points, up=(0, 0, 1), selected=False)
    assert recovered_ground(path).name == old.name


def test_a_table_stays_the_ground() -> None:
    """The floor is seen beneath a level table; that alone does not take the plane away that holds most points."""
    random = np.random.default_rng(7)
    path = panned(np.concatenate([level(random, 0.0, 900, 2, 5), level(random, -0.9, 300, 5, 12)]), roll=0.2)
    ground = recovered_ground(path)
    assert "as the camera was held" not in ground.name
    assert ground.plane is not None
    assert abs(ground.plane.offset) < 0.02
