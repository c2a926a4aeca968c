"""What cannot have depth is said in one sentence before anything is computed."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation import CameraPath, InputError, NoSolution, background_depth
from tests.imitation.depth.conftest import Solved


def one_sentence(error: BaseException) -> str:
    """The message, which must be one sentence."""
    text = str(error)
    assert text.endswith(".")
    assert ". " not in text
    assert "\n" not in text
    return text


@pytest.mark.parametrize(
    ("verdict", "word"),
    [("static", "stands still"), ("rotation", "turns"), ("planar", "flat"), ("failed", "not found")],
)
def test_verdicts_without_depth(solved: Solved, verdict: str, word: str) -> None:
    """The sentence names the cause and what the paper does instead."""
    cameras = attrs.evolve(solved.world.cameras, verdict=verdict)
    with pytest.raises(NoSolution, match=word) as caught:
        background_depth(solved.world.frames, cameras)
    assert "plane through selected points" in one_sentence(caught.value)
    assert "constant depth" in str(caught.value)


def test_cameras_of_another_clip(solved: Solved) -> None:
    """Another number of frames, another size, another path."""
    world = solved.world
    with pytest.raises(InputError, match="15 cameras for 16 frames") as caught:
        background_depth(world.frames, world.cameras[:15])
    one_sentence(caught.value)
    K = world.cameras.K.copy()
    K[:, :2] *= 2
    with pytest.raises(InputError, match="511 x 287 pixels") as caught:
        background_depth(world.frames, CameraPath(K=K, R=world.cameras.R, T=world.cameras.T))
    one_sentence(caught.value)
    turned = CameraPath(K=world.cameras.K, R=world.cameras.R[::-1], T=world.cameras.T[:, [1, 2, 0]])
    with pytest.raises(InputError, match="obey the cameras") as caught:
        background_depth(world.frames, turned, masks=world.masks)
    one_sentence(caught.value)


def test_no_parallax(solved: Solved) -> None:
    """All cameras in one place; or a way too short for the scene."""
    world = solved.world
    still = CameraPath(K=world.cameras.K, R=world.cameras.R, T=np.zeros((16, 3)))
    with pytest.raises(NoSolution, match="one place") as caught:
        background_depth(world.frames, still)
    one_sentence(caught.value)
    same = np.repeat(world.frames[:1], 16, axis=0)
    pose = np.repeat(world.cameras.R[:1], 16, axis=0)
    nudge = np.repeat(world.cameras.T[:1], 16, axis=0)
    nudge[:, 0] += np.linspace(0, 0.5, 16)
    with pytest.raises(NoSolution, match="infinity") as caught:
        background_depth(same, CameraPath(K=world.cameras.K, R=pose, T=nudge))
    one_sentence(caught.value)


def test_masks_over_everything_and_wrong_masks(solved: Solved) -> None:
    """Nothing left to measure; another size; another number."""
    world = solved.world
    with pytest.raises(InputError, match="whole picture") as caught:
        background_depth(world.frames, world.cameras, masks=np.ones((16, 144, 256), bool))
    one_sentence(caught.value)
    with pytest.raises(InputError, match="mask of frame 0") as caught:
        background_depth(world.frames, world.cameras, masks=np.zeros((16, 10, 10), bool))
    one_sentence(caught.value)
    with pytest.raises(InputError, match="3 masks") as caught:
        background_depth(world.frames, world.cameras, masks=world.masks[:3])
    one_sentence(caught.value)


def test_a_clip_too_short_and_frames_that_are_none(solved: Solved) -> None:
    """Two frames; a frame outside the clip; floats instead of bytes; a blank clip."""
    world = solved.world
    with pytest.raises(InputError, match="too few") as caught:
        background_depth(world.frames[:2], world.cameras[:2])
    one_sentence(caught.value)
    with pytest.raises(InputError, match="frames 0 to 15"):
        background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=[16])
    with pytest.raises(InputError, match="uint8"):
        background_depth(world.frames.astype(float), world.cameras)
    with pytest.raises(NoSolution, match="features") as caught:
        background_depth(np.full_like(world.frames, 90), world.cameras)
    one_sentence(caught.value)
