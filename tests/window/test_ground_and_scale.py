"""Ground and scale from the recovered scene, its evidence over the picture, and the layers that are remembered."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.window import settings
from app.window.camera_evidence import evidence, ground_grid, horizon, spacing_for
from app.window.canvas.scene_layers import grade
from app.window.shell import Shell
from app.window.video.scene_picking import picked
from imitation import CameraPath
from imitation.geometry import Camera
from tests.window.conftest import at, settle, wait_for

LEFT = Qt.MouseButton.LeftButton
K = np.array([[500.0, 0, 160], [0, 500, 90], [0, 0, 1]])
LEVEL = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


def test_residuals_are_those_of_the_frame() -> None:
    """A point seen 3 pixels beside its projection has that residual; points that were not followed have none."""
    points = np.array([[0.0, 5, 0], [1, 6, 0], [0, -5, 0]])
    path = CameraPath(K=K[None], R=LEVEL[None], T=np.array([[0.0, 1.5, 0]]), points=points)
    places = path[0].project(points[:2])
    seen = attrs.evolve(
        path,
        observations=np.column_stack([[0, 0], np.add(places, [[0, 0], [3, 0]])]),
        observed=np.array([0, 1], np.int32),
    )
    assert np.allclose(evidence(seen, 0).residuals, [0, 3])
    assert evidence(path, 0).index.tolist() == [0, 1], "what is behind the camera is not seen"
    assert np.isnan(evidence(path, 0).residuals).all()
    assert evidence(None, 0).nearest((0, 0), 10) == -1
    assert grade(np.array([0.1, 0.7, 2.0, np.nan])).tolist() == [0, 1, 2, 0]


def test_the_grid_lies_on_the_ground_and_ends_at_the_horizon() -> None:
    """Places of the grid, lifted to the ground again, lie on multiples of the spacing, none above the horizon."""
    camera = Camera(K, LEVEL, -LEVEL @ np.array([0.3, 0, 1.5]))
    line = horizon(camera, (320, 180))
    assert line is not None
    assert np.allclose(line[:, 1], 90), "a level camera sees the horizon through its centre"
    lines, step = ground_grid(camera, 0.0, (320, 180))
    assert step == spacing_for(np.hypot(1.5, 1.5 * 500 / (0.78 * 180 - 90)))
    for each in lines:
        known = each[np.isfinite(each[:, 0])]
        assert (known[:, 1] > 90).all()
        rays = camera.rays(known)
        ground = camera.centre - camera.centre[2] / rays[:, 2:] * rays
        off = np.abs(ground[:, :2] / step - np.round(ground[:, :2] / step))
        assert min(off[:, 0].max(initial=0), off[:, 1].max(initial=0)) < 1e-6
    up = Camera(K, LEVEL @ np.diag([1.0, -1, -1]), np.zeros(3))
    assert ground_grid(up, -1.0, (320, 180))[0] == []


def test_choices_are_added_and_taken_away() -> None:
    """The order of choosing stays; new forgets, subtract removes."""
    assert picked((3, 1), [5, 1], "new") == (5, 1)
    assert picked((3, 1), [5, 1], "add") == (3, 1, 5)
    assert picked((3, 1, 5), [1], "subtract") == (3, 5)


@pytest.fixture
def scenery(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> Shell:
    """The window, with recovered points on the ground: the true cameras of the sample come without any."""
    shell.opened.keeper.automatic = False
    project = shell.project
    cameras, result = project.session.stages.cameras, project.result
    path = result(cameras)
    grid = np.array([[x, y, 0.0] for x in np.linspace(-2, 2, 9) for y in np.linspace(-2, 2, 9)])
    known = attrs.evolve(path, points=grid)
    worlds = project.session.stages.world.name

    def read(stage: object) -> object:
        found = known if stage.name == cameras.name else result(stage)
        return attrs.evolve(found, depth=None) if stage.name == worlds and found is not None else found

    monkeypatch.setattr(project, "result", read)
    return shell


def seen(shell: Shell) -> list[tuple[int, tuple[float, float]]]:
    """Recovered points inside the picture, far from tracks: index and widget place."""
    found = evidence(shell.project.result(shell.project.session.stages.cameras), 0)
    view, canvas = shell.video.canvas.view, shell.video.canvas
    tracks = [view.point(*place) for mark in shell.video._marks if (place := mark.at(0)) is not None]
    return [
        (int(index), (x, y))
        for index, (x, y) in zip(found.index, view.to_widget(found.places), strict=True)
        if 0 < x < canvas.width() and 0 < y < canvas.height()
        if all(np.hypot(x - a, y - b) > 24 for a, b in tracks)
    ]


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_ground_and_length_from_points_clicked_in_the_picture(scenery: Shell) -> None:
    """B, three clicks, one button: the ground; two left, metres typed, one button: a length. Each one entry."""
    shell = scenery
    QTest.keyClick(shell, Qt.Key.Key_B)
    settle()
    assert shell.video.scene.isVisible()
    assert not shell.video.inspector.isVisible()
    points = seen(shell)
    assert len(points) >= 3
    chosen = [points[0], points[len(points) // 2], points[-1]]
    for _, place in chosen:
        QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place))
    assert shell.video.shown.picked == tuple(index for index, _ in chosen)
    assert not shell.video.scene.scale.isEnabled()
    entries = len(shell.project.session.history.versions)
    QTest.mouseClick(shell.video.scene.lay, LEFT)
    assert len(shell.project.document.world.plane_points) == 3
    assert shell.project.document.world.ground == "plane"
    QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*chosen[2][1]))
    assert shell.video.scene.scale.isEnabled()
    shell.video.scene.metres.set_value(2.5)
    QTest.mouseClick(shell.video.scene.scale, LEFT)
    length = shell.project.document.world.length
    assert length.metres == 2.5
    assert len(shell.project.session.history.versions) == entries + 2
    assert shell.project.session.history.undo_label == "Set a length of 2.5 m"
    QTest.mouseClick(shell.video.scene.clear, LEFT)
    assert shell.video.shown.picked == ()
    wait_for(lambda: not shell.project.progress)
    QTest.keyClick(shell, Qt.Key.Key_V)
    assert shell.video.inspector.isVisible()


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_a_length_between_two_tracks_and_what_to_assume(scenery: Shell) -> None:
    """Two tracks are clicked and measured; the assumptions are offered in the same place."""
    shell = scenery
    QTest.keyClick(shell, Qt.Key.Key_B)
    settle()
    view = shell.video.canvas.view
    places = [(mark.name, view.point(*mark.at(0))) for mark in shell.video._marks if mark.at(0) is not None]
    first = places[0]
    second = max(places, key=lambda each: np.hypot(each[1][0] - first[1][0], each[1][1] - first[1][1]))
    for _, place in (first, second):
        QTest.mouseClick(shell.video.canvas, LEFT, pos=at(*place))
    assert shell.video.shown.picked_tracks == (first[0], second[0])
    QTest.mouseClick(shell.video.scene.scale, LEFT)
    assert shell.project.document.world.seen.tracks == (first[0], second[0])
    QTest.mouseClick(shell.video.scene.grounds["depth"], LEFT)
    assert shell.project.document.world.ground == "depth"
    wait_for(lambda: not shell.project.progress)


@pytest.mark.window
@pytest.mark.slow
@pytest.mark.xdist_group("window")
def test_evidence_and_grid_are_layers_that_are_remembered(scenery: Shell) -> None:
    """Alt+5 and Alt+6 draw points and grid; the next window has them too."""
    shell = scenery
    bare = shell.video.canvas.grab().toImage()
    QTest.keyClick(shell, Qt.Key.Key_5, Qt.KeyboardModifier.AltModifier)
    settle()
    dots = shell.video.canvas.grab().toImage()
    assert dots != bare
    QTest.keyClick(shell, Qt.Key.Key_6, Qt.KeyboardModifier.AltModifier)
    settle()
    assert shell.video.canvas.grab().toImage() != dots
    assert settings.settings().value("video/grid") in (True, "true")
    for key in (Qt.Key.Key_5, Qt.Key.Key_6):
        QTest.keyClick(shell, key, Qt.KeyboardModifier.AltModifier)
    settle()
    assert shell.video.canvas.grab().toImage() == bare
