"""The subject's own shadow is told from what is merely dark, and taken out of the plate."""

from __future__ import annotations

import cv2
import numpy as np

from imitation.depth import Background
from imitation.depth.shadow import darkest_round, shadow_of
from tests.imitation.depth.conftest import Solved

HIGH, WIDE = 180, 320


def ground(seed: int) -> np.ndarray:
    """A paved ground (180, 320, 3), float."""
    rng = np.random.default_rng(seed)
    grain = cv2.GaussianBlur(rng.normal(0, 40, (HIGH, WIDE, 3)), (0, 0), 1.5)
    return np.clip(np.array([170.0, 160.0, 150.0]) + grain, 20, 255)


def subject() -> np.ndarray:
    """A mask with its rim, uint8."""
    mask = np.zeros((HIGH, WIDE), np.uint8)
    mask[50:120, 140:180] = 1
    return mask


def test_a_shadow_beside_the_subject_is_found() -> None:
    """Half as bright in an ellipse at the feet: nearly all of it, and hardly more; exposure noise is none."""
    bare, mask = ground(1), subject()
    dark = cv2.ellipse(np.zeros((HIGH, WIDE), np.uint8), (200, 122), (50, 12), 0, 0, 360, 1, -1) > 0
    share = cv2.GaussianBlur(np.where(dark, 0.5, 1.0), (0, 0), 1.5)[..., None]
    noise = np.random.default_rng(2).normal(0, 3, bare.shape)
    picture = np.clip(bare * share + noise, 0, 255).astype(np.uint8)
    picture[mask > 0] = 30
    lowest = darkest_round(bare.astype(np.uint8)).astype(np.float32)
    known = mask == 0
    found = shadow_of(picture, bare.astype(np.float32), lowest, known, mask, WIDE)
    assert found[dark & known].mean() > 0.9
    away = cv2.distanceTransform((~dark).astype(np.uint8), cv2.DIST_L2, 5)
    assert not found[away > 6].any()
    plain = np.clip(bare + noise, 0, 255).astype(np.uint8)
    assert not shadow_of(plain, bare.astype(np.float32), lowest, known, mask, WIDE).any()


def test_dark_things_that_other_frames_show_beside_their_place_are_no_shadow() -> None:
    """A bar that is two pixels astray in the other frames, another colour, and a dark place far away are left."""
    bare, mask = ground(3), subject()
    bare[120:128, :] *= 0.4
    picture = ground(3)
    picture[122:130, :] *= 0.4
    picture[60:90, 182:200] = picture[60:90, 182:200] * 0.6 * np.array([1.4, 0.6, 0.6])
    picture[5:25, 5:45] *= 0.5
    lowest = darkest_round(np.clip(bare, 0, 255).astype(np.uint8)).astype(np.float32)
    shown = np.clip(picture, 0, 255).astype(np.uint8)
    found = shadow_of(shown, bare.astype(np.float32), lowest, mask == 0, mask, WIDE)
    assert found.mean() < 0.002


def test_the_plate_is_without_the_shadow_where_it_is_asked(solved: Solved) -> None:
    """A shadow that goes with the blob: filled from the frames where it lies elsewhere; else the plate keeps it."""
    world, frame = solved.world, 7
    frames, shadows = world.frames.copy(), np.zeros(world.masks.shape, bool)
    for t, mask in enumerate(world.masks):
        rows, columns = np.nonzero(mask)
        spot = (int(columns.mean()), min(int(rows.max()) + 8, 143))
        shadows[t] = cv2.ellipse(np.zeros(mask.shape, np.uint8), spot, (22, 8), 0, 0, 360, 1, -1) > 0
        shadows[t] &= ~mask
        frames[t][shadows[t]] = frames[t][shadows[t]] * 0.5
    with_it = Background(frames, world.cameras, solved.maps, masks=world.masks).plate(frame)
    without = Background(frames, world.cameras, solved.maps, masks=world.masks, shadows=True).plate(frame)
    dark = shadows[frame]
    errors = [
        np.abs(each.picture[dark].astype(float) - world.frames[frame][dark]).mean() for each in (with_it, without)
    ]
    assert errors[1] < 0.6 * errors[0]
    untouched = ~(without.filled | without.invented)
    np.testing.assert_array_equal(without.picture[untouched], frames[frame][untouched])
