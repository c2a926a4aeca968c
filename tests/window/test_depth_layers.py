"""The measured background over the picture, measuring on request, and contacts put onto its surface."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.model.edits import contacts, scene
from app.stages.results import Masks
from app.window import settings
from app.window.shell import Shell
from imitation.errors import NoSolution
from tests.window.clipping import assert_nothing_clipped
from tests.window.conftest import at, drag, hover, settle, wait_for
from tests.window.measured import measure
from tests.window.small_project import SIZE, small_clip

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
ALT = Qt.KeyboardModifier.AltModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture(autouse=True)
def usual_layers(qapp: object) -> Iterator[None]:
    """What is remembered of the layers between runs is forgotten."""
    yield
    kept = settings.settings()
    for name in ("", "_kind", "_opacity", "_wipe", "_line"):
        kept.remove(f"video/background{name}")


@pytest.fixture
def measured(session: Session, request: pytest.FixtureRequest) -> Shell:
    """The window on a project whose background is measured."""
    measure(session)
    shell: Shell = request.getfixturevalue("shell")
    shell.opened.keeper.automatic = False
    return shell


def go(shell: Shell, frame: int) -> None:
    """Show a frame and wait for its picture."""
    shell.project.show_frame(frame)
    wait_for(lambda: shell.video.frame == frame)
    settle()


def show_background(shell: Shell, kind: str) -> Any:
    """Switch the layer on by its key, choose what it shows with the mouse, wait for it."""
    if not shell.video.shown.background:
        QTest.keyClick(shell, Qt.Key.Key_7, ALT)
    QTest.mouseClick(shell.video.background.bar.kinds[kind], LEFT)
    # The first one is computed, and on a new machine its kernels are compiled before that.
    wait_for(lambda: shell.video.shown.backdrop is not None, 90)
    settle()
    return shell.video.shown.backdrop


def pixel(shell: Shell, x: float, y: float) -> QColor:
    """The colour on the screen at a picture place."""
    place = at(*shell.video.canvas.view.point(x, y))
    return shell.video.canvas.grab().toImage().pixelColor(place)


def test_depth_lies_over_the_frame_with_a_legend(measured: Shell) -> None:
    """Alt+7: near is red, far is blue, by the true distances; the legend names both ends; opacity is typed."""
    QTest.keyClick(measured, Qt.Key.Key_O)
    go(measured, 8)
    backdrop = show_background(measured, "depth")
    field = measured.video.background.bar.opacity
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, "100")
    QTest.keyClick(field, Qt.Key.Key_Return)
    settle()
    depth = small_clip().depth(8)
    z = np.where(np.isfinite(depth), depth, 0.0)
    near = np.unravel_index(np.argmin(np.where(z > 0, z, np.inf)), z.shape)
    far = np.unravel_index(np.argmax(np.where(z < 40, z, 0.0)), z.shape)
    close, away = pixel(measured, near[1], near[0] - 2), pixel(measured, far[1], far[0])
    assert close.red() > close.blue()
    assert away.blue() > away.red()
    first, *_, last = (text for _, text in backdrop.scale.ticks)
    assert first.endswith(" m") == measured.project.result(measured.project.session.stages.world).metric
    assert float(first.split()[0]) < float(last.split()[0])
    assert "measured" in measured.video.background.bar.note.text()
    go(measured, 9)
    wait_for(lambda: measured.video.shown.backdrop is not None)
    assert measured.video.shown.backdrop.picture != backdrop.picture, "a frame between key frames has its own"
    QTest.keyClick(measured, Qt.Key.Key_7, ALT)
    settle()
    assert measured.video.shown.backdrop is None
    assert not measured.video.background.bar.isVisible()


def test_the_wipe_is_dragged_over_the_frame(measured: Shell) -> None:
    """Left of the line is the film, right of it the layer; the mouse drags the line, with any tool in hand."""
    QTest.keyClick(measured, Qt.Key.Key_O)
    QTest.keyClick(measured, Qt.Key.Key_L, CONTROL)
    QTest.keyClick(measured, Qt.Key.Key_L, CONTROL)
    show_background(measured, "confidence")
    QTest.mouseClick(measured.video.background.bar.wipe, LEFT)
    QTest.keyClick(measured, Qt.Key.Key_M)
    canvas, versions = measured.video.canvas, len(measured.project.session.history.versions)
    line = measured.video.shown.backdrop.wipe
    start = canvas.view.point(line, 90)
    hover(canvas, at(*start))
    settle()
    assert canvas.cursor().shape() == Qt.CursorShape.SplitHCursor
    end = canvas.view.point(240, 60)
    drag(canvas, start, end)
    settle()
    assert abs(measured.video.shown.backdrop.wipe - 240) < 1.5
    film = QColor(canvas.picture.pixel(200, 120))
    assert abs(pixel(measured, 200, 120).red() - film.red()) < 12
    yellow = pixel(measured, 290, 150)
    assert yellow.red() > 150
    assert yellow.green() > 150
    assert yellow.blue() < 130
    assert len(measured.project.session.history.versions) == versions, "how one looks at it is no edit"
    assert not measured.project.document.masks


def test_the_plate_shows_what_is_behind_the_subject(
    session: Session, small_project: Any, request: pytest.FixtureRequest
) -> None:
    """With masks the subject is gone from the plate; how much other frames saw is said."""
    corner = [(2.0, 2.0), (40.0, 2.0), (40.0, 40.0)]
    session.apply(scene.add_lasso(session.document, 0, corner))
    session.cache.put(session.stages.masks, Masks.pack(small_clip().masks()))
    measure(session)
    shell: Shell = request.getfixturevalue("shell")
    shell.opened.keeper.automatic = False
    go(shell, 16)
    backdrop = show_background(shell, "plate")
    assert "seen in other frames" in shell.video.background.bar.note.text()
    mask = small_clip().mask(16)
    film = np.array(small_clip().frames[16], int)
    bits = backdrop.picture.convertToFormat(backdrop.picture.Format.Format_RGB888)
    plate = np.array(bits.constBits()).reshape(bits.height(), bits.bytesPerLine())[:, : 3 * SIZE[0]]
    off = np.abs(plate.reshape(*SIZE[::-1], 3).astype(int) - film).max(-1)
    assert np.median(off[mask]) > 20, "the subject is replaced"
    assert np.median(off[~mask]) < 8


def test_measuring_is_a_step_with_progress_and_cancel(shell: Shell) -> None:
    """Unmeasured: the step has a button and the layer says so; the job runs, is cancelled, and leaves nothing."""
    project, video = shell.project, shell.video
    QTest.keyClick(shell, Qt.Key.Key_7, ALT)
    settle()
    assert "not been measured" in video.background.bar.note.text()
    row = next(row for row in video.steps._rows if row[1].text() == "Background")
    assert row[3].isVisible()
    QTest.mouseClick(row[3], LEFT)
    wait_for(lambda: "being measured" in row[2].text())
    assert video.background.bar.action.text() == "Stop"
    assert video.background.bar.progress.isVisible()
    assert shell.bar.job.isVisible()
    QTest.mouseClick(video.background.bar.action, LEFT)
    wait_for(lambda: not project.progress)
    settle()
    assert project.state(project.session.stages.depth) == "missing"
    assert video.background.bar.action.text() == "Measure the background"


def test_what_a_film_has_measured_is_under_way_too(shell: Shell) -> None:
    """Where something else needs the depth and has it measured, the list of steps says so, with its share."""
    project, video = shell.project, shell.video
    job = project.start("Rendering", project.session.stages.plate(0))
    row = next(row for row in video.steps._rows if row[1].text() == "Background")
    wait_for(lambda: "being measured, " in row[2].text(), 60)
    assert row[2].text().endswith("%")
    assert not row[3].isVisible(), "it is not this list that stops a film"
    job.cancel()
    wait_for(lambda: not project.progress)
    settle()
    assert "being measured" not in row[2].text()


def test_what_cannot_be_measured_gives_its_reason_and_what_to_do_instead(
    shell: Shell, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No parallax: one sentence in the list of steps, and plane or constant depth as buttons that are edits."""
    project = shell.project
    shell.opened.keeper.automatic = False
    reason = "All cameras stand in one place, so that there is no parallax: lay a plane or assume a constant depth."

    def refuse(*_: object, **__: object) -> None:
        raise NoSolution(reason)

    monkeypatch.setattr("app.stages.depth._solver", refuse)
    shell.video.background.ask("measure")
    wait_for(lambda: not project.progress)
    settle()
    assert shell.video.errors.isVisible()
    assert shell.video.errors.sentence.text() == reason
    steps = shell.video.steps
    assert steps.lead.text() == reason
    assert {"plane", "depth"} <= set(steps.fallbacks)
    QTest.mouseClick(steps.fallbacks["plane"], LEFT)
    assert project.document.world.ground == "plane"
    project.cancel_work()
    wait_for(lambda: not project.progress)


