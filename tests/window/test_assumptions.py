"""What is assumed where the pictures do not tell, contacts by one key, masks that are carried by themselves."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import scene, tracks
from app.window.shell import Shell
from app.window.video.assumptions import Assumptions
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


def type_number(field: object, text: str) -> None:
    """Click a number, type another one, Enter."""
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


@pytest.fixture
def flat(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> Shell:
    """The window, with cameras that only turn: they came from a file and so their verdict is another."""
    project = shell.project
    cameras, result = project.session.stages.cameras, project.result
    path = attrs.evolve(result(cameras), verdict="rotation")
    monkeypatch.setattr(project, "result", lambda stage: path if stage.name == cameras.name else result(stage))
    shell.opened.keeper.automatic = False
    shell.video.refresh()
    return shell


def assumed(shell: Shell) -> Assumptions:
    """The fields of the ground panel."""
    QTest.keyClick(shell, Qt.Key.Key_B)
    settle()
    return shell.video.scene.assumed


def test_how_the_camera_is_held_is_typed_and_reset(shell: Shell) -> None:
    """Pitch, roll and height are edits of their own; the arrow beside each takes the usual again."""
    fields = assumed(shell)
    for field, reset, text, name, usual in (
        (fields.pitch, fields.pitch_reset, "12.5", "pitch", None),
        (fields.roll, fields.roll_reset, "-3", "roll", 0.0),
        (fields.height, fields.height_reset, "1.25", "height", None),
        (fields.depth, fields.depth_reset, "7.5", "depth", None),
    ):
        assert not reset.isEnabled()
        shell.video.scene.ensureWidgetVisible(field)
        type_number(field, text)
        assert getattr(shell.project.document.world, name) == float(text)
        settle()
        assert reset.isEnabled()
        QTest.mouseClick(reset, LEFT)
        assert getattr(shell.project.document.world, name) == usual
        settle()
        assert field.value == field.limits.default
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    settle()
    assert fields.depth.value == 7.5
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)


def test_the_assumed_number_typed_is_given(shell: Shell) -> None:
    """1.6 m is what is assumed and stands there dimmed: typed by hand it is said; clicked and left it is not."""
    fields = assumed(shell)
    shell.opened.keeper.automatic = False
    shell.video.scene.ensureWidgetVisible(fields.height)
    assert fields.height.text() == "1.60 m"
    QTest.mouseClick(fields.height, LEFT)
    QTest.keyClick(fields.height, Qt.Key.Key_Return)
    assert shell.project.document.world.height is None, "looked at, not typed"
    type_number(fields.height, "1.6")
    assert shell.project.document.world.height == 1.6
    settle()
    assert fields.height_reset.isEnabled()
    versions = len(shell.project.session.history.versions)
    type_number(fields.height, "1.6")
    assert len(shell.project.session.history.versions) == versions, "said already"
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)


def test_several_points_are_held_at_a_constant_depth(shell: Shell) -> None:
    """Two points are chosen in the picture and held; the panel names them; none again."""
    fields = assumed(shell)
    shell.opened.keeper.automatic = False
    names = [mark.name for mark in shell.video._marks if mark.at(0) is not None][:2]
    assert not fields.hold.isEnabled()
    shell.video.shown.picked_tracks = tuple(names)
    shell.video.refresh()
    shell.video.scene.ensureWidgetVisible(fields.hold)
    QTest.mouseClick(fields.hold, LEFT)
    world = shell.project.document.world
    assert (world.ground, world.depth_tracks) == ("depth", tuple(names))
    settle()
    assert all(shell.project.document.track(name).name in fields.held.text() for name in names)
    QTest.mouseClick(fields.release, LEFT)
    assert shell.project.document.world.depth_tracks == ()
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)


def test_the_points_of_the_ground_are_dropped_by_a_button(shell: Shell) -> None:
    """Points chosen for the ground are forgotten, the plane stays; undo has them again."""
    shell.opened.keeper.automatic = False
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    drop = shell.video.scene.drop
    assumed(shell)
    assert not drop.isEnabled()
    shell.project.edit(scene.set_ground, "plane", plane_points=points)
    settle()
    QTest.mouseClick(drop, LEFT)
    assert shell.project.document.world.plane_points == ()
    assert shell.project.document.world.ground == "plane"
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert shell.project.document.world.plane_points == tuple(points)
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)


@pytest.mark.parametrize("kind", ["plane", "depth"])
def test_fallbacks_are_offered_in_the_list_of_steps(flat: Shell, kind: str) -> None:
    """A camera that only turns: plane or depth stand in the list; one click takes one and the offer is gone."""
    steps = flat.video.steps
    assert steps.offer.isVisible()
    assert "only turns" in steps.lead.text()
    assert set(steps.fallbacks) == {"plane", "depth"}
    QTest.mouseClick(steps.fallbacks[kind], LEFT)
    assert flat.project.document.world.ground == kind
    settle()
    assert not steps.offer.isVisible()
    flat.project.cancel_work()
    wait_for(lambda: not flat.project.progress)


def test_a_plane_through_points_of_the_scene_is_offered(flat: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a flat scene has recovered points, they can be chosen: the button takes the Ground tool."""
    project = flat.project
    path = attrs.evolve(project.result(project.session.stages.cameras), verdict="planar", points=np.zeros((5, 3)))
    result = project.result
    monkeypatch.setattr(project, "result", lambda stage: path if stage.name == "cameras" else result(stage))
    flat.video.refresh()
    settle()
    fallbacks = flat.video.steps.fallbacks
    assert set(fallbacks) == {"points", "plane", "depth"}
    QTest.mouseClick(fallbacks["points"], LEFT)
    assert flat.video.tool == "ground"
    assert project.document.world.ground == "local", "nothing is decided before points are chosen"


