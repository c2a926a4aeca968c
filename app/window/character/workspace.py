"""The Character workspace: see the motion over the video or in space, drag a vertex, watch it spread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QHBoxLayout, QSplitter

from app.model.character import Character
from app.model.document import Document
from app.stages.stage import Stage
from app.window.character.handles_of import handles
from app.window.character.inspector import CharacterInspector
from app.window.character.mesh_source import MeshSource
from app.window.character.mesh_view import MeshView
from app.window.character.motion import Motion
from app.window.character.posing import Posing
from app.window.character.track_view import TrackView
from app.window.controls import Panel
from app.window.frames import FrameLoader
from app.window.lanes_of import CHARACTER_LEGEND, character_lanes
from app.window.project import Project
from app.window.timeline import Lane
from app.window.timeline.transport import Entry
from app.window.viewport import VertexChosen, VertexMoved, VertexMoving, VertexReleased
from app.window.viewport.hosts import Choice
from app.window.workspaces import Workspace

HINT = "Click a vertex to select it, drag it to pose the frame. Shift moves it in depth; X, Y, Z hold an axis."
PAIR = "{} is chosen: click its place on the character to pair them. Esc ends pairing."
GHOSTS = (-8, -4, 4, 8)


class CharacterWorkspace(Workspace):
    """Shows a character in a frame; what the mouse does becomes edits, which spread."""

    def __init__(self, choice: Choice = "auto") -> None:
        super().__init__()
        self.project: Project | None = None
        self.motion = Motion()
        self.source: MeshSource | None = None
        self.posing: Posing | None = None
        self.frame = 0
        self.picture = QImage()
        self.tracks = TrackView()
        self.mesh = MeshView(choice)
        self.errors = self.mesh.errors
        self.mesh.ghosts = self._ghosts
        self.mesh.happened.connect(self._happened)
        self.mesh.loaded.connect(self.refresh)
        self.mesh.calm = lambda: self.project is None or not self.project.progress
        self.tracks.pairing.connect(lambda _: self._say())
        self.inspector = CharacterInspector()
        side = Panel()
        side.setFixedWidth(304)
        side.column.addWidget(self.inspector)
        self.inspector.rows.setContentsMargins(12, 12, 12, 12)
        self.inspector.propagate.connect(self.run_wanted)
        self.inspector.placed.connect(lambda vertex, place: self._pose(vertex, place, True))
        splitter = QSplitter(Qt.Orientation.Horizontal)
        splitter.setHandleWidth(8)
        splitter.setChildrenCollapsible(False)
        splitter.addWidget(self.tracks)
        splitter.addWidget(self.mesh)
        splitter.setStretchFactor(0, 4)
        splitter.setStretchFactor(1, 6)
        splitter.setSizes([440, 660])
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        row.addWidget(splitter, 1)
        row.addWidget(side)

    # showing -----------------------------------------------------------------------------------------------------

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.detach()
        self.project = project
        self.motion = Motion()
        self.mesh.clear()
        self.source = MeshSource(project, self)
        self.source.loaded.connect(self.refresh)
        self.posing = Posing(project, self.motion, self)
        self.posing.changed.connect(self.refresh)
        self.posing.moved.connect(self.show_pose)
        self.posing.told.connect(self.mesh.errors.tell)
        self.inspector.unmove.connect(self.posing.delete_move)
        self.inspector.mute.connect(self.posing.mute)
        self.tracks.attach(project, loader)
        project.partial.connect(self._partial)

    def detach(self) -> None:
        """Let go of the project."""
        if self.posing is not None:
            self.inspector.unmove.disconnect(self.posing.delete_move)
            self.inspector.mute.disconnect(self.posing.mute)
            self.posing.close()
            self.posing = None
        if self.source is not None:
            self.source.close()
            self.source = None
        self.project = None

    def close_view(self) -> None:
        """Close the 3D view; it cannot be shown again."""
        self.detach()
        self.mesh.finish()

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Show the tracks over another clip."""
        self.tracks.attach(project, loader)

    def lanes(self) -> list[Lane]:
        """Tracks, contacts, edited poses, and how far the solution is."""
        project = self.project
        return character_lanes(project, self.motion.solved(project.frame_count)) if project is not None else []

    def legend(self) -> Sequence[Entry]:
        """Give the legend of the lanes."""
        return CHARACTER_LEGEND

    def device(self) -> str:
        """Name what draws in 3D."""
        viewport = self.mesh.viewport
        return f"3D: {viewport.host.name}" if viewport is not None else ""

    def say(self, sentence: str) -> None:
        """Say something in passing, over the picture."""
        self.tracks.notes.say(sentence)

    def show_picture(self, frame: int, picture: QImage) -> None:
        """Show a frame: its picture, the pose, its marks."""
        if self.posing is not None and frame != self.frame:
            self.posing.leave()
        self.frame, self.picture = frame, picture
        self.tracks.show_picture(frame, picture)
        self.refresh()

    def document_changed(self, before: Document, after: Document) -> None:
        """Show the document as it is."""
        self.refresh()

    def refresh(self) -> None:
        """Show the project as it is; nothing in 3D is loaded while the workspace is hidden."""
        project = self.project
        if project is None:
            return
        self.motion.read(project)
        self.tracks.refresh()
        character = self._character()
        vertices = self.motion.vertices(self.frame) if character is not None else None
        place = None
        if vertices is not None and 0 <= project.vertex < len(vertices):
            x, y, z = (float(value) for value in vertices[project.vertex])
            place = (x, y, z)
        self.inspector.show_character(project, place)
        if self.isVisible():
            self._show_mesh(character, vertices)
        self.lanes_changed.emit()

    def show_pose(self) -> None:
        """Show the pose of the frame and its handles, nothing else: it follows the mouse."""
        character = self._character()
        vertices = self.motion.vertices(self.frame)
        viewport = self.mesh.viewport
        if self.project is None or character is None or vertices is None or viewport is None or not self.isVisible():
            return
        if len(vertices) == len(viewport.vertices):
            viewport.move_mesh(vertices)
            before = self.posing.before if self.posing is not None else None
            self.mesh.show_handles(handles(self.project, character, vertices, before))

    def showEvent(self, event: Any) -> None:
        """Bring the 3D view up to date when the workspace comes into sight."""
        super().showEvent(event)
        self.refresh()
        self._say()

    def _character(self) -> Character | None:
        if self.project is None:
            return None
        wanted = self.project.character_id
        return next((each for each in self.project.document.characters if each.id == wanted), None)

    def _show_mesh(self, character: Character | None, vertices: Any) -> None:
        project = self.project
        assert project is not None
        assert self.source is not None
        if character is None:
            self.mesh.clear()
            self.mesh.header.caption.setText("Choose a character mesh: Project menu, Add a character.")
            return
        shape = self.source.shape(character)
        if not self.mesh.ready() or shape is None:
            return
        if vertices is None:
            vertices = shape.standing
        if len(vertices) != len(shape.standing):
            return
        if self.posing is not None:
            self.posing.make_ready(character)
        self.mesh.header.title.setText(character.name)
        self.mesh.header.caption.setText(f"{len(vertices):,} vertices  ·  {len(character.pairs)} pairs")
        self.mesh.show_mesh(vertices, shape.faces, shape.colours)
        world = project.result(project.session.stages.world)
        if world is not None and self.frame < len(world.cameras):
            self.mesh.show_camera(world.cameras[self.frame], self.picture)
            self.mesh.show_scene(world.cameras.points, world.cameras.centres, float(world.offset))
        else:
            self.mesh.show_camera(None, None)
            self.mesh.show_scene(vertices[:0], vertices[:0], float(vertices[:, 2].min()))
        before = self.posing.before if self.posing is not None else None
        self.mesh.show_handles(handles(project, character, vertices, before))
        if self.mesh.notes is not None:
            state = project.motion_state(character.id)
            words = {"fresh": ("up to date", "ok"), "running": ("being solved", "accent"), "stale": ("waiting", "warn")}
            self.mesh.notes.show_frame(self.frame, project.frame_count, self.frame / max(project.fps, 1e-9))
            self.mesh.notes.show_right(*words.get(state, ("not solved yet", "text3")))

    def _ghosts(self) -> list[tuple[int, Any]]:
        if self.project is None:
            return []
        frames = [(step, self.frame + step) for step in GHOSTS]
        count = self.project.frame_count
        poses = [(step, self.motion.vertices(frame)) for step, frame in frames if 0 <= frame < count]
        return [(step, pose) for step, pose in poses if pose is not None]

    def _partial(self, stage: Stage, value: Any) -> None:
        frame = self.motion.take(stage, value)
        if frame is None:
            return
        if frame == self.frame:
            self.show_pose()
        self.lanes_changed.emit()

    # the mouse ---------------------------------------------------------------------------------------------------

    def _say(self) -> None:
        project = self.project
        if project is not None and self.tracks.pair_button.isChecked() and project.track_id:
            self.hint.emit(PAIR.format(project.document.track(project.track_id).name))
        else:
            self.hint.emit(HINT)

    def _happened(self, event: object) -> None:
        project, character, posing = self.project, self._character(), self.posing
        if project is None or character is None or posing is None:
            return
        if isinstance(event, VertexChosen):
            if self.tracks.pair_button.isChecked() and project.track_id:
                posing.pair(character, project.track_id, event.vertex)
                self._say()
            project.select_vertex(event.vertex)
            self.refresh()
        elif isinstance(event, VertexMoving):
            self._pose(event.vertex, event.place, False)
        elif isinstance(event, VertexMoved):
            self._pose(event.vertex, event.place, True)
        elif isinstance(event, VertexReleased):
            posing.cancel()

    def _pose(self, vertex: int, place: tuple[float, float, float], end: bool) -> None:
        character = self._character()
        if character is None or self.posing is None or self.project is None:
            return
        shown = self.motion.vertices(self.frame)
        if shown is None or not self.posing.possible(character):
            text = "The character has no motion yet: solve it first, then pose it."
            self.mesh.errors.tell(text, level="note", action=("Run what is missing", self.run_wanted.emit))
            return
        self.project.select_vertex(vertex)
        self.posing.move(character, self.frame, shown, vertex, place)
        if end:
            self.posing.release()

    # commands ----------------------------------------------------------------------------------------------------

    def command(self, name: str) -> bool:
        """Do a command of this workspace; says whether it was one."""
        handlers: dict[str, Callable[[], object]] = {
            "fit": self.mesh.fit,
            "ghosts": self.mesh.ghost_button.toggle,
            "overlay": lambda: self.mesh.opacity.setValue(40 if self.mesh.opacity.value() > 70 else 100),
            "look_camera": lambda: self.mesh.look("camera"),
            "look_side": lambda: self.mesh.look("side"),
            "look_orbit": lambda: self.mesh.look("orbit"),
            "magnifier": self.tracks.magnifier_button.toggle,
            "next_track": self.tracks.next_track,
            "delete": lambda: self.posing.delete_selected() if self.posing else None,
        }
        if name == "cancel":
            viewport = self.mesh.viewport
            if viewport is not None and viewport.cancel():
                return True
            if self.tracks.pair_button.isChecked():
                self.tracks.pair_button.setChecked(False)
                return True
            return False
        if name not in handlers:
            return False
        handlers[name]()
        return True
