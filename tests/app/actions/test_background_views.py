"""What is shown of a measured background, and points put onto it, on planes of known depth."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from app.actions.background_views import BackgroundViews, certainty
from app.actions.snapping import snap
from imitation import NoSolution
from imitation.cameras import CameraPath
from imitation.depth import Background, DepthMap
from imitation.geometry import Camera

SIZE = (160, 90)
K = np.array([[150.0, 0, 79.5], [0, 150, 44.5], [0, 0, 1]])
LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def ground_depth(camera: Camera) -> np.ndarray:
    """Exact camera z (h, w) of the ground z = 0, NaN above the horizon."""
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]].astype(float)
    rays = camera.rays(np.stack([columns, rows], axis=-1))
    with np.errstate(divide="ignore", invalid="ignore"):
        far = -camera.centre[2] / rays[..., 2]
    points = camera.centre + far[..., None] * rays
    depth = camera.depth(points)
    return np.where((far > 0) & (depth < 30), depth, np.nan)


@pytest.fixture
def views(monkeypatch: pytest.MonkeyPatch) -> BackgroundViews:
    """Views of a ground seen by a camera 1.5 m above it that moves sideways, three key frames of five."""
    count = 5
    R = np.tile(LEVEL, (count, 1, 1))
    T = np.stack([-LEVEL @ np.array([0.1 * t, 0, 1.5]) for t in range(count)])
    path = CameraPath(K=np.tile(K, (count, 1, 1)), R=R, T=T)
    frames = np.full((count, SIZE[1], SIZE[0], 3), 120, np.uint8)
    maps = []
    for t in (0, 2, 4):
        depth = ground_depth(path[t]).astype(np.float32)
        maps.append(DepthMap(t, depth, np.where(np.isfinite(depth), 2, 0).astype(np.uint8), path[t]))
    world = SimpleNamespace(metric=True)
    known = Background(list(frames), path, maps)
    monkeypatch.setattr("app.actions.backgrounds.solved_background", lambda session: (known, world))
    session: Any = None
    return BackgroundViews(session)


def test_depth_runs_from_near_to_far_as_its_legend_says(views: BackgroundViews) -> None:
    """A pixel has the colour that the legend gives to its distance; unknown is grey; a frame between is projected."""
    legend = views.legend("depth")
    assert legend is not None
    near, middle, far = (float(text.removesuffix(" m")) for _, text in legend.ticks)
    assert near < middle < far
    assert np.isclose(2 / middle, 1 / near + 1 / far, rtol=0.02), "half way is half way in inverse depth"
    shown = views.view("depth", 2)
    depth = ground_depth(views.known.camera(2))
    row, column = np.argwhere(np.abs(depth - middle) < 0.02 * middle)[0]
    colour, wanted = shown.picture[row, column].astype(int), legend.colours[0, 64].astype(int)
    assert np.abs(colour - wanted).max() < 16
    assert (shown.picture[0, 0] == 70).all()
    between = views.view("depth", 1).picture
    lower = slice(60, 88), slice(10, 150)
    assert np.abs(between[lower].astype(int) - views.view("depth", 0).picture[lower]).max() < 12
    assert "% of the picture measured" in shown.note


def test_confidence_has_a_colour_for_each_number_of_frames(views: BackgroundViews) -> None:
    """None is violet, as many as there are is yellow, unknown grey; the legend has the same ends."""
    legend = views.legend("confidence")
    assert legend is not None
    assert legend.ticks[-1][1] == "2 or more"
    shown = views.view("confidence", 0).picture
    assert (shown[0, 0] == 70).all()
    np.testing.assert_array_equal(shown[80, 80], legend.colours[0, -1])
    made = certainty(np.array([[0, 9]], np.uint8), np.array([[True, True]]), 3)
    assert made[0, 0, 2] > made[0, 0, 1]
    assert made[0, 1, 1] > made[0, 1, 2]


def test_a_plate_without_a_mask_is_the_frame(views: BackgroundViews) -> None:
    """Nothing is filled where nothing hides; a plate's colours need no legend."""
    shown = views.view("plate", 1)
    assert (shown.picture == 120).all()
    assert shown.invented is None
    assert "nothing is masked" in shown.note
    assert views.legend("plate") is None


def test_a_point_snaps_onto_the_ground_between_pixels(views: BackgroundViews) -> None:
    """The place is exact to a millimetre, its disc lies on the ground around it; above the horizon there is none."""
    surface = views.surface(2)
    camera = views.known.camera(2)
    true = np.array([0.35, 7.2, 0.0])
    found = snap(surface, camera.project(true))
    assert np.linalg.norm(found.place - true) < 2e-3
    assert np.isclose(found.depth, camera.depth(true), atol=2e-3)
    assert found.residual < 2e-3
    rays = camera.rays(found.disc)
    on_ground = camera.centre - camera.centre[2] / rays[:, 2:] * rays
    away = np.linalg.norm(on_ground - true, axis=1)
    assert np.allclose(away, 0.03 * found.depth, rtol=0.1), "a round on the ground, seen from the side"
    for place, reason in (((80.0, 2.0), "No background depth"), ((80.0, 200.0), "Outside the picture")):
        with pytest.raises(NoSolution, match=reason):
            snap(surface, place)
