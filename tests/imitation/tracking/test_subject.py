"""The subject on plain ground: what masks do for thin limbs."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.tracking import prepare_clip, track_point
from imitation.tracking.chain import Chain
from imitation.tracking.flow import PairFlow
from imitation.tracking.judge import judge
from imitation.tracking.subject import cut_out, plain_grey, subject_flow
from imitation.tracking.track import SpanPlan
from tests.imitation.tracking.worlds import Texture, picture


def limb(frames: int = 17, seed: int = 3, size: tuple[int, int] = (160, 240)):
    """A bar 9 pixels wide that swings before a textured background that goes the other way; a point on it.

    Returns frames, masks and the point's true path (n, 2).
    """
    coat, ground = Texture(seed), Texture(seed + 100)
    rows, columns = np.arange(size[0], dtype=float), np.arange(size[1], dtype=float)
    pictures, masks, path = [], [], []
    for t in range(frames):
        x, y = 60 + 6.5 * t + 0.3, 70 + 12 * np.sin(2 * np.pi * t / 16)
        inside = (np.abs(columns - x)[None] <= 4.5) & (np.abs(rows - y)[:, None] <= 32)
        shown = np.where(inside[..., None], coat(columns - x, rows - y), ground(columns + 5.0 * t, rows))
        pictures.append(picture(shown))
        masks.append(inside)
        path.append((x, y + 20))
    return pictures, masks, np.array(path)


@pytest.fixture(scope="module")
def world():
    """One swinging limb."""
    return limb()


def test_a_thin_limb_is_followed_where_masks_say_what_it_is(world) -> None:
    """Within a pixel on the mean with masks; the background takes the point away without them."""
    frames, masks, path = world
    clicks = {0: tuple(path[0]), 16: tuple(path[16])}
    held = np.hypot(*(track_point(frames, clicks, mask=masks).positions - path).T)
    alone = np.hypot(*(track_point(frames, clicks).positions - path).T)
    assert held.mean() < 1
    assert held.mean() < 0.5 * alone.mean()


def test_a_mask_changes_nothing_for_the_printed_method(world) -> None:
    """The mode "paper" looks at the whole picture."""
    frames, masks, path = world
    clicks = {0: tuple(path[0]), 4: tuple(path[4])}
    found = [track_point(frames[:5], clicks, mode="paper", mask=m).positions for m in (None, masks[:5])]
    np.testing.assert_array_equal(*found)


def test_the_same_bits_on_repeat(world) -> None:
    """Masks, like all else, give the same track twice."""
    frames, masks, path = world
    first, second = (track_point(frames, {0: tuple(path[0])}, mask=masks) for _ in range(2))
    np.testing.assert_array_equal(first.positions, second.positions)


def test_cut_out_keeps_the_subject_and_paints_the_rest(world) -> None:
    """Inside hardly anything changes, some pixels away all is plain; the plain is far from the subject's brightness."""
    frames, masks, _ = world
    mask = masks[3].view(np.uint8)
    shown = cut_out(frames[3], mask, 255)
    np.testing.assert_allclose(shown[masks[3]].astype(float), frames[3][masks[3]], atol=5)
    assert (shown[:, :50] == 255).all()
    assert plain_grey([np.full((4, 4, 3), 200, np.uint8)] * 2, [np.ones((4, 4), bool)] * 2) == 0
    assert plain_grey([np.full((4, 4, 3), 50, np.uint8)] * 2, [np.ones((4, 4), bool)] * 2) == 255


def test_flow_of_the_subject_alone(world) -> None:
    """On the limb the flow is its own and not the background's; there is none without a subject."""
    frames, masks, path = world
    clip = prepare_clip(frames, masks=masks)
    move = path[5] - path[4]
    shown = clip.subject_flow(4, 5).view(np.float16).astype(float)[masks[4]]
    plain = clip.flow(4, 5).view(np.float16).astype(float)[masks[4]]
    assert np.median(np.abs(shown - move).sum(axis=1)) < 0.5 * np.median(np.abs(plain - move).sum(axis=1))
    grey = clip.look_greys(0)[0]
    nothing = subject_flow(PairFlow(), grey, grey, np.zeros(grey.shape, bool))
    assert not nothing[0].any()
    assert not nothing[1].any()


def test_confidence_falls_where_the_subject_does_not_look_like_the_clicks() -> None:
    """With masks a frame that looks unlike the clicks is doubted, at the same cost of the span."""
    flat = np.zeros(21)
    likeness = np.where(np.arange(21) < 10, 0.95, 0.4)
    chain = Chain(np.full((21, 2), 50.0), flat + 0.1, likeness, flat, flat, flat.astype(bool))
    span = judge(SpanPlan((0, 50.0, 50.0), (20, 50.0, 50.0), 0, 20), chain, (100, 100), True, masked=True)
    assert span.confidence[8] > 0.9
    assert span.confidence[12] < 0.75
    assert span.confidence[[0, 20]].tolist() == [1, 1]
