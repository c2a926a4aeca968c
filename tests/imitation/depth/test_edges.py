"""Steps of depth: found where single pixels of other frames say they are."""

from __future__ import annotations

import cv2
import numpy as np

from imitation.depth.edges import with_edges
from tests.imitation.depth.conftest import Solved

FRAME, VIEWS = 6, (2, 3, 4, 5, 7, 8, 9, 10)


def sharpened(solved: Solved, inverse: np.ndarray, settled: np.ndarray | None = None) -> np.ndarray:
    """Inverse depth of the frame after its edges were put right."""
    world, pictures = solved.world, solved.background.pictures
    return with_edges(
        inverse,
        pictures.colour(FRAME),
        pictures.hidden(FRAME),
        np.zeros(inverse.shape, bool) if settled is None else settled,
        world.cameras[FRAME],
        np.stack([pictures.colour(t) for t in VIEWS]),
        np.stack([pictures.hidden(t) for t in VIEWS]),
        [world.cameras[t] for t in VIEWS],
    )


def test_a_near_surface_that_is_too_wide_is_taken_back(solved: Solved) -> None:
    """True depth grown by a pixel all round: at high steps many wrong pixels come right, few right ones go wrong."""
    truth = (1 / solved.world.depth(FRAME)).astype(np.float32)
    wide = cv2.dilate(truth, np.ones((3, 3), np.uint8))
    shown = solved.background.pictures.hidden(FRAME) == 0
    better = sharpened(solved, wide)

    def wrong(inverse: np.ndarray) -> np.ndarray:
        return shown & (np.abs(inverse / truth - 1) > 0.15)

    assert wrong(wide).sum() > 300
    assert wrong(wide).sum() > 300
    assert wrong(better).sum() < 0.65 * wrong(wide).sum()
    assert (wrong(better) & ~wrong(wide)).sum() < 0.1 * wrong(wide).sum()


def test_what_has_no_step_stays_and_what_is_settled_too(solved: Solved) -> None:
    """Bits far from steps, under the mask and on plain surfaces are what they were; every value is one of before."""
    truth = (1 / solved.world.depth(FRAME)).astype(np.float32)
    wide = cv2.dilate(truth, np.ones((3, 3), np.uint8))
    hidden = solved.background.pictures.hidden(FRAME) > 0
    kernel = np.ones((7, 7), np.uint8)
    level = cv2.dilate(wide, kernel) - cv2.erode(wide, kernel) < 0.03 * cv2.dilate(wide, kernel)
    better = sharpened(solved, wide)
    np.testing.assert_array_equal(better[level | hidden], wide[level | hidden])
    assert np.isin(better, wide).all()
    np.testing.assert_array_equal(sharpened(solved, wide, np.ones(wide.shape, bool)), wide)
