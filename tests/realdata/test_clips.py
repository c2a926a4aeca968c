"""Two filmed animals move a character: what must hold of the result, without any edited frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.realdata.project import Solved

pytestmark = [pytest.mark.realdata, pytest.mark.slow, pytest.mark.timeout(900)]


def test_dog_moves_a_lion(shared_data: Path, tmp_path: Path) -> None:
    """A handheld clip of a turning dog: parallax is found, the ground comes from it, planted paws stand still."""
    solved = Solved(tmp_path, shared_data, "davis_dog", "lion_sumner_2500", "dog.json")
    cameras = solved.world.cameras
    assert cameras.verdict in ("ok", "planar"), cameras.reason
    assert np.isfinite(cameras.R).all()
    assert np.isfinite(cameras.T).all()
    assert len(cameras) == 60
    assert np.nanmedian(cameras.residuals) < 0.7
    assert solved.world.grounded
    assert solved.motion.vertices.shape[0] == 60
    assert np.isfinite(solved.motion.vertices).all()
    assert solved.slide() < 0.02
    assert solved.stretch() < 2.0
    assert solved.deviation() < 5.0
    travelled = np.linalg.norm(solved.motion.vertices[-1].mean(axis=0) - solved.motion.vertices[0].mean(axis=0))
    assert 0.8 < travelled / solved.diagonal < 2.0, "the dog walks a good body length"
    before, sunk = solved.apart(), solved.sunk()
    solved.pose_first_frame()
    assert solved.apart() < min(6.0, 0.2 * before), "the dog's pose in frame 0 goes through the whole clip"
    assert solved.sunk() < sunk
    assert solved.slide() < 0.02
    assert solved.stretch() < 2.6


def test_camel_moves_a_horse(shared_data: Path, tmp_path: Path) -> None:
    """A camera that only turns: no depth in the pictures, so feet get theirs from an assumed level ground."""
    solved = Solved(tmp_path, shared_data, "davis_camel", "horse_cyberware_2500", "camel.json")
    cameras = solved.world.cameras
    assert cameras.verdict == "rotation", cameras.reason
    assert np.nanmedian(cameras.residuals) < 0.7
    assert "level ground" in solved.world.note
    assert not solved.world.metric
    assert solved.motion.vertices.shape[0] == 90
    assert np.isfinite(solved.motion.vertices).all()
    assert solved.slide() < 0.02
    assert solved.stretch() < 3.2
    assert solved.deviation() < 5.0
    camera = cameras[0].centre
    first, last = (np.linalg.norm(solved.motion.vertices[frame].mean(axis=0) - camera) for frame in (0, -1))
    assert last > 1.1 * first, "the camel walks away from the camera"
    assert "tilted by 4 degrees" in solved.world.note
    before = solved.apart()
    solved.pose_first_frame()
    assert solved.apart() < min(5.0, 0.2 * before), "the camel's pose in frame 0 goes through the whole clip"
    assert solved.stretch() < 2.9
