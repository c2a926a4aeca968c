"""The sample world's cameras: sound poses, the styles that they are named after."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import InputError
from resources.world import make_camera
from resources.world.camera import lateral_camera
from tests.support.scenes import walker

STYLES = ["handheld", "passing", "static", "rotation"]


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("azimuth", [90, 35, -50])
def test_the_subject_is_in_the_picture(style: str, azimuth: float) -> None:
    """Rotations are rotations, and nearly all of the subject is in the picture in every frame."""
    walked = walker("quadruped", "stairs")
    cameras = make_camera(walked.centre, walked.body.diagonal, azimuth=azimuth, style=style)  # type: ignore[arg-type]
    np.testing.assert_allclose(cameras.R @ np.swapaxes(cameras.R, 1, 2), np.tile(np.eye(3), (81, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(cameras.R), 1)
    for t in range(0, 81, 8):
        pixels = cameras[t].project(walked.vertices[t])
        inside = (pixels > 0).all(axis=1) & (pixels < [959, 539]).all(axis=1)
        assert inside.mean() > 0.9


@pytest.mark.parametrize("style", STYLES)
def test_styles_move_as_they_say(style: str) -> None:
    """Handheld and passing travel more than a metre, a tripod not at all; only the static one never turns."""
    walked = walker("quadruped", "stairs")
    cameras = make_camera(walked.centre, walked.body.diagonal, style=style)  # type: ignore[arg-type]
    way = np.linalg.norm(np.diff(cameras.centres, axis=0), axis=1).sum()
    assert way > 1 if style in ("handheld", "passing") else way < 1e-9
    turned = np.abs(np.diff(cameras.R, axis=0)).max()
    assert turned < 1e-12 if style == "static" else turned > 1e-3


def test_side_view_is_from_the_right_and_z_is_up() -> None:
    """At azimuth 90 the subject walks to the right of the picture, and up is up."""
    walked = walker("quadruped", "flat")
    camera = make_camera(walked.centre, walked.body.diagonal, style="static")[0]
    assert camera.project(walked.centre[80])[0] > camera.project(walked.centre[0])[0] + 50
    assert camera.project(walked.centre[0] + [0, 0, 0.5])[1] < camera.project(walked.centre[0])[1]
    assert camera.centre[1] < -4


def test_the_lateral_camera_travels_as_asked() -> None:
    """1.3 m sideways with f = 0.9 of the width."""
    cameras = lateral_camera(40)
    assert abs(cameras.centres[-1, 0] - cameras.centres[0, 0] - 1.3) < 0.2
    assert cameras.K[0, 0, 0] == pytest.approx(0.9 * 480)


def test_seeds_repeat() -> None:
    """The same seed gives the same bits, another one another hand."""
    centre = walker("quadruped", "flat").centre
    a, b, c = (make_camera(centre, 1.9, seed=seed) for seed in (4, 4, 5))
    np.testing.assert_array_equal(a.R, b.R)
    assert np.abs(a.R - c.R).max() > 1e-3


def test_an_unknown_style_is_refused() -> None:
    """The message names the styles."""
    with pytest.raises(InputError, match="handheld, passing, static or rotation"):
        make_camera(np.zeros((3, 3)), 1.0, style="drone")  # type: ignore[arg-type]