def test_cameras_that_failed_may_be_taken_as_still(flat: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing was solved, a camera on a stand is offered."""
    project = flat.project
    path = attrs.evolve(project.result(project.session.stages.cameras), verdict="failed")
    monkeypatch.setattr(project, "result", lambda stage: path if stage.name == "cameras" else None)
    project.edit(scene.set_camera, "solve")
    settle()
    assert set(flat.video.steps.fallbacks) == {"still"}
    QTest.mouseClick(flat.video.steps.fallbacks["still"], LEFT)
    assert project.document.camera.source == "static"
    settle()
    assert not flat.video.steps.offer.isVisible()


def test_c_in_hand_marks_the_chosen_point_in_this_frame(shell: Shell) -> None:
    """C takes the tool; C again marks the chosen point here, and takes the mark away again; none chosen: a hint."""
    project = shell.project
    track = next(each for each in project.document.tracks if not each.contacts)
    QTest.keyClick(shell, Qt.Key.Key_C)
    QTest.keyClick(shell, Qt.Key.Key_C)
    assert "Choose a point first" in shell.status.hint.text()
    project.select_track(track.id)
    for frame in (4, 5):
        project.show_frame(frame)
        wait_for(lambda frame=frame: shell.video.frame == frame)
        QTest.keyClick(shell, Qt.Key.Key_C)
    (contact,) = project.document.track(track.id).contacts
    assert (contact.span.first, contact.span.last) == (4, 5)
    QTest.keyClick(shell, Qt.Key.Key_C)
    assert project.document.track(track.id).contacts[0].span.last == 4
    assert shell.video.tool == "contact"
    project.cancel_work()


def test_drawn_masks_are_carried_when_nobody_draws_any_more(shell: Shell) -> None:
    """Two lassos in a row start one job, after a pause; without masks there is nothing to carry."""
    project, keeper = shell.project, shell.opened.keeper
    keeper._idle.setTimerType(Qt.TimerType.PreciseTimer)
    keeper._idle.setInterval(60_000)
    square = [(60.0, 40.0), (140.0, 40.0), (140.0, 100.0), (60.0, 100.0)]
    project.edit(scene.add_lasso, 0, square)
    settle(150)
    left = keeper._idle.remainingTime()
    assert 0 < left < 60_000
    project.edit(scene.add_lasso, 10, square)
    assert keeper._idle.remainingTime() > left, "every stroke puts it off"
    labels = {job.label for job in project.progress}
    assert "Carrying the masks" not in labels, "it waits for the last stroke"
    keeper._idle.start(300)
    wait_for(lambda: project.state(project.session.stages.masks) == "fresh", 60)
    wait_for(lambda: not project.progress, 60)
    assert len(project.result(project.session.stages.masks).bits) == project.frame_count
    project.undo()
    project.undo()
    settle(500)
    assert "masks" not in keeper._jobs, "without masks there is nothing to carry"


def test_what_was_asked_for_goes_on_while_points_are_solved_and_named(shell: Shell) -> None:
    """Ctrl+Enter with points, cameras and motion missing; a name is typed meanwhile: all of it is solved in the end."""
    project = shell.project
    project.edit(scene.set_camera, "solve")
    track = project.document.tracks[0]
    x, y = track.clicks[8]
    project.edit(tracks.set_click, track.id, 8, (x + 1.0, y))
    QTest.keyClick(shell, Qt.Key.Key_Return, CONTROL)
    project.edit(tracks.rename_track, track.id, "paw")
    wait_for(lambda: not project.progress, 90)
    stages = project.session.stages
    wanted = (stages.track(track.id), stages.cameras, stages.world, stages.animation(project.character_id))
    assert [project.state(each) for each in wanted] == ["fresh"] * 4
