"""Near and far exchanged: found and put right, and left alone where nothing is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.cameras.adjust import Bundle
from imitation.cameras.outcome import refined
from imitation.cameras.reversal import reversed_bundle, right_way_round


def filmed(distance: float, focal: float, seed: int = 3) -> Bundle:
    """A camera that goes round a deep scene from a distance, with a fifth of a pixel of noise."""
    rng = np.random.default_rng(seed)
    points = rng.uniform([-1, -0.7, -1.2], [1, 0.7, 1.2], (300, 3))
    angles = np.linspace(-0.2, 0.2, 15)
    c, s, zero, one = np.cos(angles), np.sin(angles), np.zeros(15), np.ones(15)
    R = np.stack([c, zero, -s, zero, one, zero, s, zero, c], axis=1).reshape(-1, 3, 3)
    T = np.tile([0, 0, distance], (15, 1)) + rng.normal(0, 0.02, (15, 3))
    local = np.einsum("nij,pj->npi", R, points) + T[:, None]
    pixels = focal * local[..., :2] / local[..., 2:] + [320, 180] + rng.normal(0, 0.2, (15, 300, 2))
    camera, point = (index.ravel() for index in np.mgrid[:15, :300])
    return Bundle.of(focal, np.array([320.0, 180.0]), R, T, points, camera, point, pixels.reshape(-1, 2))


def depth_order(bundle: Bundle, truth: Bundle) -> float:
    """Correlation of the points' depths in camera 7 with the true ones."""
    depths = [(b.points @ b.R[7].T + b.T[7])[:, 2] for b in (bundle, truth)]
    return float(np.corrcoef(*depths)[0, 1])


def finish(bundle: Bundle) -> Bundle:
    """Adjust without losing points, so that the test can compare them."""
    from imitation.cameras.adjust import adjust

    return adjust(bundle, loss=1.0, free_focal=False, iterations=40)


@pytest.mark.parametrize("distance", [12.0, 18.0])
def test_a_reversed_scene_is_put_right(distance: float) -> None:
    """An adjustment stuck in the mirror image in depth is found out by the perspective that is left."""
    truth = filmed(distance, 160 * distance)
    stuck = finish(reversed_bundle(truth))
    assert depth_order(stuck, truth) < -0.9
    righted = right_way_round(stuck, finish, free_focal=False)
    assert depth_order(righted, truth) > 0.98


@pytest.mark.parametrize("distance", [4.0, 12.0])
def test_a_right_scene_is_left_alone(distance: float) -> None:
    """The true solution is returned as it is, under weak and under strong perspective."""
    right = finish(filmed(distance, 160 * distance))
    assert right_way_round(right, finish, free_focal=False) is right


def test_a_reversal_keeps_the_pictures_of_a_long_lens() -> None:
    """The farther the camera, the less the pictures of the two differ."""
    errors = [
        float(np.median(reversed_bundle(filmed(distance, 160 * distance)).errors())) for distance in (6.0, 24.0, 96.0)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 5


def test_the_finish_of_the_solver_fits() -> None:
    """The solver's own last adjustment can be used to finish."""
    truth = filmed(12.0, 1900.0)
    righted = right_way_round(finish(reversed_bundle(truth)), lambda b: refined(b, False), free_focal=False)
    assert float(np.median(righted.errors())) < 0.35
