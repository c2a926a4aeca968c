"""Films, comparisons and motions ordered with mouse and keys: a live preview, progress, cancel, whole files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QToolButton, QWidget

from app.actions.session import Session
from app.formats import open_video
from app.model.edits import scene
from app.window import settings
from app.window.render.choices import FilmChoices, remembered
from app.window.render.dialog import RenderDialog
from app.window.shell import Shell
from tests.window.clipping import assert_whole
from tests.window.conftest import settle, wait_for
from tests.window.measured import measure

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture(autouse=True)
def usual_choices(qapp: object, tmp_path: Path) -> None:
    """Nothing is remembered of other tests; files go to a folder of the test."""
    kept = settings.settings()
    kept.remove("render")
    for name in ("film", "comparison", "motion", "background"):
        kept.setValue(f"render/{name}_folder", str(tmp_path))


@pytest.fixture
def measured(session: Session, request: pytest.FixtureRequest) -> Shell:
    """The window on a project whose background is measured."""
    measure(session)
    shell: Shell = request.getfixturevalue("shell")
    shell.opened.keeper.automatic = False
    return shell


def opened(shell: Shell) -> RenderDialog:
    """Ctrl+R opens the dialog."""
    QTest.keyClick(shell, Qt.Key.Key_R, CONTROL)
    settle()
    (dialog,) = [each for each in shell.findChildren(RenderDialog) if each.isVisible()]
    return dialog


def made(dialog: RenderDialog, so: Callable[..., bool] = lambda *_: True) -> None:
    """Wait for a preview of which something is so."""
    preview = dialog.stack.currentWidget().preview
    wait_for(lambda: preview.shown is not None and not preview._calls.busy and so(*preview.shown), 60)
    settle()


def choose(box: QComboBox, text: str) -> None:
    """Choose a line of a list by the keys, once the box no longer takes them for the end of those before."""
    box.setFocus()
    settle(QApplication.keyboardInputInterval() + 50)
    QTest.keyClicks(box, text[:6])
    assert box.currentText().startswith(text[:6])


def type_into(field: QWidget, text: str) -> None:
    """Click a field, type, Enter."""
    QTest.mouseClick(field, LEFT)
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def range_of(dialog: RenderDialog, first: int, last: int) -> None:
    """Film only some frames."""
    options = dialog.film.options
    options.ensureWidgetVisible(options.last)
    QTest.mouseClick(options.switches["ranged"], LEFT, pos=options.switches["ranged"].rect().center() / 8)
    if not options.switches["ranged"].isChecked():
        QTest.keyClick(options.switches["ranged"], Qt.Key.Key_Space)
    type_into(options.first, str(first))
    type_into(options.last, str(last))


def done(dialog: RenderDialog) -> str:
    """Wait for the file, and give what is said."""
    line = dialog.stack.currentWidget().target
    wait_for(lambda: line.job is None, 120)
    settle()
    return line.bar.sentence.text()


def test_the_preview_follows_controls_and_frame(measured: Shell) -> None:
    """Ctrl+R: a frame as it will be written; light is turned by the arrow keys, the frame by the timeline; kept."""
    dialog = opened(measured)
    made(dialog)
    preview, options = dialog.film.preview, dialog.film.options
    assert preview.words.text() == "As it will be written."
    first = preview.picture.picture
    assert (first.width(), first.height()) == (320, 180)
    field = options.numbers["light_turn"]
    options.ensureWidgetVisible(field)
    field.setFocus()
    for _ in range(4):
        QTest.keyClick(field, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    made(dialog, lambda order, *_: order.standing.light_turn == 40)
    turned = preview.picture.picture
    assert turned != first
    assert turned.width() == 320
    measured.activateWindow()
    wait_for(measured.isActiveWindow)
    QTest.keyClick(measured, Qt.Key.Key_Right)
    made(dialog, lambda order, frame, *_: frame == 1)
    assert preview.frame.value == 1
    assert preview.picture.picture != turned
    type_into(preview.frame, "9")
    assert measured.project.frame == 9, "the frame can be typed here too"
    made(dialog, lambda order, frame, *_: frame == 9)
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    settle()
    assert not measured.findChildren(RenderDialog)
    assert remembered() == FilmChoices(light_turn=40.0)
    again = opened(measured)
    assert again.film.options.numbers["light_turn"].value == 40
    again.close()


def test_what_is_not_measured_is_left_out_and_offered(shell: Shell) -> None:
    """Without depth the preview says what it leaves out; its button begins to measure; nobody ticked: nothing."""
    shell.opened.keeper.automatic = False
    dialog = opened(shell)
    made(dialog)
    preview = dialog.film.preview
    assert "has not been measured" in preview.words.text()
    assert not preview.shown[0].standing.needs_depth
    assert preview.help.isVisible()
    QTest.mouseClick(preview.help, LEFT)
    wait_for(lambda: any(job.label == "Measuring the background" for job in shell.project.progress))
    shell.project.cancel_work()
    wait_for(lambda: not shell.project.progress)
    (box,) = dialog.film.options.characters.values()
    box.setFocus()
    QTest.keyClick(box, Qt.Key.Key_Space)
    settle()
    assert preview.words.text() == "Choose a character to film."
    assert not dialog.film.target.write.isEnabled()


def test_a_film_is_written_in_the_background(measured: Shell, tmp_path: Path) -> None:
    """Range and path are typed; progress here and in the bar above; edits meanwhile do not reach it."""
    dialog = opened(measured)
    made(dialog)
    range_of(dialog, 2, 9)
    target = tmp_path / "out.mp4"
    line = dialog.film.target
    type_into(line.path, str(target))  # ends with Enter, which writes
    assert line.progress.isVisible()
    assert not line.write.isVisible()
    wait_for(lambda: measured.bar.job.isVisible())
    measured.project.edit(scene.rename, "renamed meanwhile")
    seen = []
    wait_for(lambda: seen.append(target.exists()) or line.job is None, 120)
    assert not any(seen[:-2]), "nothing is there until all of it is"
    assert done(dialog) == "out.mp4 is written."
    frames = open_video(target)
    assert (len(frames), frames.size) == (8, (320, 180))
    frames.close()
    assert sorted(path.name for path in tmp_path.glob("*.mp4")) == ["out.mp4"], "no temporary file is left"


def test_a_cancelled_film_leaves_the_old_one(measured: Shell, tmp_path: Path) -> None:
    """Cancel while it is written: the older file is as it was, and one sentence says so."""
    dialog = opened(measured)
    made(dialog)
    target = tmp_path / "small.mp4"
    target.write_bytes(b"an older film")
    line = dialog.film.target
    line.path.setText(str(target))
    QTest.mouseClick(line.write, LEFT)
    wait_for(lambda: line.progress.value() > 0, 60)
    QTest.mouseClick(line.cancel, LEFT)
    assert done(dialog) == "Cancelled: nothing was written."
    assert target.read_bytes() == b"an older film"
    assert line.write.isVisible()
    line.path.setText(str(tmp_path / "film.txt"))
    QTest.mouseClick(line.write, LEFT)
    assert "suffix .mp4" in done(dialog)


def test_a_film_goes_on_when_the_dialog_is_closed(measured: Shell, tmp_path: Path) -> None:
    """Esc closes the dialog, the bar above still shows the job; in the end the window says that it is written."""
    dialog = opened(measured)
    made(dialog)
    range_of(dialog, 2, 9)
    dialog.film.target.path.setText(str(tmp_path / "out.mp4"))
    QTest.mouseClick(dialog.film.target.write, LEFT)
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    wait_for(lambda: not measured.findChildren(RenderDialog))
    assert measured.project.progress
    wait_for(lambda: not measured.project.progress, 120)
    settle()
    assert (tmp_path / "out.mp4").stat().st_size > 1000
    assert measured.video.errors.sentence.text() == "out.mp4 is written."


def test_enter_in_a_number_presses_no_button(measured: Shell, tmp_path: Path) -> None:
    """It neither starts a film nor stops the one that is written, whichever button had the focus before."""
    dialog = opened(measured)
    made(dialog)
    line = dialog.film.target
    assert line.write.hasFocus()
    QTest.keyClick(dialog.film.options.first, Qt.Key.Key_Return)
    assert line.job is None
    line.path.setText(str(tmp_path / "out.mp4"))
    QTest.mouseClick(line.write, LEFT)
    type_into(dialog.film.preview.frame, "5")
    assert measured.project.frame == 5
    assert done(dialog) == "out.mp4 is written."


def test_closing_the_window_ends_the_rendering(measured: Shell, tmp_path: Path) -> None:
    """Dialog, thread and job go with the project; no file is left."""
    dialog = opened(measured)
    line = dialog.film.target
    line.path.setText(str(tmp_path / "film.mp4"))
    QTest.mouseClick(line.write, LEFT)
    wait_for(lambda: bool(measured.project.progress))
    settle(200)
    measured.close()
    assert not list(tmp_path.glob("*.mp4"))
    assert not list(tmp_path.glob(".*"))


def test_pictures_with_alpha_need_no_view(measured: Shell, tmp_path: Path) -> None:
    """The other form: what has no meaning for it is off; numbered pictures of the range in a folder."""
    dialog = opened(measured)
    options = dialog.film.options
    choose(options.form, "EXR with alpha")
    made(dialog, lambda order, *_: order.form == "exr")
    choose(options.form, "PNG with alpha")
    made(dialog, lambda order, *_: order.alpha and order.form == "png")
    assert not options.view.isEnabled()
    assert not options.switches["plate"].isEnabled()
    range_of(dialog, 4, 6)
    assert dialog.film.target.path.text() == str(tmp_path / "small")
    QTest.mouseClick(dialog.film.target.write, LEFT)
    assert done(dialog) == "small is written."
    names = sorted(path.name for path in (tmp_path / "small").iterdir() if path.suffix == ".png")
    assert names == ["00004.png", "00005.png", "00006.png"]


def test_comparisons_are_computed_and_filmed(shell: Shell, tmp_path: Path) -> None:
    """Second page: those that need an edited pose are off without one; what is missing is computed on the way."""
    shell.opened.keeper.automatic = False
    dialog = opened(shell)
    QTest.mouseClick(dialog.tabs["compare"], LEFT)
    page = dialog.compare
    made(dialog)
    assert "rendering computes it first" in page.preview.words.text()
    assert not page.variants["key_poses"].isEnabled()
    page.variants["first_pass"].setFocus()
    QTest.keyClick(page.variants["first_pass"], Qt.Key.Key_Space)
    assert page.chosen == ("anchors_only",)
    QTest.mouseClick(page.preview.help, LEFT)
    made(dialog, lambda character, there, *_: there == ("anchors_only",))
    assert page.preview.picture.picture.width() >= 640
    QTest.mouseClick(page.target.write, LEFT)
    assert done(dialog) == "small compared.mp4 is written."
    frames = open_video(tmp_path / "small compared.mp4")
    assert len(frames) == 24
    assert frames.size[0] >= 640
    frames.close()


@pytest.mark.parametrize("form", ["Animated GLB", "Folder of PLY files"])
def test_a_motion_is_exported_as_a_job(shell: Shell, tmp_path: Path, form: str) -> None:
    """Third page: form and place; the character is shown; the file or folder is whole."""
    dialog = opened(shell)
    QTest.mouseClick(dialog.tabs["motion"], LEFT)
    page = dialog.motion
    page.form.setFocus()
    while page.form.currentText() != form:
        QTest.keyClick(page.form, Qt.Key.Key_Down)
    made(dialog)
    QTest.mouseClick(page.target.write, LEFT)
    assert "is written" in done(dialog)
    if form.startswith("Folder"):
        assert len(list((tmp_path / "small motion").glob("*.ply"))) == 24
    else:
        assert (tmp_path / "small motion.glb").read_bytes()[:4] == b"glTF"


@pytest.mark.parametrize(("kind", "name"), [("Clean plates (mp4)", ".mp4"), ("Mesh (GLB)", ".glb"), ("Depth maps", "")])
def test_the_background_is_written(measured: Shell, tmp_path: Path, kind: str, name: str) -> None:
    """Fourth page: plates as a film, the mesh, depth maps; a frame of them is shown."""
    dialog = opened(measured)
    QTest.mouseClick(dialog.tabs["background"], LEFT)
    page = dialog.background
    page.kind.setFocus()
    while not page.kind.currentText().startswith(kind):
        QTest.keyClick(page.kind, Qt.Key.Key_Down)
    made(dialog, lambda shown, *_: shown == ("plate" if name == ".mp4" else "depth"))
    QTest.mouseClick(page.target.write, LEFT)
    assert "is written" in done(dialog)
    target = tmp_path / f"small background{name}"
    if name == ".mp4":
        frames = open_video(target)
        assert len(frames) == 24
        frames.close()
    elif name == ".glb":
        assert target.read_bytes()[:4] == b"glTF"
    else:
        assert (target / "depth.npz").is_file()


def test_the_quick_export_is_a_job_too(shell: Shell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl+E: the file dialog gives a path, the window stays alive, the end is told; an error is one sentence."""
    target = tmp_path / "hound.glb"
    monkeypatch.setattr("app.window.files.ask_export", lambda *_: target)
    QTest.keyClick(shell, Qt.Key.Key_E, CONTROL)
    assert any("Exporting hound.glb" in label for _, label in shell.project.progress.values())
    wait_for(lambda: not shell.project.progress, 60)
    settle()
    assert target.read_bytes()[:4] == b"glTF"
    assert "was written to hound.glb" in shell.video.errors.sentence.text()
    monkeypatch.setattr("app.window.files.ask_export", lambda *_: tmp_path / "hound.xyz")
    QTest.keyClick(shell, Qt.Key.Key_E, CONTROL)
    wait_for(lambda: not shell.project.progress, 60)
    settle()
    assert "names no known form" in shell.video.errors.sentence.text()


@pytest.mark.parametrize("size", [(860, 560), (1280, 800)])
def test_nothing_of_the_dialog_is_clipped(shell: Shell, size: tuple[int, int]) -> None:
    """At its smallest and larger, no page cuts a button or label, and every button says what it is."""
    shell.opened.keeper.automatic = False
    dialog = opened(shell)
    dialog.resize(*size)
    for name, tab in dialog.tabs.items():
        QTest.mouseClick(tab, LEFT)
        settle(100)
        assert_whole(dialog)
        for each in dialog.findChildren(QToolButton):
            assert each.text() or (each.toolTip() and each.accessibleName()), name


def test_a_list_of_the_dialog_keeps_its_keys(measured: Shell) -> None:
    """With the keys in a list, Down chooses in it and goes to no other click in time."""
    dialog = opened(measured)
    form, frame = dialog.film.options.form, measured.project.frame
    form.setFocus()
    before = form.currentIndex()
    QTest.keyClick(form, Qt.Key.Key_Down)
    assert form.currentIndex() == before + 1
    assert measured.project.frame == frame
    QTest.keyClick(form, Qt.Key.Key_Up)
    assert form.currentIndex() == before
    dialog.close()
