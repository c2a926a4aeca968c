"""What the parts of the Character workspace tell, and what follows from it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, SignalInstance

from app.window.character.pairing import POINT, START, VERTEX
from app.window.character.panes import SPLIT
from app.window.project import Project
from app.window.viewport import (
    GizmoMoved,
    GizmoMoving,
    GizmoReleased,
    VertexChosen,
    VertexMoved,
    VertexMoving,
    VertexReleased,
)

if TYPE_CHECKING:
    from app.window.character.workspace import CharacterWorkspace

HINT = (
    "Drag a vertex to pose the frame. Shift pulls it along its ray, Ctrl holds its image point only, X, Y, Z an axis."
)
PLACE = (
    "Drag an arrow, a ring or the character itself. Ctrl goes in steps, X, Y, Z hold an axis. Esc puts the gizmo away."
)
BEFORE = "This is the motion before its edits. A shows it with them, to be edited again."
NO_MOTION = "The character has no motion yet: solve it first, then pose it."


class Events(QObject):
    """Ties the parts together; belongs to one workspace."""

    def __init__(self, workspace: CharacterWorkspace) -> None:
        super().__init__(workspace)
        self.workspace = workspace
        self._tied: list[tuple[SignalInstance, Callable[..., Any]]] = []
        mesh, tracks, inspector = workspace.mesh, workspace.tracks, workspace.inspector
        mesh.happened.connect(self.happened)
        mesh.loaded.connect(workspace.refresh)
        mesh.pointed.connect(self._vertex_pointed)
        mesh.wanted.connect(workspace.wanted)
        mesh.bar.before.connect(self.show_before)
        mesh.bar.compared.connect(self._compare)
        mesh.bar.heated.connect(self._heat)
        mesh.bar.layer.connect(lambda *_: workspace.refresh())
        tracks.chosen.connect(self._track_chosen)
        tracks.pointed.connect(self._track_pointed)
        tracks.pairing.connect(self.pair)
        inspector.propagate.connect(workspace.run_wanted)
        inspector.vertex.placed.connect(self._typed)
        inspector.pairs.pairing.connect(self.pair)
        inspector.pairs.pointed.connect(self._row_pointed)
        inspector.moves.wanted.connect(workspace.command)
        workspace.warnings.wanted.connect(self.go_to_problem)

    def tie(self, project: Project) -> None:
        """Listen to the parts that belong to a project."""
        work = self.workspace
        posing, placing, source = work.posing, work.placing, work.source
        checks, heating, scenery = work.checks, work.heating, work.scenery
        assert posing is not None
        assert placing is not None
        assert source is not None
        assert checks is not None
        assert heating is not None
        assert scenery is not None
        inspector, tell = work.inspector, work.mesh.errors.tell
        for signal, call in (
            (source.loaded, work.refresh),
            (posing.changed, work.refresh),
            (posing.moved, work.show_pose),
            (posing.told, tell),
            (placing.changed, work.refresh),
            (placing.moved, work.show_pose),
            (placing.told, self._cannot_place),
            (checks.changed, work.refresh),
            (heating.found, work.mesh.show_heat),
            (heating.told, self._note),
            (scenery.found, work.mesh.show_background),
            (scenery.told, self._note),
            (project.partial, work.partial),
            (inspector.vertex.unmove, posing.delete_move),
            (inspector.vertex.mute, posing.mute),
            (inspector.vertex.forget, posing.delete_control_vertex),
            (inspector.moves.unmove, lambda frame, vertex: posing.delete_move(vertex, frame)),
            (inspector.moves.mute, lambda frame, vertex, muted: posing.mute(vertex, muted, frame)),
            (inspector.place_in_first.mode_wanted, self.place),
            (inspector.place_in_first.changing, placing.trying),
            (inspector.place_in_first.hand_wanted, placing.by_hand),
            (inspector.place_in_first.reset_wanted, placing.reset),
        ):
            signal.connect(call)
            self._tied.append((signal, call))

    def untie(self) -> None:
        """Listen to them no longer."""
        for signal, call in self._tied:
            signal.disconnect(call)
        self._tied = []
        self.workspace.pairing.stop()
        self._show_pairing()

    # saying ------------------------------------------------------------------------------------------------------

    def say(self) -> None:
        """Say what the mouse will do."""
        work = self.workspace
        project, pairing = work.project, work.pairing
        if project is None:
            return
        if pairing.on and pairing.track in {track.id for track in project.document.tracks}:
            work.hint.emit(POINT.format(project.document.track(pairing.track).name))
        elif pairing.on:
            work.hint.emit(VERTEX.format(f"Vertex {pairing.vertex:,}") if pairing.vertex >= 0 else START)
        elif work.placing is not None and work.placing.mode is not None:
            work.hint.emit(PLACE)
        else:
            work.hint.emit(BEFORE if work.before_edits else HINT)

    def _note(self, sentence: str) -> None:
        work = self.workspace
        work.mesh.bar.heat = work.heating.kind if work.heating is not None else ""
        work.mesh.errors.tell(sentence, level="note")

    def _cannot_place(self, sentence: str, details: str) -> None:
        work = self.workspace
        work.mesh.errors.tell(sentence, level="note", action=("Run what is missing", work.run_wanted.emit))

    # the mouse ---------------------------------------------------------------------------------------------------

    def happened(self, event: object) -> None:
        """Take what was done in a 3D view."""
        work = self.workspace
        posing, placing = work.posing, work.placing
        if work.project is None or work.character is None or posing is None or placing is None:
            return
        if isinstance(event, VertexChosen):
            self._vertex_chosen(event.vertex)
        elif isinstance(event, VertexMoving | VertexMoved):
            self.pose(event.vertex, event.place, isinstance(event, VertexMoved), on_ray=event.on_ray)
        elif isinstance(event, VertexReleased):
            posing.cancel()
        elif isinstance(event, GizmoMoving):
            placing.moving(event.change)
        elif isinstance(event, GizmoMoved):
            placing.done(event.change)
        elif isinstance(event, GizmoReleased):
            placing.released()

    def pose(self, vertex: int, place: tuple[float, float, float], end: bool, *, on_ray: bool = False) -> None:
        """Put a vertex of the frame in sight somewhere; ``end`` decides it."""
        work = self.workspace
        character, posing, project = work.character, work.posing, work.project
        if character is None or posing is None or project is None:
            return
        shown = work.motion.vertices(work.frame)
        if shown is None or not posing.possible(character):
            action = ("Run what is missing", work.run_wanted.emit)
            work.mesh.errors.tell(NO_MOTION, level="note", action=action)
            return
        project.select_vertex(vertex)
        posing.move(character, work.frame, shown, vertex, place, on_ray=on_ray)
        if end:
            posing.release()

    def _typed(self, vertex: int, place: tuple[float, float, float], on_ray: bool) -> None:
        self.pose(vertex, place, True, on_ray=on_ray)

    # pairing -----------------------------------------------------------------------------------------------------

    def pair(self, on: bool) -> None:
        """Begin or end pairing by two clicks."""
        work = self.workspace
        if on and work.project is not None:
            work.pairing.start(work.project.track_id)
        else:
            work.pairing.stop()
        self._show_pairing()
        self.say()

    def _show_pairing(self) -> None:
        work = self.workspace
        for button in (work.tracks.pair_button, work.inspector.pairs.button):
            button.blockSignals(True)
            button.setChecked(work.pairing.on)
            button.blockSignals(False)

    def _vertex_chosen(self, vertex: int) -> None:
        work = self.workspace
        assert work.project is not None
        pair = work.pairing.click_vertex(vertex) if work.pairing.on else None
        work.project.select_vertex(vertex)
        self._paired(pair)

    def _track_chosen(self, track_id: str) -> None:
        work = self.workspace
        if work.project is None:
            return
        pair = work.pairing.click_track(track_id) if work.pairing.on else None
        work.project.select_track(track_id)
        self._paired(pair)

    def _paired(self, pair: tuple[str, int] | None) -> None:
        work = self.workspace
        character = work.character
        if pair is not None and character is not None and work.posing is not None:
            work.posing.pair(character, *pair)
        self.say()
        work.refresh()

    # pointing ----------------------------------------------------------------------------------------------------

    def _vertex_pointed(self, vertex: int) -> None:
        work, character = self.workspace, self.workspace.character
        if character is not None:
            work.tracks.highlight(next((name for name, at in character.pairs.items() if at == vertex), ""))

    def _track_pointed(self, track_id: str) -> None:
        work, character = self.workspace, self.workspace.character
        if character is not None:
            work.mesh.highlight(character.pairs.get(track_id, -1))

    def _row_pointed(self, track_id: str) -> None:
        self._track_pointed(track_id)
        self.workspace.tracks.highlight(track_id)

    # views -------------------------------------------------------------------------------------------------------

    def place(self, mode: str) -> None:
        """Take the gizmo in hand, or put it away."""
        work = self.workspace
        if work.placing is not None:
            if mode:
                self.pair(False)
                work.inspector.place_in_first.open()
                work.inspector.ensureWidgetVisible(work.inspector.place_in_first)
            work.placing.choose(mode)
            work.placing.find()
            self.say()

    def show_before(self, on: bool) -> None:
        """Show the motion before its edits, or with them."""
        work = self.workspace
        work.before_edits = on
        work.mesh.bar.before_button.blockSignals(True)
        work.mesh.bar.before_button.setChecked(on)
        work.mesh.bar.before_button.blockSignals(False)
        work.mesh.allow_grabbing(not on)
        self.say()
        work.refresh()

    def _compare(self, variants: list[str]) -> None:
        work = self.workspace
        split = [SPLIT] if SPLIT in work.mesh.panes.panes else []
        work.mesh.show_panes([*split, *variants])
        if work.comparing is not None:
            work.comparing.choose(variants)
        work.refresh()

    def _heat(self, kind: str) -> None:
        work = self.workspace
        if work.heating is not None:
            work.heating.choose(kind)
            vertices = work.pose()
            if vertices is not None:
                work.heating.want(work.frame, vertices)
            work.refresh()

    def go_to_problem(self, which: str) -> None:
        """Go to the worst problem, the next or the one before."""
        work = self.workspace
        problem = work.checks.find(which) if work.checks is not None else None
        if work.project is None:
            return
        if problem is None:
            work.say("No problem was found in this motion")
            return
        if problem.vertex >= 0:
            work.project.select_vertex(problem.vertex)
        work.inspector.go.emit(problem.worst)
        work.say(problem.text)
        work.refresh()
