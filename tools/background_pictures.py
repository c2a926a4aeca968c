"""Pictures of the measured background in the Video workspace, and of the dialog that orders films."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.window.background_state import measure
from app.window.render import open_render
from app.window.shell import Shell

if TYPE_CHECKING:
    from tools.screenshots import Camera

DIALOG = (1280, 800)


def take_background(shell: Shell, camera: Camera) -> None:
    """Measure the background where that was not done before; show its depth, and the plate behind a wipe."""
    project, video = shell.project, shell.video
    assert project is not None
    if project.state(project.session.stages.depth) != "fresh":
        print("measuring the background ...", flush=True)
        measure(project)
        camera.live(600, lambda: not project.progress)
    video.layer_buttons["background"].setChecked(True)
    video.paths_button.setChecked(False)
    video.masks_button.setChecked(False)
    bar = video.background.bar
    for kind, name, opacity, wiped in (("depth", "video-depth", 80, False), ("plate", "video-plate", 100, True)):
        bar.kinds[kind].click()
        bar.opacity.set_value(opacity)
        bar.wipe.setChecked(wiped)
        video.background.move_line(0.55 * video.canvas.picture.width(), video.canvas.picture.width(), done=False)
        video.refresh()
        camera.live(60, lambda: video.shown.backdrop is not None)
        camera.take(name)
    bar.wipe.setChecked(False)
    video.layer_buttons["background"].setChecked(False)
    video.paths_button.setChecked(True)
    video.masks_button.setChecked(True)


def take_render(shell: Shell, camera: Camera) -> None:
    """The dialog of a film with a frame of it."""
    from tools.screenshots import TARGET

    dialog = open_render(shell)
    assert dialog is not None
    dialog.resize(*DIALOG)
    for character in list(dialog.film.options.characters.values())[:-1]:
        character.setChecked(False)
    dialog.film.target.path.setText("~/stairs.mp4")
    preview = dialog.film.preview
    camera.live(120, lambda: preview.shown is not None and not preview._calls.busy)
    camera.live(0.3)
    dialog.grab().save(str(TARGET / f"render-{DIALOG[0]}x{DIALOG[1]}.png"))
    print("render")
    dialog.close()
    camera.live(0.2)
