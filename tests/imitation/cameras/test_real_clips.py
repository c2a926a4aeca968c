"""Cameras of filmed clips: every frame posed, small residuals, the right verdict."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imitation.cameras import CameraPath, solve_cameras

pytestmark = [pytest.mark.realdata, pytest.mark.slow]


def solve(folder: Path) -> CameraPath:
    """The cameras of a clip in the shared data, the subject masked where there are masks."""
    import av
    import cv2

    with av.open(str(folder / "clip.mp4")) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    files = sorted((folder / "masks").glob("*.png"))
    masks = [cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) > 0 for file in files] or None
    return solve_cameras(frames, masks=masks)


@pytest.mark.parametrize("name", ["davis_dog", "davis_libby"])
def test_every_frame_of_a_clip_with_parallax_is_posed(shared_data: Path, name: str) -> None:
    """Verdict ok, no frame interpolated, mean residual 0.7 px."""
    path = solve(shared_data / name)
    assert path.verdict == "ok", path.reason
    assert np.isfinite(path.residuals).all()
    assert path.residuals.mean() < 0.7


def test_a_way_over_a_wall_keeps_its_scale(shared_data: Path) -> None:
    """davis_parkour: the camera runs on evenly where what is near changes; the steps were 60 times as long from there.

    Small residuals alone do not tell: points near by had been thrown away.
    """
    path = solve(shared_data / "davis_parkour")
    assert path.verdict == "ok", path.reason
    assert path.residuals.mean() < 0.7
    steps = np.linalg.norm(np.diff(path.centres, axis=0), axis=1)
    assert steps.max() < 3 * np.median(steps)
    assert steps.min() > np.median(steps) / 4


def test_a_camera_that_almost_only_turns_is_called_so(shared_data: Path) -> None:
    """davis_camel: rotation, every frame within 1 px."""
    path = solve(shared_data / "davis_camel")
    assert path.verdict == "rotation", path.reason
    assert path.residuals.max() < 1


def test_a_camera_over_a_blank_floor_is_static(shared_data: Path) -> None:
    """mouse_openfield: the mouse, its shadow and noise move, the camera does not."""
    assert solve(shared_data / "mouse_openfield").verdict == "static"
