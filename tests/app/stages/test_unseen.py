"""What is not seen: points behind something, and depth where the camera only turns."""

from __future__ import annotations

import numpy as np
import pytest

from app.model.frozen import FrozenMap
from app.model.tracks import Track
from app.model.values import Interval
from app.model.world import WorldChoice
from app.stages.animation import _hidden, _seen
from app.stages.assumed import ASSUMED_HEIGHT
from app.stages.worldframe import make_world
from imitation import CameraPath
from imitation.errors import InputError

LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def path(verdict: str) -> CameraPath:
    """Three equal level cameras without recovered points."""
    K = np.array([[900.0, 0, 320], [0, 900, 240], [0, 0, 1]])
    return CameraPath(np.tile(K, (3, 1, 1)), np.tile(LEVEL, (3, 1, 1)), np.zeros((3, 3)), verdict)


@pytest.mark.parametrize("verdict", ["rotation", "static"])
def test_level_ground_without_parallax(verdict: str) -> None:
    """The plane lies below the camera by the assumed height, level, at height 0 of the world, and it is said so."""
    world = make_world(WorldChoice(ground="plane"), path(verdict))
    assert world.grounded
    assert world.depth is None
    assert not world.metric
    assert world.cameras.centres[0, 2] == pytest.approx(ASSUMED_HEIGHT)
    np.testing.assert_allclose(world.normal, [0, 0, 1])
    assert "is assumed" in world.note


def test_no_level_ground_under_a_camera_that_looks_down() -> None:
    """A camera above the subject has no level ground under its horizon: the user is told what to do."""
    with pytest.raises(InputError, match="assume a constant depth"):
        make_world(WorldChoice(ground="plane", from_above=True), path("static"))


def test_hidden_frames_are_no_observations() -> None:
    """Frames said to be hidden carry no position, but for frame 0 and for clicks among them."""
    track = Track("t1", "paw", FrozenMap({0: (1.0, 1.0), 4: (2.0, 2.0)}), occluded=(Interval(0, 1), Interval(3, 5)))
    assert _hidden(track) == (1, 3, 5)
    positions = np.ones((5, 2))
    seen = _seen(positions, _hidden(track))
    assert np.isnan(seen[[1, 3]]).all()
    assert np.isfinite(seen[[0, 2, 4]]).all()
    assert np.isfinite(positions).all()
