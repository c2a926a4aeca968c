"""From a drag to an edit: the live pose while it lasts, the committed pose at its end, and what can be done later."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

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
        self._frame = -1
        self._ready: set[tuple[object, ...]] = set()

    def possible(self, character: Character) -> bool:
        """Whether the character has a motion that can be edited."""
        return self.project.result(self.project.session.stages.base(character.id)) is not None

    def move(
        self, character: Character, frame: int, shown: Array, vertex: int, place: tuple[float, float, float]
    ) -> None:
        """Put a vertex of the frame shown somewhere, for now."""
        if self.before is None:
            self.before, self._frame = np.array(shown), frame
            self.live.begin(character.id, frame, self.before)
            self._make_ready(character, frame, vertex)
        self.live.move(vertex, place)

    def make_ready(self, character: Character) -> None:
        """Prepare in the background what the first drag of a character would wait for."""
        self._make_ready(character)

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
        if self.before is not None:
            self.live.release()

    def cancel(self) -> None:
        """Let the mesh snap back."""
        self.live.cancel()
        self.motion.held.pop(self._frame, None)
        self.before, self._frame = None, -1
        self.changed.emit()

    def leave(self) -> None:
        """Another frame is shown: a drag under way is given up."""
        if self.before is not None and self._frame not in self.motion.held:
            self.cancel()

    def _posed(self, frame: int, vertices: Array) -> None:
        if self.before is not None and frame == self._frame:
            self.motion.held[frame] = vertices
            self.moved.emit()

    def _committed(self, character_id: str, frame: int, moves: Any, places: Any) -> None:
        self.before, self._frame = None, -1
        if not self.project.edit(poses.move_vertices, character_id, frame, moves, places):
            self.motion.held.pop(frame, None)
        self.changed.emit()

    def _failed(self, sentence: str, error: BaseException) -> None:
        self.cancel()
        self.told.emit(sentence, details(error))

    # later -------------------------------------------------------------------------------------------------------

    def pair(self, character: Character, track_id: str, vertex: int) -> None:
        """Pair a track with a vertex."""
        self.project.edit(characters.set_pair, character.id, track_id, vertex)

    def delete_move(self, vertex: int) -> None:
        """Delete the move of a vertex in the frame shown."""
        self._again(poses.delete_move, self.project.frame, vertex)

    def mute(self, vertex: int, muted: bool) -> None:
        """Mute the move of a vertex in the frame shown, or let it count."""
        self._again(poses.mute_move, self.project.frame, vertex, muted)

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
            self._again(poses.delete_control_vertex, project.vertex)
        elif paired is not None:
            project.edit(characters.remove_pair, character.id, paired)

    def _again(self, make: Callable[..., Edit], *values: Any) -> None:
        """Do an edit that commits frames anew: they are solved outside the window's thread."""
        session, document = self.project.session, self.project.document
        try:
            edit = make(document, self.project.character_id, *values)
        except (ModelError, InputError) as error:
            self.told.emit(str(error), details(error))
            return

        def apply(solved: Edit) -> None:
            if session.document is not document:
                # Something else was done meanwhile: the same wish on what there is now.
                self._again(make, *values)
                return
            session.apply(solved)
            self.motion.held.clear()
            self.changed.emit()

        if actions.is_committed(edit):
            apply(edit)
            return
        self.calls.run(
            lambda: actions.committed_anew(session, edit),
            apply,
            lambda error: self.told.emit(str(error), details(error)),
        )

    def close(self) -> None:
        """End the threads."""
        self.live.close()
        self.calls.close()
