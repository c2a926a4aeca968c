"""What frames lend to a plate: not what stands before the place there, and as sharp as they are."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from imitation.depth.colours import Lenders, gather
from imitation.geometry.projection import Camera

K = np.array([[100.0, 0, 49.5], [0, 100.0, 29.5], [0, 0, 1]])
HERE = Camera(K, np.eye(3), np.zeros(3))
POST = slice(40, 48)


def lenders(front: float, count: int = 11) -> Lenders:
    """Frames from the same place; in all but the last four a red post stands before a grey wall 10 units away."""
    stack = np.full((count, 60, 100, 3), 90, np.uint8)
    stack[:-4, :, POST] = (250, 0, 0)
    seen = np.full((count, 30, 50), 0.1, np.float32)
    seen[:-4, :, 20:24] = front
    return Lenders(
        stack, np.zeros((count, 60, 100), np.uint8), [HERE] * count, np.ones((count, 3), np.float32), seen, 0.02
    )


def lent(front: float) -> tuple[np.ndarray, np.ndarray]:
    """Colours of the wall behind the middle of the post."""
    rows, columns = np.array([20, 30]), np.array([43, 44])
    colour, seen = gather(rows, columns, np.full(2, 0.1, np.float32), HERE, lenders(front), 8)
    return colour, seen


def test_a_frame_that_sees_a_post_before_the_place_does_not_lend_it() -> None:
    """Seven of eleven frames show the post, and their depth says so: the other four's wall is taken."""
    colour, seen = lent(0.5)
    assert np.allclose(colour, 90)
    assert (seen == 4).all()


def test_depth_that_hardly_differs_hides_nothing() -> None:
    """Nearer by less than depth strays: the nearest eight frames speak, and most of them say red."""
    colour, seen = lent(0.11)
    assert np.allclose(colour, (250, 0, 0))
    assert (seen == 8).all()


def test_where_nearly_every_frame_sees_something_before_the_place_colours_are_taken_all_the_same() -> None:
    """Then it is rather the depth that is wrong."""
    stack = lenders(0.5)
    alone = stack.of([0, 1, 7])
    colour, seen = gather(np.array([20]), np.array([43]), np.full(1, 0.1, np.float32), HERE, alone, 8)
    assert np.allclose(colour, (250, 0, 0))
    assert (seen == 3).all()


@pytest.mark.parametrize("shift", [0.3, 0.5])
def test_colours_between_pixels_stay_sharp(shift: float) -> None:
    """A fine texture seen half a pixel aside: nearer to what is there than by straight lines between pixels."""
    x = np.arange(100)
    random = np.random.default_rng(2)
    waves = [(random.uniform(0.4, 1.6), random.uniform(0, 6)) for _ in range(12)]

    def strip(offset: float) -> np.ndarray:
        return 127 + 8 * sum(np.sin(w * (x + offset) + phase) for w, phase in waves)

    aside = Camera(K, np.eye(3), np.array([shift * 10 / 100, 0, 0]))
    picture = np.broadcast_to(np.rint(strip(-shift))[None, :, None], (60, 100, 3)).astype(np.uint8).copy()
    whole = Lenders(
        picture[None], np.zeros((1, 60, 100), np.uint8), [aside], np.ones((1, 3), np.float32),
        np.zeros((1, 30, 50), np.float32), 0.02,
    )  # fmt: skip
    columns = np.arange(10, 90)
    colour, seen = gather(np.full(80, 30), columns, np.full(80, 0.1, np.float32), HERE, whole, 8)
    assert (seen == 1).all()
    truth = strip(0.0)[columns]
    straight = cv2.remap(
        picture.astype(np.float32), np.tile(columns + shift, (1, 1)).astype(np.float32),
        np.full((1, 80), 30, np.float32), cv2.INTER_LINEAR,
    )[0, :, 0]  # fmt: skip
    assert np.std(colour[:, 0] - truth) < 0.6 * np.std(straight - truth)
