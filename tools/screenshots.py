"""Pictures of the window with real content, for the documentation: docs/screenshots/*.png.

The sample is solved once and kept in build/, so that a second run is quick.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402

from app.actions.sample import fill_with_sample, sample_folder  # noqa: E402
from app.actions.session import Session  # noqa: E402
from app.model.edits import scene  # noqa: E402
from app.window.application import make_application  # noqa: E402
from app.window.shell import Shell  # noqa: E402
from app.window.video.scene_picking import seen_points  # noqa: E402
from tools.background_pictures import take_background, take_contact, take_render  # noqa: E402
from tools.performance_pictures import take_performance  # noqa: E402

TARGET = ROOT / "docs" / "screenshots"
SIZES = ((1440, 900), (1920, 1080))


def solved_sample(place: Path) -> Path:
    """The sample as a solved project at a place; what is there and up to date is not solved again."""
    if not place.exists():
        session = Session.new(place)
        fill_with_sample(session)
        session.save()
        session.close()
    session = Session.open(place)
    print("solving what is missing ...", flush=True)
    session.result(session.stages.animation(session.document.characters[0].id))
    for track in session.document.tracks:
        session.result(session.stages.track(track.id))
    session.close()
    return place


class Camera:
    """Takes pictures of a window."""

    def __init__(self, shell: Shell, application: object) -> None:
        self.shell, self.application = shell, application

    def live(self, seconds: float, until: Callable[[], bool] | None = None) -> None:
        """Let the window live."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not (until is not None and until()):
            self.application.processEvents()  # type: ignore[attr-defined]
            time.sleep(0.005)

    def take(self, name: str) -> None:
        """Take a picture at each size."""
        for width, height in SIZES:
            self.shell.resize(width, height)
            self.live(1.2)
            self.shell.grab().save(str(TARGET / f"{name}-{width}x{height}.png"))
        print(name)


def main() -> None:
    """Take all pictures."""
    TARGET.mkdir(parents=True, exist_ok=True)
    application = make_application()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):
            os.environ[name] = folder
        shell = Shell(Session.new(), viewport="raster")
        shell.show()
        camera = Camera(shell, application)
        camera.take("welcome")
        _begun(shell, camera)
        place = solved_sample(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "Sample.motionwright")
        shell.open_session(Session.open(place))
        camera.live(20, lambda: not shell.video.canvas.picture.isNull())
        _video(shell, camera)
        take_background(shell, camera)
        take_contact(shell, camera)
        take_render(shell, camera)
        _character(shell, camera)
        if shell.project is not None:
            shell.project.session.history.mark_saved()
        take_performance(shell, camera, ROOT / "build" / "Moves.motionwright")
        if shell.project is not None:
            shell.project.cancel_work()
            shell.project.session.history.mark_saved()
        shell.close()


def _begun(shell: Shell, camera: Camera) -> None:
    """A clip that was just opened, while the first lasso is drawn."""
    values = json.loads((sample_folder() / "sample.json").read_text())
    shell.files.add_clip(sample_folder() / values["clip"])
    camera.live(20, lambda: not shell.video.canvas.picture.isNull())
    shell.do("tool_lasso")
    outline = values["lassos"]["0"]
    shell.video.shown.drawing = tuple((x, y) for x, y in outline[: round(0.8 * len(outline))])
    shell.video.refresh()
    camera.take("video-lasso")
    shell.video.shown.drawing = ()
    shell.do("tool_select")
    if shell.project is not None:
        shell.project.session.history.mark_saved()


def _quiet(shell: Shell) -> bool:
    return shell.project is not None and not shell.project.progress


