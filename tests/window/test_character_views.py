"""What the Character workspace shows: split and compared views, before and after, heat, warnings, layers, handles."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu

from app.actions.session import Session
from app.window.shell import Shell
from tests.window.conftest import at, drag, settle, wait_for
from tests.window.test_character_workspace import CONTROL, LEFT, character, done, drag_vertex, pose, posed, vertex, view

__all__ = ["posed"]
pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
SHIFT = Qt.KeyboardModifier.ShiftModifier


def edited(shell: Shell) -> int:
    """Move the nose in frame 10 and wait for the result; gives its vertex."""
    nose = vertex(shell, "nose")
    drag_vertex(shell, nose, 25, -45)
    wait_for(lambda: 10 in character(shell).edits)
    wait_for(lambda: done(shell), 60)
    settle()
    return nose


def entry(menu: QMenu, text: str) -> QAction:
    """An entry of a menu by how its text begins."""
    return next(action for action in menu.actions() if action.text().startswith(text))


def toggle(menu: QMenu, text: str) -> None:
    """Choose an entry as a hand does, and close the menu."""
    menu.popup(menu.parentWidget().mapToGlobal(menu.parentWidget().rect().center()))
    settle()
    QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(entry(menu, text)).center())
    settle()


def test_x_shows_camera_and_side_at_once(posed: Shell) -> None:
    """Two views of one pose; a vertex dragged in the side view is moved in depth; X again shows one."""
    QTest.keyClick(posed, Qt.Key.Key_X)
    settle()
    panes = posed.character.mesh.panes.panes
    assert list(panes) == ["main", "split"]
    assert view(posed).through_camera
    side = panes["split"].view
    assert side.looking == "side"
    assert np.array_equal(side.vertices, view(posed).vertices)
    nose, film = vertex(posed, "nose"), view(posed).camera
    before = pose(posed, 10)[nose]
    x, y = (float(value) for value in side.lens().to_widget(before))
    solves = posed.character.posing.live.solves
    drag(side, (x, y), (x + 30, y), release=False)
    wait_for(lambda: posed.character.posing.live.solves > solves)
    settle()
    assert np.array_equal(side.vertices, view(posed).vertices)
    QTest.mouseRelease(side, LEFT, pos=at(x + 30, y))
    wait_for(lambda: 10 in character(posed).edits)
    put = np.array(character(posed).edits[10].moves[nose].place)
    assert abs(float(film.depth(put) - film.depth(before))) > 0.8 * float(np.linalg.norm(put - before))
    posed.project.cancel_work()
    QTest.keyClick(posed, Qt.Key.Key_X)
    settle()
    assert list(posed.character.mesh.panes.panes) == ["main"]
    assert not shiboken6.isValid(side), "its view is gone"


def test_before_and_after(posed: Shell) -> None:
    """A shows the motion without its edits, where nothing can be dragged, and with them again."""
    old = pose(posed, 10)
    nose = edited(posed)
    new = pose(posed, 10)
    QTest.keyClick(posed, Qt.Key.Key_A)
    settle()
    assert np.array_equal(view(posed).vertices, old)
    assert posed.character.mesh.notes.right[0] == "before the edits"
    entries = len(posed.project.session.history.versions)
    x, y = (float(value) for value in view(posed).lens().to_widget(old[nose]))
    drag(view(posed), (x, y), (x + 30, y))
    settle()
    assert len(posed.project.session.history.versions) == entries
    QTest.keyClick(posed, Qt.Key.Key_Escape)
    settle()
    assert np.array_equal(view(posed).vertices, new)


def test_the_papers_comparisons_stand_beside_the_result(posed: Shell) -> None:
    """Each chosen one has a view with its name, from the same side; turning one turns all; none leaves one view."""
    edited(posed)
    mesh = posed.character.mesh
    toggle(mesh.bar.compare_menu(), "First pass only")
    stage = posed.project.session.stages.comparison(character(posed).id, "first_pass")
    wait_for(lambda: posed.project.result(stage) is not None)
    wait_for(lambda: len(mesh.panes.panes["first_pass"].view.vertices))
    settle()
    toggle(mesh.bar.compare_menu(), "Before the edits")
    assert list(mesh.panes.panes) == ["main", "before", "first_pass"]
    stages = posed.project.session.stages
    first = posed.project.result(stage)
    other = mesh.panes.panes["first_pass"]
    assert np.array_equal(other.view.vertices, first[10])
    assert other.notes.right[0].startswith("First pass only")
    solved = posed.project.result(stages.base(character(posed).id))
    assert np.array_equal(mesh.panes.panes["before"].view.vertices, solved.vertices[10])
    drag(other.view, (20, 60), (90, 60))
    assert view(posed).orbit == other.view.orbit == mesh.panes.panes["before"].view.orbit
    QTest.keyClick(posed, Qt.Key.Key_Right)
    wait_for(lambda: posed.character.frame == 11)
    settle()
    assert np.array_equal(other.view.vertices, first[11])
    toggle(mesh.bar.compare_menu(), "None")
    assert list(mesh.panes.panes) == ["main"]


def test_a_comparison_that_is_not_possible_says_why(posed: Shell) -> None:
    """Without an edited frame there are no key poses to interpolate: one sentence, and the view says so."""
    mesh = posed.character.mesh
    toggle(mesh.bar.compare_menu(), "Key poses")
    wait_for(lambda: "needs at least one edited frame" in mesh.errors.sentence.text(), 30)
    settle()
    assert "not possible" in mesh.panes.panes["key_poses"].notes.right[0]
    toggle(mesh.bar.compare_menu(), "None")


def test_heat_maps_colour_the_mesh_and_have_a_legend(posed: Shell) -> None:
    """Q shows the stretch, then what is below the surface, then the character's own colours; it follows the pose."""
    settle(400)
    own = view(posed).grab().toImage()
    QTest.keyClick(posed, Qt.Key.Key_Q)
    wait_for(lambda: posed.character.mesh.heat is not None)
    settle(400)
    heat = posed.character.mesh.heat
    assert heat.title == "Stretch"
    stretched = view(posed).grab().toImage()
    assert stretched != own
    legend = stretched.pixelColor(view(posed).width() - 24, view(posed).height() // 2 - 80)
    assert legend.red() > legend.blue() + 40
    QTest.keyClick(posed, Qt.Key.Key_Right)
    wait_for(lambda: posed.character.mesh.heat is not heat)
    QTest.keyClick(posed, Qt.Key.Key_Q)
    wait_for(lambda: posed.character.mesh.heat.title == "Below the surface")
    QTest.keyClick(posed, Qt.Key.Key_Q)
    settle(400)
    assert posed.character.mesh.heat is None


def test_warnings_name_the_worst_and_go_there(posed: Shell) -> None:
    """A limb that is pulled out is found; Show goes to its frame, N and Shift+N from one problem to the next."""
    nose = vertex(posed, "nose")
    drag_vertex(posed, nose, 150, -120)
    wait_for(lambda: 10 in character(posed).edits)
    wait_for(lambda: done(posed), 60)
    checks = posed.character.checks
    wait_for(lambda: checks.fresh and checks.check is not None)
    settle()
    problems, warnings = checks.check.problems, posed.character.warnings
    assert any(each.kind == "stretch" for each in problems)
    assert warnings.text.text() == problems[0].text
    QTest.mouseClick(warnings.show_button, LEFT)
    assert posed.project.frame == problems[0].worst
    QTest.keyClick(posed, Qt.Key.Key_Home)
    order = sorted({each.worst for each in problems})
    QTest.keyClick(posed, Qt.Key.Key_N)
    assert posed.project.frame == next((frame for frame in order if frame >= 0), order[0])
    seen = []
    for _ in problems:
        QTest.keyClick(posed, Qt.Key.Key_N)
        seen.append(posed.project.frame)
    assert set(seen) == set(order), "every problem is visited once round"
    before = posed.project.frame
    QTest.keyClick(posed, Qt.Key.Key_N)
    QTest.keyClick(posed, Qt.Key.Key_N, SHIFT)
    assert posed.project.frame == before


def test_handles_say_what_they_are(posed: Shell) -> None:
    """An edited vertex is large, with a link to where it was; one off its point has a red ring; bars say how far."""
    old = pose(posed, 10)
    nose = edited(posed)
    handles = {handle.vertex: handle for handle in view(posed).handles}
    assert handles[nose].kind == "edited"
    assert np.allclose(handles[nose].before, old[nose], atol=1e-9)
    planted = {
        character(posed).pairs[track.id]
        for track in posed.project.document.tracks
        if any(10 in contact.span for contact in track.contacts) and track.id in character(posed).pairs
    }
    assert planted
    assert {number for number, handle in handles.items() if handle.kind == "anchor"} == planted - {nose}
    assert handles[nose].warning, "it was pulled far from its point in the film"
    bars = posed.character.inspector.fit.bars
    assert bars.rows[0][0] == nose
    assert bars.rows[0][2] > bars.limit
    QTest.mouseClick(bars, LEFT, pos=at(60, 10))
    assert posed.project.vertex == nose


def test_layers_are_switched_one_by_one(posed: Shell) -> None:
    """The menu in space hides points, path, tracks, shadow and grid, that over the film the film itself."""
    bar = posed.character.mesh.bar
    for text, name in (
        ("3D points", "points"),
        ("Camera path", "path"),
        ("Ground grid", "ground"),
        ("Shadow", "shadow"),
    ):
        before = view(posed).grab().toImage()
        toggle(bar.layer_menu(), text)
        assert not view(posed).shows(name)
        if name in view(posed).scene._actors:
            assert not view(posed).scene._actors[name].GetVisibility()
        if name in ("shadow", "ground"):
            assert view(posed).grab().toImage() != before
    before = view(posed).grab().toImage()
    toggle(bar.layer_menu(), "Tracks")
    assert view(posed).grab().toImage() != before
    assert not entry(bar.layer_menu(), "Background mesh").isEnabled()
    QTest.keyClick(posed, Qt.Key.Key_1)
    settle()
    corner = view(posed).grab().toImage().pixelColor(5, view(posed).height() // 2)
    toggle(bar.layer_menu(), "Film")
    assert view(posed).grab().toImage().pixelColor(5, view(posed).height() // 2) != corner


def test_the_view_goes_along_with_the_character(posed: Shell) -> None:
    """From frame to frame its middle stays in place on the screen; switched off, the camera stands still."""

    def middle() -> np.ndarray:
        return view(posed).lens().to_widget(view(posed).vertices.mean(0))

    first = middle()
    posed.project.show_frame(20)
    wait_for(lambda: posed.character.frame == 20)
    settle()
    assert np.allclose(middle(), first, atol=0.5)
    toggle(posed.character.mesh.bar.layer_menu(), "Keep the character in view")
    posed.project.show_frame(2)
    wait_for(lambda: posed.character.frame == 2)
    settle()
    assert np.linalg.norm(middle() - first) > 3


def test_before_there_is_a_character_one_is_asked_for(open_shell: Callable[[Session], Shell], session: Session) -> None:
    """One sentence and one button; a character that comes takes its place."""
    from app.model.edits import characters

    hound = session.document.characters[0].id
    session.apply(characters.delete_character(session.document, hound))
    shell = open_shell(session)
    QTest.keyClick(shell, Qt.Key.Key_F2)
    wait_for(lambda: shell.character.isVisible())
    settle()
    empty = shell.character.mesh.empty
    assert empty.isVisible()
    assert empty.sentence.text() == "Choose a character mesh."
    assert empty.choose.isVisible()
    assert not empty.more[-1].isVisible()
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    wait_for(lambda: shell.character.mesh.viewport is not None and len(view(shell).vertices))
    assert not empty.isVisible()


def test_switching_views_leaves_no_render_window(posed: Shell) -> None:
    """Ten times split and compared: only the main view's window is left each time."""
    from PySide6.QtWidgets import QWidget

    for _ in range(10):
        QTest.keyClick(posed, Qt.Key.Key_X)
        posed.character.mesh.bar._vary("before", True)
        settle(10)
        QTest.keyClick(posed, Qt.Key.Key_X)
        posed.character.mesh.bar._vary("before", False)
        settle(10)
    open_ = [host for host in posed.findChildren(QWidget, "render host") if not host.property("finished")]
    assert len(open_) == 1