def anchored(shell: Shell) -> tuple[Any, int, tuple[float, float]]:
    """A track with a contact, a frame of it, and where it is in the picture."""
    for track in shell.project.document.tracks:
        for contact in track.contacts:
            for frame in range(contact.span.first, contact.span.last + 1):
                place = shell.video.reading.track(track).positions[frame]
                if np.isfinite(place).all():
                    return track, frame, (float(place[0]), float(place[1]))
    raise AssertionError("no contact in the small project")


def true_ground(pixel: tuple[float, float], frame: int) -> np.ndarray:
    """Where a pixel's ray meets the flat ground of the world that was filmed."""
    camera = small_clip().cameras[frame]
    ray = camera.rays(np.array(pixel))
    return camera.centre - camera.centre[2] / ray[2] * ray


def test_an_anchor_is_dragged_over_the_surface(measured: Shell) -> None:
    """With the contact tool a preview follows the mouse; let go, the contact lies there: one entry; undo, and Esc."""
    track, frame, place = anchored(measured)
    go(measured, frame)
    project, canvas = measured.project, measured.video.canvas
    before = next(each for each in track.contacts if frame in each.span).place
    QTest.keyClick(measured, Qt.Key.Key_C)
    start = canvas.view.point(*place)
    hover(canvas, at(*start))
    wait_for(lambda: measured.video.shown.snap is not None and measured.video.shown.snap.disc is not None)
    assert "away" in measured.video.shown.snap.text, "hovering says where it would lie"
    versions = len(project.session.history.versions)
    end = (start[0] + 60, start[1] + 12)
    drag(canvas, start, end, release=False)
    settle()
    preview = measured.video.shown.snap
    assert "±" in preview.text
    assert preview.before is not None
    assert len(project.session.history.versions) == versions
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    assert next(each for each in project.document.track(track.id).contacts if frame in each.span).place == before
    QTest.mouseRelease(canvas, LEFT, pos=at(*end))
    drag(canvas, start, end)
    settle()
    assert len(project.session.history.versions) == versions + 1
    assert project.session.history.undo_label == f"Place contact of {track.name}, frame {frame}"
    contact = next(each for each in project.document.track(track.id).contacts if frame in each.span)
    x, y = canvas.view.to_picture(np.round(end))
    shift = np.array(place) - canvas.view.to_picture(np.round(start))
    wanted = true_ground((x + shift[0], y + shift[1]), frame)
    assert np.linalg.norm(np.array(contact.place) - wanted) < 0.03, "on the ground below the mouse, within 3 cm"
    QTest.keyClick(measured, Qt.Key.Key_Z, CONTROL)
    assert next(each for each in project.document.track(track.id).contacts if frame in each.span).place == before
    project.cancel_work()
    wait_for(lambda: not project.progress)


