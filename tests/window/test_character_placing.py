"""Placing the character by gizmo, numbers and keys, and pairing it with points, by a real mouse."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import characters
from app.window.shell import Shell
from app.window.viewport import Gizmo
from tests.window.conftest import at, drag, hover, settle, wait_for
from tests.window.test_character_editing import stroke
from tests.window.test_character_workspace import CONTROL, LEFT, character, done, place, pose, posed, vertex, view

__all__ = ["posed"]
pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]


@pytest.fixture
def placing(posed: Shell) -> Shell:
    """The window with the gizmo in hand, in the first frame."""
    QTest.keyClick(posed, Qt.Key.Key_T)
    wait_for(lambda: posed.character.frame == 0)
    settle()
    assert view(posed).gizmo is not None
    return posed


def gizmo(shell: Shell) -> Gizmo:
    """The gizmo shown."""
    found = view(shell).gizmo
    assert found is not None
    return found


def spot(shell: Shell, part: str) -> tuple[float, float]:
    """Where the end of an axis, or a point of a ring, is on the screen."""
    line = gizmo(shell).lines(view(shell).lens().camera)[part]
    x, y = line[1] if len(line) == 2 else line[6]
    return float(x), float(y)


def test_an_arrow_moves_the_character_and_is_one_entry(placing: Shell) -> None:
    """The mesh follows while it is dragged; the release is one edit; undo puts it back, and Escape the gizmo away."""
    before, entries = pose(placing, 0), len(placing.project.session.history.versions)
    x, y = spot(placing, "z")
    drag(view(placing), (x, y), (x, y - 60), release=False)
    settle()
    lifted = view(placing).vertices[:, 2] - before[:, 2]
    assert lifted.min() > 0.05
    assert np.ptp(lifted) < 1e-9
    assert len(placing.project.session.history.versions) == entries
    QTest.mouseRelease(view(placing), LEFT, pos=at(x, y - 60))
    assert len(placing.project.session.history.versions) == entries + 1
    assert placing.project.session.history.undo_label == "Move hound in the first frame"
    assert character(placing).alignment.translation[2] == pytest.approx(lifted.mean(), abs=0.02)
    assert placing.character.inspector.place_in_first.shift[2].value == pytest.approx(lifted.mean(), abs=0.02)
    placing.project.cancel_work()
    QTest.keyClick(placing, Qt.Key.Key_Z, CONTROL)
    assert character(placing).alignment.translation == (0.0, 0.0, 0.0)
    wait_for(lambda: np.allclose(pose(placing, 0), before, atol=1e-9))
    QTest.keyClick(placing, Qt.Key.Key_Escape)
    assert view(placing).gizmo is None


def test_the_character_is_dragged_onto_the_subject_over_the_film(placing: Shell) -> None:
    """Through the recovered camera the mesh itself is taken and goes where the mouse goes."""
    QTest.keyClick(placing, Qt.Key.Key_1)
    settle()
    assert view(placing).through_camera
    camera, before = view(placing).lens().camera, pose(placing, 0)
    seen = camera.project(before[vertex(placing, "nose")]) - (6.0, 0.0)
    drag(view(placing), tuple(seen), (seen[0] + 35, seen[1] + 14))
    after = view(placing).vertices
    middle = camera.project(before.mean(0)), camera.project(after.mean(0))
    assert np.allclose(middle[1] - middle[0], (35, 14), atol=1.5)
    assert any(character(placing).alignment.translation)
    placing.project.cancel_work()


def test_turn_and_scale_by_their_handles(placing: Shell) -> None:
    """R turns about the ring's axis, U scales with the distance; the numbers say so; reset takes all back."""
    QTest.mouseClick(placing.character.inspector.place_in_first.modes["rotate"], LEFT)
    assert gizmo(placing).mode == "rotate"
    ring = gizmo(placing).lines(view(placing).lens().camera)["z"]
    drag(view(placing), tuple(ring[4]), tuple(ring[12]))
    assert character(placing).alignment.rotation[2] == pytest.approx(40.0, abs=4.0)
    placing.project.cancel_work()
    settle()
    QTest.keyClick(placing, Qt.Key.Key_U)
    settle()
    assert gizmo(placing).mode == "scale"
    x, y = spot(placing, "z")
    middle = view(placing).lens().to_widget(np.array(gizmo(placing).centre))
    drag(view(placing), (x, y), (middle[0] + 1.5 * (x - middle[0]), middle[1] + 1.5 * (y - middle[1])))
    assert character(placing).alignment.scale == pytest.approx(1.5, abs=0.05)
    assert placing.character.inspector.scale.value == pytest.approx(1.5, abs=0.05)
    placing.project.cancel_work()
    QTest.mouseClick(placing.character.inspector.place_in_first.reset, LEFT)
    plain = character(placing).alignment
    assert (plain.scale, plain.rotation, plain.translation) == (1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    placing.project.cancel_work()


def test_escape_during_a_drag_of_the_gizmo_takes_it_back(placing: Shell) -> None:
    """The mesh is where it was, nothing was decided, and the gizmo is still in hand."""
    before, entries = pose(placing, 0), len(placing.project.session.history.versions)
    x, y = spot(placing, "x")
    drag(view(placing), (x, y), (x + 50, y), release=False)
    QTest.keyClick(placing, Qt.Key.Key_Escape)
    QTest.mouseRelease(view(placing), LEFT, pos=at(x + 50, y))
    settle()
    assert np.array_equal(view(placing).vertices, before)
    assert len(placing.project.session.history.versions) == entries
    assert view(placing).gizmo is not None


def test_numbers_and_keys_place_it_too(placing: Shell) -> None:
    """A number that is dragged shows the place at once; strokes of keys are one entry."""
    field, before = placing.character.inspector.place_in_first.shift[2], pose(placing, 0)
    drag(field, (20, 10), (70, 10), release=False)
    settle()
    lifted = view(placing).vertices[:, 2] - before[:, 2]
    assert np.allclose(lifted, field.value, atol=1e-9)
    assert field.value > 0.05
    QTest.keyClick(field, Qt.Key.Key_Escape)
    QTest.mouseRelease(field, LEFT, pos=at(70, 10))
    entries = len(placing.project.session.history.versions)
    for _ in range(5):
        QTest.keyClick(placing, Qt.Key.Key_Up, CONTROL)
    assert len(placing.project.session.history.versions) == entries + 1
    moved = np.array(character(placing).alignment.translation)
    assert np.linalg.norm(moved) == pytest.approx(5 * stroke(placing, before), rel=1e-6)
    placing.project.cancel_work()


def test_the_placed_character_moves_on_as_it_was_put(placing: Shell) -> None:
    """What is solved afterwards begins where the gizmo left it."""
    x, y = spot(placing, "x")
    drag(view(placing), (x, y), (x + 20, y))
    wait_for(lambda: done(placing), 90)
    settle()
    placed = placing.project.result(placing.project.session.stages.alignment(character(placing).id)).vertices
    assert np.linalg.norm(pose(placing, 0).mean(0) - placed.mean(0)) < 0.02


def test_a_character_without_pairs_is_stood_on_the_subject(posed: Shell) -> None:
    """With no pair the gizmo stands it on the ground under the points of the first frame, by hand from then on."""
    for track in tuple(character(posed).pairs):
        posed.project.edit(characters.remove_pair, character(posed).id, track, gesture="bare")
    posed.project.cancel_work()
    QTest.keyClick(posed, Qt.Key.Key_T)
    wait_for(lambda: posed.character.frame == 0)
    assert not character(posed).alignment.fitted
    stage = posed.project.session.stages.alignment(character(posed).id)
    wait_for(lambda: posed.project.result(stage) is not None)
    settle()
    vertices = posed.project.result(stage).vertices
    world = posed.project.result(posed.project.session.stages.world)
    assert np.allclose(view(posed).vertices, vertices)
    pixels = world.cameras[0].project(vertices)
    clicks = np.array([track.clicks[0] for track in posed.project.document.tracks if 0 in track.clicks])
    assert np.linalg.norm(pixels.mean(0) - clicks.mean(0)) < 0.5 * np.linalg.norm(np.ptp(clicks, axis=0))
    assert posed.character.inspector.place_in_first.by.currentIndex() == 1


def free_spot(shell: Shell, near: int) -> tuple[int, object]:
    """An unpaired vertex near another one, and the whole pixel at which a click finds it."""
    taken = set(character(shell).pairs.values())
    pixels = view(shell).lens().to_widget(view(shell).vertices)
    for number in np.argsort(np.hypot(*(pixels - np.array(place(shell, near))).T)):
        spot_ = at(*pixels[number])
        if number not in taken and view(shell).vertex_at((spot_.x(), spot_.y())) == number:
            return int(number), spot_
    raise AssertionError


def mark_of(shell: Shell, name: str) -> object:
    """Where a point is in the picture beside the character."""
    tracks = shell.character.tracks
    track = next(each for each in shell.project.document.tracks if each.name == name)
    mark = next(each for each in tracks._marks if each.name == track.id)
    return at(*tracks.canvas.view.point(*mark.at(shell.character.frame)))


def test_a_vertex_may_be_clicked_before_its_point(posed: Shell) -> None:
    """W, a vertex, its point: paired. The hint says what is waited for."""
    back = next(track for track in posed.project.document.tracks if track.name == "back")
    posed.project.select_track("")
    QTest.keyClick(posed, Qt.Key.Key_W)
    assert "Click a point in the video or a vertex" in posed.status.hint.text()
    number, spot_ = free_spot(posed, character(posed).pairs[back.id])
    QTest.mouseClick(view(posed), LEFT, pos=spot_)
    assert f"Vertex {number:,} is chosen" in posed.status.hint.text()
    QTest.mouseClick(posed.character.tracks.canvas, LEFT, pos=mark_of(posed, "back"))
    assert character(posed).pairs[back.id] == number
    posed.project.cancel_work()
    QTest.keyClick(posed, Qt.Key.Key_Escape)
    assert not posed.character.pairing.on
    assert not posed.character.tracks.pair_button.isChecked()


def test_pairs_and_unmatched_points_are_listed(posed: Shell) -> None:
    """The link's button separates a pair: its point is then first in the list, without a vertex; undo joins them."""
    pairs = posed.character.inspector.pairs
    nose = next(track for track in posed.project.document.tracks if track.name == "nose")
    number = character(posed).pairs[nose.id]
    assert pairs.caption.text().endswith("matched")
    QTest.mouseClick(pairs.list, LEFT, pos=pairs.list.place_of(nose.id).toPoint())
    assert posed.project.track_id == nose.id
    assert posed.project.vertex == number
    QTest.mouseClick(pairs.list, LEFT, pos=pairs.list.place_of(nose.id, "remove").toPoint())
    assert nose.id not in character(posed).pairs
    settle()
    first = pairs.list.entries[0]
    assert (first.id, first.caption, first.faint) == (nose.id, "no vertex yet", True)
    assert pairs.caption.text() == "1 unmatched"
    posed.project.cancel_work()
    QTest.keyClick(posed, Qt.Key.Key_Z, CONTROL)
    assert character(posed).pairs[nose.id] == number


def test_what_is_pointed_at_is_lit_on_both_sides(posed: Shell) -> None:
    """A handle under the mouse lights its point, a point its handle, a row of the list both."""
    nose = next(track for track in posed.project.document.tracks if track.name == "nose")
    number = character(posed).pairs[nose.id]
    x, y = place(posed, number)
    hover(view(posed), at(x, y))
    assert posed.character.tracks.shown.hovered == nose.id
    hover(view(posed), at(4, 4))
    assert posed.character.tracks.shown.hovered == ""
    hover(posed.character.tracks.canvas, mark_of(posed, "nose"))
    assert view(posed).highlighted == number
    rows, inspector = posed.character.inspector.pairs.list, posed.character.inspector
    spot_ = rows.mapTo(inspector.widget(), rows.place_of(nose.id).toPoint())
    inspector.ensureVisible(spot_.x(), spot_.y())
    settle()
    hover(rows, rows.place_of(nose.id).toPoint())
    assert view(posed).highlighted == number
    assert posed.character.tracks.shown.hovered == nose.id
