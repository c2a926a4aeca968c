"""The Character workspace: see the motion over the video or in space, drag a vertex, watch it spread."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QHBoxLayout, QSplitter

from app.actions.checking import drift_in_frame, drift_limit
from app.model.character import Character
from app.model.document import Document
from app.stages.stage import Stage
from app.window.character.checks import Checks
from app.window.character.commands import command
from app.window.character.comparing import Comparing
from app.window.character.events import Events
from app.window.character.handles_of import handles
from app.window.character.heating import Heating
from app.window.character.inspector import CharacterInspector
from app.window.character.mesh_source import MeshSource
from app.window.character.mesh_view import MeshView
from app.window.character.motion import Motion
from app.window.character.overlays import Trail
from app.window.character.pairing import Pairing
from app.window.character.placing import Placing
from app.window.character.posing import Posing
from app.window.character.scenery import Scenery
from app.window.character.track_view import TrackView
from app.window.character.trails import filmed_trails, trails
from app.window.character.warning_line import WarningLine
from app.window.controls import Panel
from app.window.fold_away import FoldAway
from app.window.frames import FrameLoader
from app.window.lanes_of import CHARACTER_LEGEND, character_lanes
from app.window.project import Project
from app.window.timeline import Lane
from app.window.timeline.transport import Entry
from app.window.viewport.hosts import Choice
from app.window.workspaces import Workspace

GHOSTS = (-8, -4, 4, 8)
STATES = {"fresh": ("up to date", "ok"), "running": ("being solved", "accent"), "stale": ("waiting", "warn")}


class CharacterWorkspace(Workspace):
    """Shows a character in a frame; what the mouse does becomes edits, which spread."""

    def __init__(self, choice: Choice = "auto") -> None:
        super().__init__()
        self.project: Project | None = None
        self.motion = Motion()
        self.pairing = Pairing()
        self.source: MeshSource | None = None
        self.posing: Posing | None = None
        self.placing: Placing | None = None
        self.checks: Checks | None = None
        self.heating: Heating | None = None
        self.comparing: Comparing | None = None
        self.scenery: Scenery | None = None
        self.frame = 0
        self.picture = QImage()
        self.before_edits = False
        self.tracks = TrackView()
        self.mesh = MeshView(choice)
        self.errors = self.mesh.errors
        self.inspector = CharacterInspector()
        self.warnings = WarningLine()
        self.mesh.over.ghosts = self._ghosts
        self.mesh.over.trails = self._trails
        self.mesh.calm = lambda: self.project is None or not self.project.progress
        self._lay_out()
        self.events = Events(self)

    def _lay_out(self) -> None:
        side = Panel()
        self.aside = FoldAway("character", "Character, vertex, edits", 304)
        self.aside.column.addWidget(side)
        side.column.addWidget(self.inspector, 1)
        side.column.addWidget(self.warnings)
        self.inspector.rows.setContentsMargins(12, 12, 12, 12)
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
        row.setSpacing(0)
        row.addWidget(splitter, 1)
        row.addWidget(self.aside)

    # the project -------------------------------------------------------------------------------------------------

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.detach()
        self.project = project
        self.motion = Motion()
        self.mesh.clear()
        self.source = MeshSource(project, self)
        self.posing = Posing(project, self.motion, self)
        self.placing = Placing(project, self.motion, self)
        self.checks, self.heating = Checks(project, self), Heating(project, self)
        self.comparing, self.scenery = Comparing(project, self), Scenery(project, self)
        self.mesh.bar.missing = self.scenery.missing
        self.heating.choose(self.mesh.bar.heat)
        self.comparing.choose(self.mesh.bar.variants)
        self.events.tie(project)
        self.tracks.attach(project, loader)

    def detach(self) -> None:
        """Let go of the project."""
        self.events.untie()
        for part in (self.posing, self.source, self.checks, self.heating, self.scenery):
            if part is not None:
                part.close()
        self.posing = self.placing = self.source = self.checks = self.heating = None
        self.comparing = self.scenery = self.project = None
        self.mesh.bar.missing = dict

    def close_view(self) -> None:
        """Close the 3D view; it cannot be shown again."""
        self.detach()
        self.mesh.finish()

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Show the tracks over another clip."""
        self.tracks.attach(project, loader)

    # what the window asks ----------------------------------------------------------------------------------------

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
        before, self.frame, self.picture = self.frame, frame, picture
        self.tracks.show_picture(frame, picture)
        self._show()
        character = self.character
        if character is not None and not character.edits.keys().isdisjoint((before, frame)):
            self.lanes_changed.emit()  # an edit of the frame in sight is drawn otherwise; nothing else hangs on it

    def document_changed(self, before: Document, after: Document) -> None:
        """Take the document as it is, and list it; pictures are made once whatever changes it is through."""
        if self.placing is not None:
            self.placing.follow(before, after)
        if self.project is not None:
            self.motion.read(self.project)
            if self.isVisible():
                self._list(self.project)

    def command(self, name: str) -> bool:
        """Do a command of this workspace; says whether it was one."""
        return command(self, name)

    def showEvent(self, event: Any) -> None:
        """Bring the 3D view up to date when the workspace comes into sight."""
        super().showEvent(event)
        self.refresh()
        self.events.say()

    # showing -----------------------------------------------------------------------------------------------------

    @property
    def character(self) -> Character | None:
        """The character chosen."""
        if self.project is None:
            return None
        wanted = self.project.character_id
        return next((each for each in self.project.document.characters if each.id == wanted), None)

    def pose(self) -> NDArray[np.float64] | None:
        """The vertices (v, 3) that are shown, None where the character has not even been placed."""
        if self.before_edits and (found := self.motion.before_edits(self.frame)) is not None:
            return found
        return self.motion.vertices(self.frame)

    def refresh(self) -> None:
        """Show the project as it is; while the workspace is hidden nothing is loaded and nothing is drawn."""
        self._show()
        if self.isVisible():
            self.lanes_changed.emit()

    def _show(self) -> None:
        project = self.project
        if project is None:
            return
        self.motion.read(project)
        if not self.isVisible():
            return
        self.tracks.refresh()
        vertices = self._list(project)
        self._show_mesh(self.character, vertices)
        self._show_checks(self.character)

    def _list(self, project: Project) -> NDArray[np.float64] | None:
        """Show in the inspector what there is; gives the pose in sight."""
        vertices = self.pose() if self.character is not None else None
        place = None
        if vertices is not None and 0 <= project.vertex < len(vertices):
            x, y, z = (float(value) for value in vertices[project.vertex])
            place = (x, y, z)
        mode = self.placing.mode if self.placing is not None else None
        copied = self.posing is not None and self.posing.copy is not None
        self.inspector.show_character(project, place, mode=mode or "", copied=copied)
        return vertices

    def show_pose(self) -> None:
        """Show the pose of the frame and its handles, nothing else: it follows the mouse."""
        character = self.character
        vertices = self.pose()
        viewport = self.mesh.viewport
        if self.project is None or character is None or vertices is None or viewport is None or not self.isVisible():
            return
        if len(vertices) == len(viewport.vertices):
            self.mesh.move_mesh(vertices)
            self._show_handles(character, vertices)
            if self.heating is not None:
                self.heating.want(self.frame, vertices)

    def _show_mesh(self, character: Character | None, vertices: Any) -> None:
        project, source = self.project, self.source
        assert project is not None
        assert source is not None
        self.mesh.show_empty(character is not None, bool(project.document.tracks))
        if character is None:
            self.mesh.clear()
            self.mesh.header.caption.setText("")
            return
        shape = source.shape(character)
        if not self.mesh.ready() or shape is None:
            return
        if vertices is None:
            vertices = shape.standing
        if len(vertices) != len(shape.standing):
            return
        if self.posing is not None:
            self.posing.make_ready(character)
            self.posing.show_committed(character, self.frame)
        self.mesh.header.title.setText(character.name)
        self.mesh.header.caption.setText(f"{len(vertices):,} vertices")
        self.mesh.show_mesh(vertices, shape.faces, shape.colours, self.frame)
        self._show_world(vertices)
        self._show_handles(character, vertices)
        self._show_compared(shape.faces, shape.colours)
        if self.heating is not None:
            self.heating.want(self.frame, vertices)
        if self.scenery is not None:
            self.scenery.keep_up(self.mesh.bar.layers, over_film=self.mesh.bar.over_film)
        self._show_notes(character)

    def _show_world(self, vertices: NDArray[np.float64]) -> None:
        project = self.project
        assert project is not None
        world = project.result(project.session.stages.world)
        if world is not None and self.frame < len(world.cameras):
            self.mesh.show_camera(world.cameras[self.frame], self.picture)
            self.mesh.show_scene(world.cameras.points, world.cameras.centres, float(world.offset))
        else:
            self.mesh.show_camera(None, None)
            self.mesh.show_scene(vertices[:0], vertices[:0], float(vertices[:, 2].min()))

    def _show_handles(self, character: Character, vertices: NDArray[np.float64]) -> None:
        project = self.project
        assert project is not None
        self.mesh.show_gizmo(self.placing.gizmo(vertices) if self.placing is not None else None)
        away = drift_in_frame(project.session, character.id, self.frame, vertices)
        check = self.checks.check if self.checks is not None and self.checks.fresh else None
        limit = drift_limit(project.session) if check is None else check.limit
        world = project.result(project.session.stages.world)
        made = handles(
            project,
            character,
            vertices,
            self.posing.before if self.posing is not None else None,
            unedited=self.motion.before_edits(self.frame),
            away=away,
            limit=limit,
            metric=world is None or world.metric,
        )
        self.mesh.show_handles(made)
        if not self.mesh.dragging:
            stretch = check.stretch[self.frame] if check is not None and self.frame < len(check.stretch) else None
            self.inspector.show_fit(away, limit, None if stretch is None else (float(stretch[0]), float(stretch[1])))

    def _show_compared(self, faces: Any, colours: Any) -> None:
        if self.comparing is not None:
            for variant in self.comparing.chosen:
                pose, title, token = self.comparing.pose(variant, self.frame)
                self.mesh.show_compared(variant, pose, faces, colours, title, token)

    def _show_notes(self, character: Character) -> None:
        project, notes = self.project, self.mesh.notes
        if notes is None or project is None:
            return
        notes.show_frame(self.frame, project.frame_count, self.frame / max(project.fps, 1e-9))
        if self.before_edits:
            notes.show_right("before the edits", "edit")
        else:
            notes.show_right(*STATES.get(project.motion_state(character.id), ("not solved yet", "text3")))

    def _show_checks(self, character: Character | None) -> None:
        checks = self.checks
        if checks is None or character is None:
            self.warnings.setVisible(False)
            return
        checks.keep_up()
        if self.mesh.bar.heat == "sunk":
            checks.meet_background()
        self.warnings.setVisible(True)
        self.warnings.show_check(checks.check if checks.fresh else None, measuring=checks.measuring, at=checks.at)

    def _ghosts(self) -> list[tuple[int, Any]]:
        if self.project is None:
            return []
        frames = [(step, self.frame + step) for step in GHOSTS]
        count = self.project.frame_count
        poses = [(step, self.motion.vertices(frame)) for step, frame in frames if 0 <= frame < count]
        return [(step, pose) for step, pose in poses if pose is not None]

    def _trails(self, film: bool) -> Sequence[Trail]:
        project, character = self.project, self.character
        if project is None or character is None:
            return ()
        if film:
            return filmed_trails(project, self.tracks.reading, self.frame)
        return trails(project, character, self.motion, self.frame)

    def partial(self, stage: Stage, value: Any) -> None:
        """Take a frame that was just solved."""
        frame = self.motion.take(stage, value)
        if frame is None:
            return
        if frame == self.frame:
            self.show_pose()
        self.lanes_changed.emit()