def _video(shell: Shell, camera: Camera) -> None:
    project = shell.project
    assert project is not None
    names = {track.name: track.id for track in project.document.tracks}
    track = next((names[name] for name in names if "front paw" in name), project.document.tracks[0].id)
    project.show_frame(project.frame_count // 2)
    project.select_track(track)
    camera.live(3, lambda: shell.video.frame == project.frame)
    camera.live(2)
    camera.take("video")
    shell.video.camera_button.setChecked(True)
    shell.video.names_button.setChecked(False)
    project.select_track("")
    camera.take("video-camera")
    shell.video.camera_button.setChecked(False)
    shell.video.names_button.setChecked(True)
    _masks(shell, camera, track)
    _ground(shell, camera)


def _masks(shell: Shell, camera: Camera, track: str) -> None:
    """A mask being edited between its neighbours, and contacts that are proposed."""
    project = shell.project
    assert project is not None
    assert shell.opened is not None
    shell.opened.keeper.automatic = False
    shell.do("propose_contacts")
    places = [mark.at(project.frame) for mark in shell.video._marks]
    corners = np.array([place for place in places if place is not None])
    (left, top), (right, bottom) = corners.min(0) - 20, corners.max(0) + 20
    outline = np.array([(left, top + 12), (right - 12, top), (right, bottom), (left + 20, bottom + 8)])
    middle = np.add(outline.mean(0), [[-14, -8], [14, -8], [0, 14]]).tolist()
    steps = 0
    for frame, shift in ((project.frame - 8, -16), (project.frame + 8, 16), (project.frame, 0)):
        steps += project.edit(scene.add_lasso, frame, np.add(outline, [shift, 0]).tolist())
    steps += project.edit(scene.add_lasso, project.frame, middle, subtract=True)
    shell.video.onion_button.setChecked(True)
    shell.video.shown.mask_part = "corner/0/1"
    project.select_track(track)
    camera.take("video-masks")
    shell.video.onion_button.setChecked(False)
    for _ in range(steps):
        project.undo()
    shell.opened.keeper.automatic = True


def _ground(shell: Shell, camera: Camera) -> None:
    """Points of the scene chosen for the ground, with the grid and the horizon."""
    project = shell.project
    assert project is not None
    shell.do("tool_ground")
    shell.video.grid_button.setChecked(True)
    found = seen_points(project, shell.video.frame)
    low = found.index[np.argsort(-found.places[:, 1])]
    shell.video.shown.picked = tuple(low[:40:8].tolist())
    camera.take("video-ground")
    shell.video.grid_button.setChecked(False)
    shell.do("tool_select")


def _pairing(shell: Shell, camera: Camera) -> None:
    """A point is chosen and waits for its place on the character."""
    project = shell.project
    assert project is not None
    frame, tracks = project.frame, shell.character.tracks
    project.show_frame(0)
    camera.live(5, lambda: shell.character.frame == 0)
    tracks.pair_button.setChecked(True)
    tracks.names_button.setChecked(True)
    nose = next((track.id for track in project.document.tracks if track.name == "nose"), "")
    project.select_track(nose)
    project.select_vertex(project.document.character(project.character_id).pairs.get(nose, -1))
    tracks.pairing.emit(True)
    camera.take("character-pairing")
    tracks.names_button.setChecked(False)
    tracks.pair_button.setChecked(False)
    project.select_track("")
    project.show_frame(frame)
    camera.live(5, lambda: shell.character.frame == frame)


def _character(shell: Shell, camera: Camera) -> None:
    project = shell.project
    assert project is not None
    shell.do("character")
    camera.live(30, lambda: shell.character.mesh.viewport is not None)
    camera.live(2)
    camera.take("character-orbit")
    _pairing(shell, camera)
    shell.do("look_camera")
    character = project.document.character(project.character_id)
    names = {project.document.track(track).name: vertex for track, vertex in character.pairs.items()}
    vertex = next((names[name] for name in names if name in ("nose", "muzzle", "head")), next(iter(names.values())))
    project.select_vertex(vertex)
    camera.take("character-camera")
    shell.do("look_side")
    camera.take("character-side")
    shell.do("look_orbit")
    world, viewport = project.result(project.session.stages.world), shell.character.mesh.viewport
    if world is not None and viewport is not None:
        viewport.orbit_from(world.cameras[shell.character.frame])
    shown = shell.character.motion.vertices(shell.character.frame)
    if shown is not None and shell.character.posing is not None:
        x, y, z = (float(value) for value in shown[vertex])
        shell.character.events.pose(vertex, (x, y, z + 0.12), True)
        camera.live(90, lambda: bool(project.document.character(character.id).edits))
        camera.live(90, lambda: _quiet(shell))
        shell.do("ghosts")
        camera.live(1)
        camera.take("character-edited")
        shell.do("ghosts")
        _judged(shell, camera)


def _judged(shell: Shell, camera: Camera) -> None:
    """The edited motion as it is judged: camera and side at once, stretch, the paper's other ways, and its placing."""
    mesh = shell.character.mesh
    shell.do("split")
    camera.live(1)
    camera.take("character-split")
    shell.do("split")
    shell.do("look_orbit")
    mesh.bar.choose_heat("stretch")
    camera.live(5, lambda: mesh.heat is not None)
    camera.take("character-heat")
    mesh.bar.choose_heat("")
    mesh.bar.choose_all(True)
    camera.live(2)
    camera.live(120, lambda: _quiet(shell))
    camera.live(1)
    camera.take("character-compare")
    mesh.bar.choose_all(False)
    shell.do("gizmo_move")
    camera.live(5, lambda: shell.character.frame == 0)
    shell.do("look_camera")
    camera.live(1)
    camera.take("character-place")
    shell.do("cancel")
    shell.do("look_orbit")


if __name__ == "__main__":
    main()
