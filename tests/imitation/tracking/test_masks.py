"""Masks: outlines filled, carried by flow, held before the first and after the last key."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import Cancelled, InputError
from imitation.tracking import FlowField, Outline, carry_masks, compute_flow, fill_outlines
from imitation.tracking.masks import blend_masks
from tests.imitation.tracking.worlds import Texture, picture

SQUARE = np.array([(10.0, 10.0), (29.0, 10.0), (29.0, 29.0), (10.0, 29.0)])


def overlap(a: np.ndarray, b: np.ndarray) -> float:
    """Intersection over union."""
    return np.count_nonzero(a & b) / np.count_nonzero(a | b)


@pytest.fixture(scope="module")
def crossing() -> tuple[list[np.ndarray], np.ndarray, FlowField]:
    """A textured disc that crosses another texture in 17 frames and squeezes on the way; and its true masks."""
    height, width, frames = 160, 280, 17
    rows, columns = np.arange(height, dtype=float), np.arange(width, dtype=float)
    ground, skin = Texture(1), Texture(2)
    pictures, masks = [], []
    for t in range(frames):
        cx, cy, squeeze = 80 + 6.0 * t, 80 + 15 * np.sin(t / 4), 1 + 0.02 * t
        grid_y, grid_x = np.meshgrid(rows, columns, indexing="ij")
        mask = ((grid_x - cx) / squeeze) ** 2 + ((grid_y - cy) * squeeze) ** 2 < 42**2
        body = skin((columns - cx) / squeeze + 100, (rows - cy) * squeeze + 100)
        pictures.append(picture(np.where(mask[..., None], body, ground(columns - 0.7 * t, rows))))
        masks.append(mask)
    return pictures, np.array(masks), compute_flow(pictures)


def test_outlines_fill_pixels_whose_centre_they_hold():
    """A square from 10 to 29 holds 20 x 20 pixel centres; a second one subtracts; order matters."""
    assert fill_outlines([SQUARE], 40, 50).sum() == 400
    hole = Outline(SQUARE / 2 + 10, subtract=True)
    assert fill_outlines([Outline(SQUARE), hole], 40, 50).sum() < 400
    assert fill_outlines([hole, Outline(SQUARE)], 40, 50).sum() == 400
    assert fill_outlines([SQUARE - 1e9], 40, 50).sum() == 0


def test_key_frames_stay_as_given(crossing):
    """In a key frame the mask is exactly the given one."""
    frames, masks, flow = crossing
    carried = carry_masks(frames, {4: masks[4], 12: [SQUARE]}, flow=flow)
    assert np.array_equal(carried[4], masks[4])
    assert np.array_equal(carried[12], fill_outlines([SQUARE], *masks[0].shape))


def test_carried_masks_beat_plain_shapes(crossing):
    """Between keys 16 frames apart flow carries the mask; plain shape interpolation loses it."""
    frames, masks, flow = crossing
    carried = carry_masks(frames, {0: masks[0], 16: masks[16]}, flow=flow)
    ours = [overlap(carried[t], masks[t]) for t in range(1, 16)]
    plain = [overlap(blend_masks(masks[0], masks[16], 1 - t / 16), masks[t]) for t in range(1, 16) if t != 8]
    assert min(ours) > 0.7
    assert np.mean(ours) > np.mean(plain) + 0.15


def test_flow_alone_holds_the_ends(crossing):
    """One key in the middle gives masks to both ends of the clip."""
    frames, masks, flow = crossing
    carried = carry_masks(frames, {8: masks[8]}, flow=flow)
    assert min(overlap(carried[t], masks[t]) for t in range(4, 13)) > 0.7


def test_an_empty_key_says_absent(crossing):
    """Beside a key without the subject the nearer key decides, and nothing is invented."""
    frames, masks, flow = crossing
    carried = carry_masks(frames, {0: masks[0], 8: [], 16: masks[16]}, flow=flow)
    assert carried[2].any()
    assert carried[14].any()
    assert not carried[7:10].any()
    assert not carry_masks(frames, {0: []}, flow=flow).any()


def test_a_key_is_heard_only_as_far_as_the_next(crossing):
    """A changed key changes nothing beyond its neighbouring keys."""
    frames, masks, flow = crossing
    keys = {t: masks[t] for t in (0, 5, 10, 16)}
    before, after = carry_masks(frames, keys, flow=flow), carry_masks(frames, keys | {5: masks[6]}, flow=flow)
    assert np.array_equal(before[10:], after[10:])
    assert not np.array_equal(before[1:5], after[1:5])


def test_cancel(crossing):
    """A progress callback stops the work; fractions never fall."""
    frames, masks, flow = crossing
    seen = []

    def stop(fraction: float) -> None:
        seen.append(fraction)
        if fraction > 0.4:
            raise Cancelled

    with pytest.raises(Cancelled):
        carry_masks(frames, {0: masks[0], 16: masks[16]}, flow=flow, progress=stop)
    assert seen == sorted(seen)


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({}, "at least one frame"),
        ({17: [SQUARE]}, "frame 17"),
        ({0: np.zeros((3, 3), bool)}, "must be bool"),
        ({0: np.zeros((160, 280), np.uint8)}, "must be bool"),
        ({0: [SQUARE[:2]]}, "three points"),
        ({0: [SQUARE * np.nan]}, "not finite"),
    ],
)
def test_refuses_bad_keys(crossing, keys, says):
    """Keys that cannot be meant are refused in one sentence."""
    frames, _, flow = crossing
    with pytest.raises(InputError, match=says):
        carry_masks(frames, keys, flow=flow)
