"""From a drag to an edit: the live pose while it lasts, the committed pose at its end, and what can be done later."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer, Signal

from app.actions import pose_copies
from app.actions import posing as actions
from app.model.character import Character
from app.model.edits import Edit, characters, poses
from app.model.values import ModelError
from app.window.background_call import BackgroundCalls
from app.window.character.live import LivePose
from app.window.character.motion import Motion
from app.window.project import Project
from app.window.work import details
from imitation.errors import InputError

Array = NDArray[np.float64]
Place3 = tuple[float, float, float]
REST = 400
"""Milliseconds after the last stroke of a key at which the pose is committed."""
AHEAD = 500
"""Milliseconds that the first picture of a character has for itself before its first drag is prepared."""


class Posing(QObject):
    """Drives the live pose; ``moved`` says that the pose follows the mouse, ``changed`` that all is to be shown
    anew, ``told`` a sentence with details.
    """

    moved = Signal()
    changed = Signal()
    told = Signal(str, str)

    def __init__(self, project: Project, motion: Motion, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project, self.motion = project, motion
        self.live = LivePose(project.session, self)
        self.calls = BackgroundCalls(self)
        self.live.posed.connect(self._posed)
        self.live.committed.connect(self._committed)
        self.live.failed.connect(self._failed)
        self.before: Array | None = None
        self.copy: pose_copies.PoseCopy | None = None
        self._frame = -1
        self._places: dict[int, Place3] = {}
        self._ready: set[tuple[object, ...]] = set()
        self._sought: set[object] = set()
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self.release)
        self._ahead_of: Character | None = None
        self._ahead = QTimer(self)
        self._ahead.setSingleShot(True)
        self._ahead.setInterval(AHEAD)
        self._ahead.timeout.connect(lambda: self._ahead_of and self._make_ready(self._ahead_of))

    def possible(self, character: Character) -> bool:
        """Whether the character has a motion that can be edited."""
        return self.project.result(self.project.session.stages.base(character.id)) is not None

    def move(
        self, character: Character, frame: int, shown: Array, vertex: int, place: Place3, *, on_ray: bool = False
    ) -> None:
        """Put a vertex of the frame shown somewhere, for now; ``on_ray`` takes its image point only."""
        if self.before is None:
            self.before, self._frame, self._places = np.array(shown), frame, {}
            self.live.begin(character.id, frame, self.before)
            self._make_ready(character, frame, vertex)
        self._places[vertex] = place
        self.live.move(vertex, place, on_ray)

    def nudge(self, character: Character, frame: int, shown: Array, vertex: int, step: Array) -> None:
        """Move a vertex by a little; strokes in a row are one entry, committed once the hand rests."""
        start = self._places.get(vertex) if self.before is not None else None
        x, y, z = (float(value) for value in np.add(shown[vertex] if start is None else start, step))
        self.move(character, frame, shown, vertex, (x, y, z))
        self._rest.start()

    @property
    def nudging(self) -> bool:
        """Whether strokes of keys wait to be committed."""
        return self._rest.isActive()

    def make_ready(self, character: Character) -> None:
        """Prepare in the background what the first drag of a character would wait for, once its picture is there."""
        self._ahead_of = character
        if not self._ahead.isActive() and (self.project.session.stages.base(character.id).key,) not in self._ready:
            self._ahead.start()

    def _make_ready(self, character: Character, *of: int) -> None:
        # Of the same base each preparation is begun once; what it finds is kept with the project's media.
        key = (self.project.session.stages.base(character.id).key, *of)
        if key in self._ready or not self.possible(character):
            return
        self._ready.add(key)
        session, frame, vertices = self.project.session, (of[0] if of else None), of[1:]
        self.calls.run(lambda: actions.make_ready(session, character.id, frame, vertices), lambda _: None)

    def release(self) -> None:
        """Commit the pose."""
        self._rest.stop()
        if self.before is not None:
            self.live.release()

    def cancel(self) -> None:
        """Let the mesh snap back."""
        self._rest.stop()
        self.live.cancel()
        self.motion.drop(self._frame)
        self.before, self._frame = None, -1
        self.changed.emit()

    def leave(self) -> None:
        """Another frame is shown: a drag under way is given up, strokes of keys are committed."""
        if self.nudging:
            self.release()
        elif self.before is not None and self._frame not in self.motion.held:
            self.cancel()

    def _posed(self, frame: int, vertices: Array) -> None:
        if self.before is not None and frame == self._frame:
            self.motion.hold(frame, vertices)
            self.moved.emit()

    def _committed(self, character_id: str, frame: int, moves: Any, places: Any, on_rays: Any) -> None:
        self.before, self._frame = None, -1
        if self.project.edit(poses.move_vertices, character_id, frame, moves, places, on_rays):
            self.motion.settle(frame, self.project.document.character(character_id))
        else:
            self.motion.drop(frame)
        self.changed.emit()

    def _failed(self, sentence: str, error: BaseException) -> None:
        self.cancel()
        self.told.emit(sentence, details(error))

    def show_committed(self, character: Character, frame: int) -> None:
        """Find the pose that an edited frame was committed in, where nothing newer is shown there and nothing runs."""
        project, edit = self.project, character.edits.get(frame)
        if edit is None or frame in self.motion.held or frame in self.motion.streamed or self.motion.taken:
            return
        key = (project.session.stages.base(character.id).key, frame, edit)
        if project.progress or self.before is not None or key in self._sought or not self.possible(character):
            return
        self._sought = {key}
        session = project.session

        def show(pose: Array | None) -> None:
            self._sought.clear()
            now = next((each for each in project.document.characters if each.id == character.id), None)
            if pose is not None and now is not None and now.edits.get(frame) == edit and not self.motion.taken:
                self.motion.hold(frame, pose)
                self.motion.settle(frame, now)
                self.changed.emit()

        self.calls.run(lambda: actions.edited_frame(session, character.id, frame), show, lambda _: None)

    # later -------------------------------------------------------------------------------------------------------

    def pair(self, character: Character, track_id: str, vertex: int) -> bool:
        """Pair a track with a vertex; says whether that was possible."""
        return self.project.edit(characters.set_pair, character.id, track_id, vertex)

    def delete_move(self, vertex: int, frame: int | None = None) -> None:
        """Delete the move of a vertex in a frame, else in that shown."""
        self._again(poses.delete_move, self.project.frame if frame is None else frame, vertex)

    def mute(self, vertex: int, muted: bool, frame: int | None = None) -> None:
        """Mute the move of a vertex in a frame, else in that shown, or let it count."""
        self._again(poses.mute_move, self.project.frame if frame is None else frame, vertex, muted)

    def delete_control_vertex(self, vertex: int) -> None:
        """Delete a control vertex: its moves in all frames."""
        self._again(poses.delete_control_vertex, vertex)

    def delete_selected(self) -> None:
        """Delete the selected vertex's move of this frame, else the vertex as a control vertex, else its pair."""
        project = self.project
        character = next((each for each in project.document.characters if each.id == project.character_id), None)
        if character is None or project.vertex < 0:
            return
        edit = character.edits.get(project.frame)
        paired = next((track for track, at in character.pairs.items() if at == project.vertex), None)
        if edit is not None and project.vertex in edit.moves:
            self.delete_move(project.vertex)
        elif any(project.vertex in each.moves for each in character.edits.values()):
            self.delete_control_vertex(project.vertex)
        elif paired is not None:
            project.edit(characters.remove_pair, character.id, paired)

    def copy_pose(self, frame: int) -> str:
        """Remember the pose edit of a frame; gives a sentence for the person."""
        try:
            self.copy = pose_copies.copy_pose(self.project.session, self.project.character_id, frame)
        except (ModelError, InputError) as error:
            return str(error)
        count = len(self.copy.offsets)
        return f"Copied the pose edit of frame {frame}: {count} {'vertices' if count > 1 else 'vertex'}"

    def paste_pose(self, frame: int) -> str:
        """Put the remembered pose edit into a frame; gives a sentence where that cannot be done."""
        copy, session = self.copy, self.project.session
        if copy is None:
            return "No pose edit was copied yet: go to an edited frame and press Ctrl+C."
        if copy.character_id not in {each.id for each in self.project.document.characters}:
            return "The character whose pose was copied is no more."
        if copy.frame == frame:
            return "This is the frame that was copied: go to another one to paste."
        self._solve(lambda: pose_copies.paste_pose(session, frame, copy), lambda: self.paste_pose(frame))
        return ""

    def _again(self, make: Callable[..., Edit], *values: Any) -> None:
        """Do an edit that commits frames anew: they are solved outside the window's thread."""
        session, document = self.project.session, self.project.document
        try:
            edit = make(document, self.project.character_id, *values)
        except (ModelError, InputError) as error:
            self.told.emit(str(error), details(error))
            return
        if actions.is_committed(edit):
            self._apply(edit)
        else:
            self._solve(lambda: actions.committed_anew(session, edit), lambda: self._again(make, *values))

    def _solve(self, make: Callable[[], Edit], again: Callable[[], object]) -> None:
        """Find an edit outside the window's thread and do it; where the document has changed meanwhile, ask again."""
        document = self.project.document

        def apply(solved: Edit) -> None:
            if self.project.document is document:
                self._apply(solved)
            else:
                again()

        self.calls.run(make, apply, lambda error: self.told.emit(str(error), details(error)))

    def _apply(self, edit: Edit) -> None:
        self.motion.held.clear()
        self.project.session.apply(edit)
        self.changed.emit()

    def close(self) -> None:
        """End the threads."""
        self._rest.stop()
        self._ahead.stop()
        self.live.close()
        self.calls.close()
