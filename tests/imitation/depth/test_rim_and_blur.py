"""A fill is as blurred as its frame; a thin post before the subject stays what the frame shows."""

from __future__ import annotations

import cv2
import numpy as np

from imitation import CameraPath
from imitation.depth.rim import between_parts, depth_along
from imitation.depth.sharpness import line, movement, ring_of, sharp_first, smear, speeds

SIZE = (320, 180)


def texture(seed: int) -> np.ndarray:
    """A picture (180, 320, 3) of fine and coarse detail."""
    rng = np.random.default_rng(seed)
    fine = cv2.GaussianBlur(rng.normal(0, 60, (180, 320, 3)), (0, 0), 1.0)
    return np.clip(128 + fine + cv2.GaussianBlur(rng.normal(0, 300, (180, 320, 3)), (0, 0), 8.0), 0, 255)


def sliding(steps: list[float]) -> CameraPath:
    """A camera that slides along x by these many world units from frame to frame; focal length 300."""
    count = len(steps) + 1
    K = np.array([[300.0, 0, 159.5], [0, 300.0, 89.5], [0, 0, 1]])
    T = np.zeros((count, 3))
    T[1:, 0] = -np.cumsum(steps)
    return CameraPath(np.tile(K, (count, 1, 1)), np.tile(np.eye(3), (count, 1, 1)), T)


def test_the_blur_of_a_frame_is_found_and_given_to_the_fill() -> None:
    """A frame smeared over half of 12 pixels: the share is found within an eighth, and the fill comes nearer to it."""
    sharp, along = texture(1), np.array([12.0, 3.0])
    frame = cv2.filter2D(sharp, -1, line(0.5 * along), borderType=cv2.BORDER_REPLICATE)
    hole = np.zeros((180, 320), bool)
    hole[60:120, 120:190] = True
    known = np.ones_like(hole)
    ring = ring_of(hole, known)
    assert not (ring & hole).any()
    noisy = np.rint(np.clip(frame + np.random.default_rng(2).normal(0, 2, frame.shape), 0, 255)).astype(np.uint8)
    found = smear(noisy, sharp.astype(np.float32), known, ring, along)
    assert abs(found.share - 0.5) <= 0.125
    before = np.abs(sharp - frame)[hole].mean()
    assert np.abs(found.of(sharp.astype(np.float32), known) - frame)[hole].mean() < 0.25 * before


def test_a_sharp_frame_gets_a_sharp_fill() -> None:
    """The camera moves, the frame is as sharp as the fill, or less noisy: nothing is blurred."""
    sharp = texture(3)
    hole = np.zeros((180, 320), bool)
    hole[60:120, 120:190] = True
    noisy = sharp + np.random.default_rng(4).normal(0, 2, sharp.shape)
    frame = np.rint(np.clip(sharp, 0, 255)).astype(np.uint8)
    for other in (sharp, noisy):
        found = smear(
            frame, other.astype(np.float32), ~np.zeros_like(hole), ring_of(hole, ~hole), np.array([12.0, 3.0])
        )
        assert found.share == 0
    still = smear(frame, cv2.GaussianBlur(sharp, (0, 0), 2).astype(np.float32), ~hole | hole, ring_of(hole, ~hole),
                  np.zeros(2))  # fmt: skip
    assert still.share == 0, "a camera that stands still smears nothing"


def test_a_line_keeps_the_brightness_and_its_middle() -> None:
    """The kernel sums to 1, is centred, and as long as it was asked to be."""
    kernel = line(np.array([9.0, 0.0]))
    offsets = np.arange(kernel.shape[1]) - kernel.shape[1] // 2
    across = kernel.sum(axis=0)
    np.testing.assert_allclose(across.sum(), 1, rtol=1e-6)
    np.testing.assert_allclose(across @ offsets, 0, atol=1e-6)
    np.testing.assert_allclose(across @ offsets**2, 81 / 12, rtol=0.05)


def test_colours_come_from_near_and_sharp_frames() -> None:
    """A frame filmed while the camera jerked comes after all that are sharp, but not where the frame is as blurred."""
    cameras = sliding([0.01, 0.01, 0.3, 0.3, 0.01, 0.01, 0.01])
    speed = speeds(cameras, range(8), SIZE, 5.0)
    pixels = np.array([[100.0, 50.0]])
    np.testing.assert_allclose(movement(cameras, 1, pixels, np.array([0.2])), [[-0.6, 0]], atol=1e-9)
    assert speed[3] > 10
    assert speed[0] < 1
    order = sharp_first([0, 2, 3, 4, 5, 6, 7], 1, speed[[0, 2, 3, 4, 5, 6, 7]], float(speed[1]), max(SIZE))
    assert order[0] == 0
    assert order[-1] == 3
    assert sharp_first([0, 2, 4], 3, speed[[0, 2, 4]], float(speed[3]), max(SIZE))[0] in (2, 4)


def posted() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A frame with a light post before a dark subject; the mask that the post parts, and that with its rim."""
    picture = texture(5).astype(np.uint8) // 3
    picture[40:140, 60:260] = 10
    picture[:, 150:162] = 210
    mask = np.zeros((180, 320), np.uint8)
    mask[40:140, 60:260] = 1
    mask[:, 150:162] = 0
    return picture, mask, cv2.dilate(mask, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (15, 15)))


def test_a_post_that_parts_the_mask_is_left_as_the_frame_shows_it() -> None:
    """All of the post but its very edge is spared, also where it leaves the rim; nothing else of the rim is."""
    picture, mask, hidden = posted()
    spared = between_parts(picture, mask, hidden, 7.0)
    assert spared[34:146, 151:161].mean() > 0.95
    assert not spared[mask > 0].any()
    outside = spared.copy()
    outside[:, 148:164] = False
    assert not outside.any()
    assert not between_parts(picture, np.zeros_like(mask), np.zeros_like(mask), 7.0).any()


def test_the_post_is_as_far_as_above_and_below() -> None:
    """Depth of the spared part comes along the post, not from what lies beside it."""
    picture, mask, hidden = posted()
    inverse = np.full((180, 320), 0.1, np.float32)
    inverse[:, 150:162] = 0.4
    inverse[hidden > 0] = 0.15
    spared = between_parts(picture, mask, hidden, 7.0)
    made = depth_along(inverse, picture, (hidden > 0) & (mask == 0), spared)
    assert (made[60:120, 152:160] == np.float32(0.4)).mean() > 0.95
    np.testing.assert_array_equal(made[~spared], inverse[~spared])
