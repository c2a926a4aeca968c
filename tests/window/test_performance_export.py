"""The export dialog of a performance: forms, places, a film, cancel, what is remembered; by mouse and keys."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.actions import performing
from app.actions.session import Session
from app.formats import open_video
from app.formats.tvm import open_mesh_frames
from app.model.edits import performance as edits
from app.model.performance import KeyMotion
from app.window.performance.export_dialog import FORMS, ExportDialog
from app.window.performance.preview_notes import place_lines
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for
from tests.window.performance_parts import CONTROL, LEFT, PLAIN, drop, label_of, quiet
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project
from tests.window.small_performance import write_worn_take

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


def ask(shell: Shell, *, kept: bool = False) -> ExportDialog:
    """Ctrl+E opens the dialog; unless ``kept``, without the path that an earlier one remembered."""
    shell.activateWindow()  # without a screen nobody gives it back the keys
    wait_for(shell.isActiveWindow)
    QTest.keyClick(shell, Qt.Key.Key_E, CONTROL)
    settle(30)
    dialog = shell.pages.in_sight.findChild(ExportDialog)
    if dialog.path.isChecked() and not kept:
        QTest.mouseClick(dialog.path, LEFT, PLAIN, QPoint(8, dialog.path.height() // 2))
    wait_for(lambda: not dialog._still.startswith("Looking"))
    return dialog


def choose(dialog: ExportDialog, form: str) -> None:
    """Choose a form by keys."""
    wanted = [name for name, _, _ in FORMS].index(form)
    dialog.form.setFocus()
    while dialog.form.currentIndex() != wanted:
        QTest.keyClick(dialog.form, Qt.Key.Key_Down if dialog.form.currentIndex() < wanted else Qt.Key.Key_Up)


def place(dialog: ExportDialog, path: Path) -> None:
    """Type where it goes."""
    dialog.place.setFocus()
    dialog.place.selectAll()
    QTest.keyClicks(dialog.place, str(path))


def finished(dialog: ExportDialog) -> str:
    """Press Export and wait; gives what is said in the end."""
    said: list[str] = []
    dialog.done.connect(said.append)
    QTest.mouseClick(dialog.export_button, LEFT)
    wait_for(lambda: said, 150)
    return said[0]


def test_meshes_and_path(composed: Shell, tmp_path: Path) -> None:
    """A folder of PLY with colours and path.json; the next dialog begins where this one ended."""
    dialog = ask(composed)
    choose(dialog, "ply")
    place(dialog, tmp_path / "made")
    QTest.mouseClick(dialog.path, LEFT, PLAIN, QPoint(8, dialog.path.height() // 2))
    assert dialog.path.isChecked()
    sentence = finished(dialog)
    assert sentence == "Written: made and path.json."
    count = composed.pages.in_sight.state.frame_count
    frames = open_mesh_frames(tmp_path / "made")
    assert len(frames) == count
    assert frames[0].colours is not None
    assert json.loads((tmp_path / "made" / "path.json").read_text())["frame_count"] == count
    assert composed.pages.errors.sentence.text() == sentence
    again = ask(composed, kept=True)
    assert again.chosen == "ply"
    assert again.path.isChecked()
    assert Path(again.place.text()).parent == tmp_path
    place(again, tmp_path / "made")
    assert "will be replaced" in again.words.text()
    again.reject()


def test_the_path_alone_is_written_and_taken_again(composed: Shell, tmp_path: Path) -> None:
    """What was composed is a file; dropped on the library it is one entry of the history."""
    from app.model.edits import performance

    dialog = ask(composed)
    choose(dialog, "path")
    place(dialog, tmp_path / "made")
    assert not dialog.blended.isVisible()
    assert finished(dialog) == "Written: made.json."
    choice = composed.project.document.performance
    composed.project.edit(performance.set_keys, [])
    drop(composed.pages.in_sight.library, tmp_path / "made.json")
    assert composed.project.document.performance == choice
    assert label_of(composed) == "Take the choices of made.json"
    (tmp_path / "other.json").write_text("{}")
    drop(composed.pages.in_sight.library, tmp_path / "other.json")
    assert "is no path that Motionwright wrote" in composed.pages.errors.sentence.text()
    assert composed.project.document.performance == choice
    quiet(composed)


@pytest.mark.parametrize(("form", "ending"), [("npz", ".npz"), ("usd", ".usd")])
def test_one_file_gets_its_ending(composed: Shell, tmp_path: Path, form: str, ending: str) -> None:
    """The ending follows the form, whatever was typed before."""
    if form == "usd":
        pytest.importorskip("pxr")
    dialog = ask(composed)
    choose(dialog, form)
    place(dialog, tmp_path / "made")
    finished(dialog)
    frames = open_mesh_frames(tmp_path / f"made{ending}")
    assert len(frames) == composed.pages.in_sight.state.frame_count
    frames.close()


def test_one_animated_glb_says_why_not(composed: Shell, tmp_path: Path) -> None:
    """Frames with faces of their own cannot be one animated GLB: the reason is there before anything is asked."""
    dialog = ask(composed)
    choose(dialog, "animation")
    place(dialog, tmp_path / "made")
    assert "faces of their own" in dialog.why.text()
    assert not dialog.export_button.isEnabled()
    dialog.reject()


def test_a_film_is_cancelled_then_written(composed: Shell, tmp_path: Path) -> None:
    """The bar moves, Cancel leaves nothing, Export writes a film of the performance's length and rate."""
    dialog = ask(composed)
    choose(dialog, "film")
    place(dialog, tmp_path / "made")
    dialog.size.setFocus()
    QTest.keyClick(dialog.size, Qt.Key.Key_Home)
    QTest.mouseClick(dialog.export_button, LEFT)
    assert dialog.bar.isVisible()
    wait_for(lambda: dialog.bar.value() > 0)
    QTest.mouseClick(dialog.cancel_button, LEFT)
    wait_for(lambda: dialog.job is None)
    assert dialog.words.text() == "Cancelled: nothing was written."
    assert list(tmp_path.glob("made*")) == []
    assert finished(dialog) == "Written: made.mp4."
    film = open_video(tmp_path / "made.mp4")
    assert len(film) == composed.pages.in_sight.state.frame_count
    assert float(film.fps) == composed.pages.in_sight.state.fps
    film.close()