def test_s_puts_the_contact_where_the_point_is_seen(measured: Shell) -> None:
    """The key does it without the mouse, the inspector says where it lies, the arrow leaves it to the ground again."""
    track, frame, place = anchored(measured)
    go(measured, frame)
    project = measured.project
    project.select_track(track.id)
    settle()
    info = measured.video.inspector.contact_info
    assert info.isVisible()
    assert "put there by hand" in info.text.text()
    QTest.keyClick(measured, Qt.Key.Key_C)
    wait_for(lambda: "the measured surface" in info.text.text())
    QTest.keyClick(measured, Qt.Key.Key_S)
    wait_for(lambda: project.session.history.undo_label == f"Place contact of {track.name}, frame {frame}")
    contact = next(each for each in project.document.track(track.id).contacts if frame in each.span)
    assert np.linalg.norm(np.array(contact.place) - true_ground(place, frame)) < 0.02
    measured.project.start("Placing contacts", project.session.stages.contacts(track.id))
    wait_for(lambda: not project.progress, 60)
    wait_for(lambda: "; on the measured surface" in info.text.text() or "; 1 mm" in info.text.text())
    measured.video.inspector.ensureWidgetVisible(info.free)
    QTest.mouseClick(info.free, LEFT)
    assert next(each for each in project.document.track(track.id).contacts if frame in each.span).place is None
    settle()
    assert not info.free.isEnabled()
    project.cancel_work()
    wait_for(lambda: not project.progress)


