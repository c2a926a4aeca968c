"""Pictures of the Motion graph with real content: a person's takes, made once and kept in build/."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from app.actions import performing
from app.actions.session import Session
from app.formats.tvm import FrameMesh, write_mesh_frames
from app.model.edits import performance as edits
from app.window.shell import Shell
from resources.performer import Part, perform

FPS, CELL = 25, 0.032
TAKES = {
    "Walk": (Part("walk", 4.0),),
    "Run": (Part("run", 5.0),),
    "Gymnastics": tuple(Part(name, 2.6) for name in ("jumping jack", "squat", "twist", "kick", "march")),
}


class Taker(Protocol):
    """Lets the window live and takes pictures of it."""

    def live(self, seconds: float, until: Callable[[], bool] | None = None) -> None:
        """Let the window live."""

    def take(self, name: str) -> None:
        """Take a picture at each size."""


def performed(place: Path) -> Path:
    """The takes as a project with its motion graph; what is there is not made again."""
    if not place.exists():
        session = Session.new(place)
        for number, (name, parts) in enumerate(TAKES.items(), start=1):
            capture = perform(list(parts), fps=FPS, seed=number, cell=CELL)
            target = place.parent / f"{name}.npz"
            frames = (FrameMesh(*capture.mesh(frame)) for frame in range(len(capture)))
            write_mesh_frames(target, frames, form="npz", fps=FPS, count=len(capture), name=name)
            performing.add_sequence(session, target, name=name, copy=True)
            target.unlink()
        session.result(session.stages.graph)
        session.save()
        session.close()
    return place


def take_performance(shell: Shell, camera: Taker, place: Path) -> None:
    """The empty workspace, a composed performance, the size being dragged, a gap, the self-similarity."""
    shell.open_session(Session.new())
    shell.do("performance")
    camera.take("motion-graph-empty")
    shell.open_session(Session.open(performed(place)))
    shell.do("performance")
    page = shell.performance
    state, project = page.state, shell.project
    assert project is not None
    camera.live(60, lambda: bool(page.graph.canvas.picture.nodes))
    nodes = {motion.name: motion.node for motion in state.motions}
    for name in ("Walk/1", "Run/1", "Gymnastics/2"):
        page.editing.append(nodes[name])
    page.editing.repeat(0, 1)
    camera.live(180, lambda: state.blends is not None)
    state.select_node(nodes["Run/1"])
    state.select_sequence(state.document.sequences[-1].id)
    cut = next(cut for cut in state.performance.cuts if cut.kind == "cut")
    state.show_position(cut.position)
    camera.live(8, lambda: page.preview.shown == cut.position)
    camera.take("motion-graph")
    page.strip.matrix_button.setChecked(True)
    camera.live(2)
    camera.take("motion-graph-similarity")
    page.strip.matrix_button.setChecked(False)
    page.trial.want(0.3)
    camera.live(5, lambda: page.trial.result is not None)
    camera.take("motion-graph-size")
    page.trial.drop()
    _gap(shell, camera, nodes)
    project.cancel_work()
    project.session.history.mark_saved()


def _gap(shell: Shell, camera: Taker, nodes: dict[str, int]) -> None:
    """Motions on the way are forbidden until a key motion is out of reach."""
    page, project = shell.performance, shell.project
    assert project is not None
    state = page.state
    keys = {state.motion_node(key.motion) for key in state.document.performance.keys}
    for node in nodes.values():
        if node not in keys and not state.problem:
            project.edit(edits.set_forbidden, state.motions[node].motion, True)
            camera.live(20, lambda: bool(state.problem or state.paths))
    camera.live(1)
    if state.gap is not None:
        camera.take("motion-graph-gap")
