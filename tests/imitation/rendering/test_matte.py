"""Characters and shadows on a transparent sheet."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import Camera, InputError
from imitation.rendering import Layer, Look, Rendering, adjusted_look, composite, flattened, grained
from imitation.rendering.light import key_direction


def disc(depth: float, column: int, colour: tuple[int, int, int]) -> Rendering:
    """A disc of one colour with a soft edge, 48 x 64."""
    rows, columns = np.mgrid[:48, :64]
    away = np.hypot(rows - 24, columns - column)
    rgba = np.zeros((48, 64, 4), np.uint8)
    rgba[..., :3] = colour
    rgba[..., 3] = np.clip(255 * (14.5 - away), 0, 255)
    return Rendering(rgba, np.where(rgba[..., 3] > 0, depth, np.inf).astype(np.float32))


def test_the_sheet_laid_over_a_frame_is_the_composite() -> None:
    """Written with its alpha and laid over by another program, the sheet gives our own film to a level or two."""
    frame = np.random.default_rng(0).integers(0, 256, (48, 64, 3), dtype=np.uint8)
    shadow = np.zeros((48, 64), np.float32)
    shadow[30:44, 8:50] = 0.4
    wall = np.where(np.arange(64)[None] < 18, 1.0, 9.0) * np.ones((48, 1))
    layers = [Layer(disc(4.0, 24, (200, 60, 30)), shadow), Layer(disc(3.0, 40, (20, 90, 220)))]
    ours = composite(frame, layers, background=wall, soft=True)
    sheet = flattened(layers, (48, 64), background=wall, soft=True)
    np.testing.assert_array_equal(sheet.over(frame), ours)
    rgba = sheet.rgba().astype(float)
    alpha = rgba[..., 3:] / 255
    theirs = alpha * rgba[..., :3] + (1 - alpha) * frame
    assert np.abs(theirs - ours).max() <= 2


def test_shadow_is_black_and_covers_nothing() -> None:
    """A shadow alone is black, as clear as it is faint; the nearer disc is the one that is seen."""
    shadow = np.full((48, 64), 0.25, np.float32)
    far, near = disc(4.0, 24, (200, 60, 30)), disc(3.0, 34, (20, 90, 220))
    sheet = flattened([Layer(far, shadow), Layer(near)], (48, 64))
    rgba = sheet.rgba()
    np.testing.assert_array_equal(rgba[2, 2], [0, 0, 0, 64])
    np.testing.assert_array_equal(rgba[24, 30], [20, 90, 220, 255])
    np.testing.assert_array_equal(rgba[24, 12], [200, 60, 30, 255])
    assert sheet.cover[2, 2] == 0
    assert sheet.cover[24, 30] == 1


def test_only_what_is_touched_is_worked_on_and_its_edge_is_the_same() -> None:
    """A disc that a wall hides by half, far from the rim of a large picture or cut by it: the same pixels."""
    wall = np.where(np.arange(64)[None] < 22, 1.0, 9.0) * np.ones((48, 1))
    near = flattened([Layer(disc(4.0, 24, (200, 60, 30)))], (48, 64), background=wall, soft=True)
    wide = Rendering(np.zeros((200, 300, 4), np.uint8), np.full((200, 300), np.inf, np.float32))
    wide.rgba[80:128, 100:164], wide.depth[80:128, 100:164] = (
        disc(4.0, 24, (200, 60, 30)).rgba, disc(4.0, 24, (0, 0, 0)).depth,
    )  # fmt: skip
    behind = np.where(np.arange(300)[None] < 122, 1.0, 9.0) * np.ones((200, 1))
    far = flattened([Layer(wide)], (200, 300), background=behind, soft=True)
    np.testing.assert_array_equal(far.alpha[80:128, 100:164], near.alpha)
    np.testing.assert_array_equal(far.light[80:128, 100:164], near.light)
    assert far.alpha.sum() == near.alpha.sum()


def test_nothing_leaves_the_frame_alone() -> None:
    """Without layers the sheet is clear."""
    frame = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    np.testing.assert_array_equal(composite(frame, []), frame)
    assert not flattened([], (5, 7)).rgba().any()


def test_grain_lies_on_characters_alone() -> None:
    """The sheet with noise, laid over a frame, changes what characters cover and nothing else."""
    frame = np.full((48, 64, 3), 128, np.uint8)
    sheet = flattened([Layer(disc(4.0, 24, (120, 110, 100)), np.full((48, 64), 0.3, np.float32))], (48, 64))
    plain, noisy = sheet.over(frame).astype(float), grained(sheet, 4.0, 7).over(frame).astype(float)
    np.testing.assert_array_equal(noisy, grained(sheet, 4.0, 7).over(frame))
    np.testing.assert_array_equal(noisy[sheet.cover == 0], plain[sheet.cover == 0])
    assert (noisy - plain)[sheet.cover == 1].std() == pytest.approx(4.0, rel=0.1)


def test_lights_turned_by_hand() -> None:
    """A quarter turn clockwise brings a light from the south to the west; raised, it keeps its side; factors scale."""
    look = Look(key=(0.0, -1.0, 1.0))
    camera = Camera(np.eye(3), np.eye(3), np.zeros(3))
    turned = adjusted_look(look, camera, turn=90, brightness=2.0, shadow=0.5)
    np.testing.assert_allclose(turned.key, np.array([-1.0, 0.0, 1.0]) / np.sqrt(2), atol=1e-9)
    np.testing.assert_allclose(turned.key_light, 2 * np.array(look.key_light))
    assert turned.shadow == pytest.approx(0.5 * look.shadow)
    raised = adjusted_look(look, camera, lift=15)
    np.testing.assert_allclose(raised.key, [0, -0.5, np.sqrt(0.75)], atol=1e-9)
    assert adjusted_look(look, camera, lift=-80).key[2] == pytest.approx(np.sin(np.radians(5)))
    warm, luma = adjusted_look(look, camera, warmth=0.8), np.array([0.2126, 0.7152, 0.0722])
    ratio = np.array(warm.key_light) / np.array(look.key_light)
    assert ratio[0] > 1.1 > 0.9 > ratio[2], "amber: more red, less blue"
    assert ratio @ luma == pytest.approx(1.0), "as bright as before"
    with pytest.raises(InputError, match="between -1 and 1"):
        adjusted_look(look, camera, warmth=2.0)
    same = adjusted_look(Look(), camera)
    np.testing.assert_allclose(same.key, key_direction(Look(), camera, (0, 0, 1)), atol=1e-12)
    with pytest.raises(InputError, match="finite angles"):
        adjusted_look(look, camera, brightness=-1)
