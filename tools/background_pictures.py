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


def take_contact(shell: Shell, camera: Camera) -> None:
    """An anchor on its way over the measured surface."""
    project, video = shell.project, shell.video
    assert project is not None
    track = next(each for each in project.document.tracks if each.contacts)
    kept, frame = project.frame, track.contacts[0].span.first + 3
    project.show_frame(frame)
    camera.live(5, lambda: video.frame == frame)
    if project.result(project.session.stages.contacts(track.id)) is None:
        project.start("Placing contacts", project.session.stages.contacts(track.id))
        camera.live(30, lambda: not project.progress)
    project.select_track(track.id)
    shell.do("tool_contact")
    x, y = next(place for mark in video._marks if mark.name == track.id and (place := mark.at(frame)) is not None)
    video.snapping.dragged = (track.id, (x + 16, y + 10))
    video.refresh()
    camera.live(20, lambda: video.background.surface(frame) is not None)
    video.refresh()
    camera.take("video-contact")
    video.snapping.dragged = None
    shell.do("tool_select")
    project.select_track("")
    project.show_frame(kept)
    camera.live(5, lambda: video.frame == kept)


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
