"""Placing the character in the first frame: the gizmo while it is dragged, then one edit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from app.actions import aligning
from app.model.character import Alignment, Character
from app.model.document import Document
from app.model.edits import Edit
from app.model.values import ModelError
from app.window.character.motion import Motion
from app.window.project import Project
from app.window.viewport import Gizmo
from app.window.viewport.gizmo import GizmoMode, Placement
from app.window.work import details
from imitation.errors import InputError

Array = NDArray[np.float64]


class Placing(QObject):
    """``changed`` says that all is to be shown anew, ``moved`` the pose only, ``told`` a sentence with details."""

    changed = Signal()
    moved = Signal()
    told = Signal(str, str)

    def __init__(self, project: Project, motion: Motion, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project, self.motion = project, motion
        self.mode: GizmoMode | None = None
        self._before: Array | None = None
        self._asked = ""

    # what is shown -----------------------------------------------------------------------------------------------

    def choose(self, mode: str) -> None:
        """Take the gizmo for moving, turning or scaling in hand; empty puts it away."""
        self.mode = mode or None  # type: ignore[assignment]
        if self.mode is not None:
            character = self._character()
            if character is not None and len(character.pairs) < 3 and character.alignment.fitted:
                self.by_hand(True)
            self.project.show_frame(0)
        self.changed.emit()

    def gizmo(self, vertices: Array | None) -> Gizmo | None:
        """The gizmo on the pose shown; only the first frame has one."""
        if self.mode is None or self.project.frame != 0 or vertices is None:
            return None
        x, y, z = (float(value) for value in self._centre(vertices))
        return Gizmo(self.mode, (x, y, z))

    def _centre(self, vertices: Array) -> Array:
        centre: Array = vertices.mean(axis=0)
        return centre

    def _character(self) -> Character | None:
        wanted = self.project.character_id
        return next((each for each in self.project.document.characters if each.id == wanted), None)

    # dragging ----------------------------------------------------------------------------------------------------

    def moving(self, change: Placement) -> None:
        """Show where the character would stand."""
        if self._before is None:
            shown = self.motion.vertices(0)
            self._before = None if shown is None else np.array(shown)
        if self._before is not None:
            shifted = aligning.stood(
                self._before, change.centre, shift=change.shift, turn=change.turn, scale=change.scale
            )
            self.motion.hold(0, shifted)
            self.moved.emit()

    def done(self, change: Placement) -> None:
        """Decide it: one entry of the history."""
        self.moving(change)
        self._before = None
        if not self._do(
            lambda: aligning.changed(
                self.project.document,
                self.project.character_id,
                shift=change.shift,
                turn=change.turn,
                scale=change.scale,
            )
        ):
            self.motion.drop(0)
        self._settle()

    def released(self) -> None:
        """Put the character back."""
        self._before = None
        self.motion.drop(0)
        self.changed.emit()

    def trying(self, alignment: Alignment) -> None:
        """Show what a number that is being dragged would do."""
        character = self._character()
        if character is None or self.project.frame != 0:
            return
        now = character.alignment
        if alignment == now:
            self.released()
            return
        if self._before is None:
            shown = self.motion.vertices(0)
            self._before = None if shown is None else np.array(shown)
        if self._before is not None:
            self.motion.hold(0, aligning.tried(self._before, now, alignment))
            self.moved.emit()

    def nudge(self, shift: Array) -> None:
        """Move the character by a little; strokes in a row are one entry."""
        name = f"nudge place {self.project.character_id}"
        self._do(lambda: aligning.changed(self.project.document, self.project.character_id, shift=shift), name)

    # whole placements --------------------------------------------------------------------------------------------

    def by_hand(self, on: bool) -> None:
        """Let the character stand where it is put, or where its pairs fit."""
        project = self.project
        if on:
            self._do(lambda: aligning.by_hand(project.session, project.character_id))
        else:
            self._do(lambda: aligning.to_pairs(project.document, project.character_id))

    def reset(self) -> None:
        """Take back what was done on top of the fit."""
        self._do(lambda: aligning.reset(self.project.document, self.project.character_id))

    def _do(self, make: Callable[[], Edit], gesture: str | None = None) -> bool:
        try:
            self.project.session.apply(make(), gesture=gesture)
        except (ModelError, InputError) as error:
            self.told.emit(str(error), details(error))
            return False
        return True

    def follow(self, before: Document, after: Document) -> None:
        """After an edit of the placement: forget what was tried, and find the new place."""
        if [each.alignment for each in before.characters] != [each.alignment for each in after.characters]:
            self._before = None
            self.motion.settle_open(0, self._character())
            self.find()

    def find(self) -> None:
        """Find where the character stands, where that is not known; it takes a moment only."""
        character = self._character()
        if character is None:
            return
        stage = self.project.session.stages.alignment(character.id)
        state = self.project.state(stage)
        if state in ("missing", "stale") and stage.why_blocked() is None and stage.key != self._asked:
            self._asked = stage.key
            self.project.start(f"Placing {character.name}", stage)

    def _settle(self) -> None:
        self.motion.settle(0, self._character())
        self.changed.emit()
