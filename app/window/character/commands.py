"""The commands of the Character workspace by their names."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from app.window.character.workspace import CharacterWorkspace

STEP_PIXELS, STEP_METRES, FAR = 0.25, 0.001, 10.0
DIRECTIONS = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "up": (0.0, -1.0), "down": (0.0, 1.0)}


def command(work: CharacterWorkspace, name: str) -> bool:
    """Do a command; says whether it was one."""
    if name.startswith("nudge_"):
        direction, _, far = name.removeprefix("nudge_").partition("_")
        nudge(work, *DIRECTIONS[direction], FAR if far else 1.0)
        return True
    if name == "cancel":
        return _cancel(work)
    if name == "undo":
        return _take_back_strokes(work)
    if name == "propagate":
        if work.posing is not None and work.posing.nudging:
            work.posing.release()
        if work.comparing is not None:
            work.comparing.again()
        return False
    handler = _handlers(work).get(name)
    if handler is not None:
        handler()
    return handler is not None


def _handlers(work: CharacterWorkspace) -> dict[str, Callable[[], object]]:
    mesh, events, posing, project = work.mesh, work.events, work.posing, work.project
    vertex = project.vertex if project is not None else -1
    return {
        "fit": mesh.fit,
        "ghosts": mesh.ghost_button.toggle,
        "overlay": lambda: mesh.opacity.setValue(40 if mesh.opacity.value() > 70 else 100),
        "look_camera": lambda: mesh.look("camera"),
        "look_side": lambda: mesh.look("side"),
        "look_orbit": lambda: mesh.look("orbit"),
        "split": lambda: mesh.part(not mesh.split_button.isChecked()),
        "hide_point": lambda: mesh.part(not mesh.split_button.isChecked()),
        "before_after": lambda: events.show_before(not work.before_edits),
        "heat": mesh.bar.next_heat,
        "magnifier": work.tracks.magnifier_button.toggle,
        "next_track": work.tracks.next_track,
        "pair": lambda: events.pair(not work.pairing.on),
        "gizmo_move": lambda: _gizmo(work, "move"),
        "gizmo_rotate": lambda: _gizmo(work, "rotate"),
        "gizmo_scale": lambda: _gizmo(work, "scale"),
        "next_problem": lambda: events.go_to_problem("next"),
        "previous_problem": lambda: events.go_to_problem("previous"),
        "delete": lambda: posing.delete_selected() if posing else None,
        "delete_vertex": lambda: posing.delete_control_vertex(vertex) if posing and vertex >= 0 else None,
        "copy_pose": lambda: _copy(work),
        "paste_pose": lambda: _paste(work),
    }


def _gizmo(work: CharacterWorkspace, mode: str) -> None:
    now = work.placing.mode if work.placing is not None else None
    work.events.place("" if now == mode else mode)


def _copy(work: CharacterWorkspace) -> None:
    if work.posing is not None and work.project is not None:
        work.say(work.posing.copy_pose(work.project.frame))
        work.refresh()


def _paste(work: CharacterWorkspace) -> None:
    if work.posing is not None and work.project is not None:
        sentence = work.posing.paste_pose(work.project.frame)
        if sentence:
            work.say(sentence)


def _cancel(work: CharacterWorkspace) -> bool:
    """Give up what the hand holds, strokes of keys, pairing, the gizmo or the view before the edits."""
    if work.mesh.cancel() or _take_back_strokes(work):
        return True
    if work.pairing.on:
        work.events.pair(False)
        return True
    if work.placing is not None and work.placing.mode is not None:
        work.events.place("")
        return True
    if work.before_edits:
        work.events.show_before(False)
        return True
    return False


def _take_back_strokes(work: CharacterWorkspace) -> bool:
    """Take back strokes of keys that were not committed yet; says whether there were any."""
    if work.posing is None or not work.posing.nudging:
        return False
    work.posing.cancel()
    return True


def nudge(work: CharacterWorkspace, right: float, down: float, far: float) -> None:
    """Move the selected vertex, or the character while it is placed, in the plane of the view.

    A step is a quarter of a pixel of the film where one looks through its camera, else a millimetre; where no length
    is known, a thousandth of the character's height.
    """
    project, view, character, posing = work.project, work.mesh.viewport, work.character, work.posing
    shown = work.motion.vertices(work.frame)
    if project is None or view is None or character is None or posing is None or shown is None:
        return
    placing = work.placing is not None and work.placing.mode is not None and work.frame == 0
    if not placing and project.vertex < 0:
        work.say("Choose a vertex first: the keys then move it")
        return
    start = shown.mean(axis=0) if placing else shown[project.vertex]
    camera = view.lens().camera
    if view.through_camera and view.camera is not None:
        size = STEP_PIXELS * float(view.camera.depth(start)) / float(view.camera.K[1, 1])
    else:
        world = project.result(project.session.stages.world)
        size = STEP_METRES * (1.0 if world is not None and world.metric else float(np.ptp(shown[:, 2])))
    step = far * size * (right * camera.R[0] + down * camera.R[1])
    if placing and work.placing is not None:
        work.placing.nudge(step)
    elif posing.possible(character):
        posing.nudge(character, work.frame, shown, project.vertex, step)