def test_a_new_contact_is_marked_by_dragging_it_onto_the_surface(measured: Shell) -> None:
    """A point without a contact gets one of this frame; above the horizon there is no surface and nothing happens."""
    go(measured, 4)
    project, canvas = measured.project, measured.video.canvas
    marks = [mark for mark in measured.video._marks if mark.at(4) is not None and not mark.contact]
    mark = max(marks, key=lambda each: each.at(4)[1])
    start = canvas.view.point(*mark.at(4))
    measured.do("tool_contact")
    hover(canvas, at(*start))
    wait_for(lambda: measured.video.background.surface(4) is not None)
    sky = canvas.view.point(mark.at(4)[0], 2)
    known = np.isfinite(small_clip().depth(4)[0, round(mark.at(4)[0])])
    versions = len(project.session.history.versions)
    if not known:
        drag(canvas, start, sky)
        assert len(project.session.history.versions) == versions
        assert "No background depth" in measured.status.hint.text()
    drag(canvas, start, (start[0] + 10, start[1] + 30))
    assert project.session.history.undo_label == f"Mark contact of {mark.title}, frame 4"
    (contact,) = [each for each in project.document.track(mark.name).contacts if 4 in each.span]
    assert contact.place is not None
    project.cancel_work()
    wait_for(lambda: not project.progress)


def test_contacts_are_put_onto_the_measured_background(measured: Shell) -> None:
    """Once it is measured the list of steps offers it: one edit; the ground panel shows the choice, and undoes it."""
    track, frame, place = anchored(measured)
    project = measured.project
    for contact in track.contacts:
        project.edit(contacts.place_contact, track.id, contact.span.first, None)
    go(measured, frame)
    row = next(row for row in measured.video.steps._rows if row[1].text() == "Background")
    QTest.mouseClick(row[3], LEFT)
    assert project.document.world.ground == "background"
    assert project.session.history.undo_label == "Put contacts onto the measured background"
    wait_for(lambda: not row[3].isVisible() and not project.progress)
    project.start("Placing contacts", project.session.stages.contacts(track.id))
    wait_for(lambda: not project.progress, 60)
    project.select_track(track.id)
    settle()
    assert "the measured background" in measured.video.inspector.contact_info.text.text()
    (found, *_) = project.result(project.session.stages.contacts(track.id))
    assert abs(found.place[2]) < 0.01, "on the flat ground of the world that was filmed"
    assert np.linalg.norm(found.place - true_ground(place, frame)) < 0.3, "where the paw is, over its many frames"
    QTest.keyClick(measured, Qt.Key.Key_B)
    settle()
    local, chosen = measured.video.scene.grounds["local"], measured.video.scene.grounds["background"]
    assert chosen.isChecked()
    measured.video.scene.ensureWidgetVisible(local)
    QTest.mouseClick(local, LEFT)
    assert project.document.world.ground == "local"
    project.cancel_work()
    wait_for(lambda: not project.progress)


@pytest.mark.parametrize("width", [1180, 1440])
def test_nothing_of_the_bar_is_clipped(shell: Shell, width: int) -> None:
    """Measured or not, at the smallest size and the usual one."""
    shell.opened.keeper.automatic = False
    shell.resize(width, 760)
    QTest.keyClick(shell, Qt.Key.Key_7, ALT)
    settle(100)
    assert shell.video.background.bar.isVisible()
    assert_nothing_clipped(shell)
    measure(shell.project.session)
    shell.video.refresh()
    wait_for(lambda: shell.video.shown.backdrop is not None)
    settle(100)
    assert_nothing_clipped(shell)