def test_nothing_composed_is_said(composed: Shell) -> None:
    """Without key motions the dialog says what is missing and cannot be accepted."""
    from app.model.edits import performance

    composed.project.edit(performance.set_keys, [])
    wait_for(lambda: composed.pages.in_sight.state.frame_count == 0)
    QTest.keyClick(composed, Qt.Key.Key_E, CONTROL)
    settle(30)
    dialog = composed.pages.in_sight.findChild(ExportDialog)
    assert dialog.why.text() == "Compose a performance first."
    assert not dialog.export_button.isEnabled()
    dialog.reject()
    wait_for(lambda: not composed.project.progress)


@pytest.mark.slow
def test_in_betweens_of_worn_pictures_say_how_they_are_coloured(
    open_shell: Callable[[Session], Shell], tmp_path: Path
) -> None:
    """In the preview, in the dialog, and when they are written: pictures stay, in-betweens have colours."""
    session = Session.new(tmp_path / "worn")
    for name in ("Walk", "Gym"):
        performing.add_sequence(session, write_worn_take(tmp_path, name), fps=15.0, up="z", unit=1.0)
    graph: Any = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    walk = next(each for each in named if each.name.startswith("Walk"))
    march = [each for each in named if each.name.startswith("Gym")][-1]
    session.apply(edits.set_keys(session.document, [KeyMotion(walk.motion), KeyMotion(march.motion)]))
    session.apply(edits.set_mu(session.document, 50.0))
    blends: Any = session.result(session.stages.blends)
    between = [position for blend in blends.blends for position in sorted(blend.shapes)]
    assert between, "a cut is blended"
    shell = open_shell(session)
    QTest.keyClick(shell, Qt.Key.Key_F3)
    page = shell.performance
    wait_for(lambda: page.preview.shown >= 0 and not shell.project.progress, 60)
    for position, worn in ((between[0], False), (0, True)):
        page.state.show_position(position)
        wait_for(lambda position=position: page.preview.shown == position)
        shown = page.preview.frame
        assert shown.blended != worn
        assert (shown.picture is not None) == worn
        lines = place_lines(page.state, shown.sequence, shown.source, shown.blended)
        assert any("colours at its vertices instead of the picture" in line for line in lines) != worn
    dialog = ask(shell)
    choose(dialog, "ply")
    assert dialog.worn.isVisible()
    QTest.mouseClick(dialog.blended, LEFT, PLAIN, QPoint(8, dialog.blended.height() // 2))
    assert not dialog.worn.isVisible()
    QTest.mouseClick(dialog.blended, LEFT, PLAIN, QPoint(8, dialog.blended.height() // 2))
    place(dialog, tmp_path / "made")
    sentence = finished(dialog)
    assert f"{len(between)} blended frames have colours at their vertices instead of pictures." in sentence
    with open_mesh_frames(tmp_path / "made") as frames:
        assert frames[0].texture is not None
        assert frames[between[0]].texture is None
        assert frames[between[0]].colours is not None
