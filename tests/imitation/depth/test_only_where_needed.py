"""What is worked out only where it is needed is there the same to the bit as worked out everywhere."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from imitation.depth import Background, shown_background
from imitation.depth.colours import gains
from imitation.depth.filling import AROUND, painted
from imitation.depth.hiding import ALIKE, SMOOTH
from imitation.depth.projection import Wanted, consensus, inverse_of, projected_inverse
from imitation.geometry.projection import Camera
from tests.imitation.depth.conftest import Solved


@pytest.fixture(scope="module")
def background(solved: Solved) -> Background:
    """A background of its own: what it keeps is looked at."""
    return Background(solved.world.frames, solved.world.cameras, solved.maps, masks=solved.world.masks)


@pytest.mark.parametrize("frame", [2, 7, 11])
def test_depth_between_key_frames_where_nothing_is_confirmed(background: Background, frame: int) -> None:
    """The nearest maps' unconfirmed pixels alone give what whole maps give there."""
    size, camera = background.pictures.size, background.camera(frame)
    near = sorted(background.maps, key=lambda each: (abs(each.frame - frame), each.frame))[:6]
    rank = (1 / (1 + 0.15 * np.arange(len(near)))).astype(np.float32)

    def said(least: int) -> np.ndarray:
        layers = [projected_inverse(inverse_of(each, least), each.camera, camera, size) for each in near]
        return consensus(np.stack(layers), background.tolerance, rank)[0]

    firm, loose = said(1), said(0)
    assert ((firm <= 0) & (loose > 0)).sum() > 20, "nothing of the kind is here"
    expected = np.where(firm > 0, firm, loose)
    found = background.depth(frame).depth
    with np.errstate(divide="ignore"):
        np.testing.assert_array_equal(found, np.where(expected > 0, 1 / expected, np.nan).astype(np.float32))


def test_nothing_wanted_gives_nothing(background: Background) -> None:
    """An empty wish is no error."""
    each, size = background.maps[0], background.pictures.size
    asked = Wanted.of(np.zeros(size[::-1], bool))
    assert not projected_inverse(inverse_of(each), each.camera, background.camera(5), size, asked).any()


@pytest.mark.parametrize("corner", [False, True])
def test_painting_in(corner: bool) -> None:
    """Blots of all kinds, inside the picture and over its border."""
    random = np.random.default_rng(8)
    picture = cv2.GaussianBlur(random.integers(0, 255, (150, 210, 3)).astype(np.uint8), (0, 0), 2.0)
    blots = cv2.GaussianBlur(random.normal(size=(150, 210)).astype(np.float32), (0, 0), 3.0) > 0.1
    invented = np.zeros(blots.shape, bool)
    part = (slice(0, 70), slice(120, 210)) if corner else (slice(50, 95), slice(60, 130))
    invented[part] = blots[part]
    expected = cv2.inpaint(picture, invented.astype(np.uint8), AROUND, cv2.INPAINT_TELEA)
    np.testing.assert_array_equal(painted(picture, invented), expected)
    assert painted(picture, np.zeros_like(invented)) is picture


def test_colours_compared_where_the_plate_is_filled(solved: Solved) -> None:
    """Which of the mask shows the background, against whole smoothed pictures."""
    for frame in (6, 11):
        plate, picture = solved.background.plate(frame), solved.world.frames[frame]
        smooth = [cv2.GaussianBlur(each, (0, 0), SMOOTH).astype(np.float32) for each in (picture, plate.picture)]
        alike = np.abs(smooth[0] - smooth[1]).max(axis=-1) < ALIKE
        expected = ~(plate.filled | plate.invented) | (plate.filled & alike)
        assert (plate.filled & alike).any()
        np.testing.assert_array_equal(shown_background(picture, plate), expected)


def test_gains_are_median_ratios() -> None:
    """Of the points that both show, neither nearly black nor burnt out; 1 where too few tell."""
    random = np.random.default_rng(5)
    high, wide = 120, 200
    K = np.array([[150.0, 0, 99.5], [0, 150.0, 59.5], [0, 0, 1]])
    camera = Camera(K, np.eye(3), np.zeros(3))
    poses = [Camera(K, np.eye(3), np.array([shift, 0.1, 0])) for shift in (0.3, -1.1, 40.0)]
    picture = random.integers(0, 255, (high, wide, 3)).astype(np.uint8)
    stack = random.integers(0, 255, (3, high, wide, 3)).astype(np.uint8)
    hidden = (random.random((3, high, wide)) < 0.2).astype(np.uint8)
    hole = random.random((high, wide)) < 0.1
    inverse = random.uniform(0.05, 0.2, (high, wide)).astype(np.float32)
    inverse[random.random(inverse.shape) < 0.1] = 0
    rows, columns = (each.ravel() for each in np.mgrid[3:high:7, 3:wide:7])
    use = ~hole[rows, columns] & (inverse[rows, columns] > 0)
    rows, columns = rows[use], columns[use]
    points = camera.lift(np.stack([columns, rows], axis=1), 1 / inverse[rows, columns].astype(np.float64))
    expected = np.ones((3, 3), np.float32)
    for n, pose in enumerate(poses):
        at = np.rint(pose.project(points))
        inside = (pose.project(points) >= 0).all(axis=1) & (pose.project(points) <= [wide - 1, high - 1]).all(axis=1)
        x, y = at[inside].astype(int).T
        own, other = picture[rows[inside], columns[inside]].astype(float), stack[n, y, x].astype(float)
        for c in range(3):
            tells = (hidden[n, y, x] == 0) & (np.minimum(own, other)[:, c] > 12) & (np.maximum(own, other)[:, c] < 245)
            if tells.sum() >= 40:
                expected[n, c] = np.clip(np.median(own[tells, c] / other[tells, c]), 0.5, 2.0)
    assert (expected[:2] != 1).all()
    assert (expected[2] == 1).all()
    np.testing.assert_array_equal(gains(picture, hole, inverse, camera, stack, hidden, poses), expected)
