"""Frames that lend colours are laid over a frame whose camera was solved a little wrong, by what both show."""

from __future__ import annotations

import attrs
import cv2
import numpy as np
import pytest

from imitation.depth.alignment import aligned
from imitation.depth.colours import Lenders, gather
from imitation.depth.sharpness import ring_of
from imitation.geometry.projection import Camera

SIZE = (240, 160)
HERE = Camera(np.array([[200.0, 0, 119.5], [0, 200.0, 79.5], [0, 0, 1]]), np.eye(3), np.zeros(3))
INVERSE = np.full(SIZE[::-1], 0.1, np.float32)
HOLE = np.zeros(SIZE[::-1], bool)
HOLE[55:105, 90:150] = True


def texture(seed: int) -> np.ndarray:
    """A picture (160, 240, 3) of fine and coarse detail."""
    rng = np.random.default_rng(seed)
    fine = cv2.GaussianBlur(rng.normal(0, 70, (*SIZE[::-1], 3)), (0, 0), 1.2)
    return np.clip(128 + fine + cv2.GaussianBlur(rng.normal(0, 300, (*SIZE[::-1], 3)), (0, 0), 8.0), 0, 255)


def moved(picture: np.ndarray, way: np.ndarray, seed: int) -> np.ndarray:
    """The picture whose pixel x shows what the other shows at ``way`` of it, with noise of 2 grey levels."""
    made = cv2.warpAffine(
        picture.astype(np.float32), way[:2], SIZE, flags=cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REFLECT,
    )  # fmt: skip
    noise = np.random.default_rng(seed).normal(0, 2, made.shape)
    return np.clip(np.rint(made + noise), 0, 255).astype(np.uint8)


def lent(pictures: list[np.ndarray]) -> Lenders:
    """Frames taken, by their cameras, from the same place, of a wall 10 units away."""
    count = len(pictures)
    return Lenders(
        np.stack(pictures), np.zeros((count, *SIZE[::-1]), np.uint8), [HERE] * count, np.ones((count, 3), np.float32),
        np.zeros((count, 16, 24), np.float32), 0.02,
    )  # fmt: skip


def ring() -> np.ndarray:
    """Where both are compared; a frame this small has a ring of 7 pixels."""
    return ring_of(HOLE, ~HOLE)


def off(found: np.ndarray, way: np.ndarray) -> float:
    """The farthest that a map strays in the hole, pixels."""
    rows, columns = np.nonzero(HOLE)
    at = np.stack([columns, rows, np.ones_like(rows)], axis=1).astype(float)
    return float(np.linalg.norm((at @ (found - way).T)[:, :2], axis=1).max())


TURN = np.array([[1.004, -0.006], [0.006, 1.004]])
MIDDLE = np.array([119.5, 79.5])
# A third of a pixel, with a roll and a zoom: at a width of 960, four times as much.
WAY = np.vstack([np.column_stack([TURN, MIDDLE - TURN @ MIDDLE + (0.25, -0.2)]), [0, 0, 1]])


def test_a_jerk_of_the_frame_is_found_from_the_ring() -> None:
    """The frame shows what other frames show a part of a pixel aside, turned: found to a tenth of one."""
    sharp = texture(5)
    frame = moved(sharp, WAY, 1)
    found = aligned(frame, ring(), INVERSE, HERE, lent([moved(sharp, np.eye(3), k) for k in (2, 3)]))
    assert off(np.eye(3), WAY) > 0.3
    for each in found:
        assert off(each, WAY) < 0.1


def test_the_fill_comes_nearer_to_what_is_hidden() -> None:
    """The hole itself is not looked at: another picture in it changes no map."""
    sharp = texture(6)
    frame = moved(sharp, WAY, 1)
    lenders = lent([moved(sharp, np.eye(3), k) for k in (2, 3, 4, 5)])
    covered = np.where(HOLE[..., None], np.uint8(0), frame)
    # Slopes are smoothed over a pixel or two, so the ring begins beyond what the hole darkens.
    beyond = ring() & ~(cv2.dilate(HOLE.astype(np.uint8), np.ones((11, 11))) > 0)
    found = aligned(covered, beyond, INVERSE, HERE, lenders)
    assert np.allclose(found, aligned(frame, beyond, INVERSE, HERE, lenders), atol=1e-3)
    rows, columns = np.nonzero(HOLE)
    before, after = (
        gather(rows, columns, INVERSE[HOLE], HERE, each, 4)[0]
        for each in (lenders, attrs.evolve(lenders, astray=found))
    )
    assert np.std(after - frame[HOLE]) < 0.6 * np.std(before - frame[HOLE])


@pytest.mark.parametrize("why", ["aligned already", "no texture", "far astray", "another picture", "hidden"])
def test_what_the_ring_does_not_tell_moves_nothing(why: str) -> None:
    """A map that is not believed is the identity; one that noise alone makes better strays by next to nothing."""
    sharp = np.full((*SIZE[::-1], 3), 120.0) if why == "no texture" else texture(7)
    way = np.eye(3)
    way[0, 2] = {"far astray": 4.0, "no texture": 0.5, "hidden": 0.5}.get(why, 0.0)
    other = texture(8) if why == "another picture" else sharp
    lenders = lent([moved(other, np.eye(3), k) for k in (2, 3)])
    if why == "hidden":
        lenders = attrs.evolve(lenders, hidden=np.ones_like(lenders.hidden))
    found = aligned(moved(sharp, way, 1), ring(), INVERSE, HERE, lenders)
    assert max(off(each, np.eye(3)) for each in found) < (0.06 if why == "aligned already" else 1e-9)


def test_another_exposure_is_no_shift() -> None:
    """A frame brighter by eight grey levels stays where it is."""
    sharp = np.clip(texture(9), 20, 230)
    found = aligned(moved(sharp + 8, np.eye(3), 1), ring(), INVERSE, HERE, lent([moved(sharp, np.eye(3), 2)]))
    assert off(found[0], np.eye(3)) < 0.06
