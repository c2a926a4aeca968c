"""Pose a character by hand: drag vertices of one frame, then commit the pose and let it spread."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from app.actions.session import Session
from app.model.edits import Edit, poses
from app.stages.project import Stages
from app.stages.results import Animation, Array
from app.stages.stage import Stage
from imitation.errors import InputError

STEPS = 8
"""Steps of the solver a mouse move: enough that the mesh follows, few enough for 25 pictures a second."""

Place = Iterable[float]


class PoseDrag:
    """Vertices of one frame on their way; belongs to one thread, which may be a worker's.

    Parameters
    ----------
    session, character_id, frame : what is posed. Its motion before any edit must have been computed; frame 0 only needs
        the character to be placed.
    before : (v, 3) the frame as the user sees it, where its animation is still on its way; default the animation's.
    former : an earlier drag; of the same character it lends what depends on the mesh alone.

    Raises
    ------
    InputError : the character has not been animated yet.
    """

    def __init__(
        self,
        session: Session,
        character_id: str,
        frame: int,
        *,
        before: Array | None = None,
        former: PoseDrag | None = None,
    ) -> None:
        from imitation.deformation import Deformer

        self.character_id, self.frame = character_id, frame
        base: Any = session.ready(_ground_of(session.stages, character_id, frame))
        animated = session.ready(session.stages.animation(character_id))
        character = session.document.character(character_id)
        if before is None and isinstance(animated, Animation):
            before = animated.vertices[frame]
        elif before is None and base is not None and not frame:
            before = base.vertices[0]
        if base is None or before is None:
            raise InputError(f"{character.name} has not been animated yet: animate it, then pose it.")
        self._base, self._volume = base, character.solve.keep_volume
        self._before: Array = np.array(before)
        edit = character.edits.get(frame)
        self._moves: dict[int, Array] = (
            {vertex: np.array(move.place) for vertex, move in edit.moves.items() if not move.muted} if edit else {}
        )
        same = former is not None and former._volume == self._volume and np.array_equal(former._base.rest, base.rest)
        self._deformer: Any = (
            former._deformer if former and same else Deformer(base.rest, base.faces, keep_volume=self._volume)
        )
        self._pose: object = self._before

    @property
    def before(self) -> Array:
        """The frame (v, 3) as it was before the drag."""
        return self._before

    @property
    def moves(self) -> Mapping[int, Array]:
        """Control vertices of this frame and where they are now."""
        return self._moves

    def move(self, places: Mapping[int, Place]) -> Array:
        """Put vertices somewhere and give the mesh (v, 3) that follows, nearly relaxed."""
        from imitation.propagation import edit_constraints

        for vertex, place in places.items():
            self._moves[int(vertex)] = np.array(tuple(place), np.float64)
        asked = edit_constraints(self._base, self.frame, self._moves, self._before)
        pose = self._deformer.solve_pose(asked, start=self._pose, iterations=STEPS)
        self._pose = pose
        vertices: Array = pose.vertices
        return vertices

    def committed(self) -> dict[int, tuple[float, float, float]]:
        """Relax the mesh to the end and give the place of every key point and control vertex."""
        from imitation.propagation import commit_edit

        places = commit_edit(
            self._base,
            self.frame,
            self._moves,
            pose=self._before,
            deformer=self._deformer,
        )
        return {vertex: (float(x), float(y), float(z)) for vertex, (x, y, z) in places.items()}


def release(session: Session, drag: PoseDrag, moved: Iterable[int]) -> Edit:
    """Make the edit that a finished drag of these vertices is; apply it with ``session.apply``."""
    moves = {vertex: drag.moves[vertex] for vertex in moved}
    return poses.move_vertices(session.document, drag.character_id, drag.frame, moves, drag.committed())


def move_vertex(session: Session, character_id: str, frame: int, vertex: int, place: Place) -> None:
    """Put one vertex somewhere in one frame, as a drag would."""
    if not frame:
        session.result(session.stages.start(character_id))
    drag = PoseDrag(session, character_id, frame)
    if not 0 <= vertex < len(drag.before):
        raise InputError(f"There is no vertex {vertex}: the mesh has {len(drag.before)}.")
    drag.move({vertex: place})
    session.apply(release(session, drag, [vertex]))


def delete_move(session: Session, character_id: str, frame: int, vertex: int) -> None:
    """Delete one vertex's move; what remains of the edited frame is committed anew, as one entry."""
    _and_commit_anew(session, poses.delete_move(session.document, character_id, frame, vertex), character_id)


def mute_move(session: Session, character_id: str, frame: int, vertex: int, muted: bool) -> None:
    """Mute one vertex's move or let it count again; the edited frame is committed anew, as one entry."""
    _and_commit_anew(session, poses.mute_move(session.document, character_id, frame, vertex, muted), character_id)


def delete_control_vertex(session: Session, character_id: str, vertex: int) -> None:
    """Delete a control vertex in all frames; the frames it was moved in are committed anew, as one entry."""
    _and_commit_anew(session, poses.delete_control_vertex(session.document, character_id, vertex), character_id)


def _ground_of(stages: Stages, character_id: str, frame: int) -> Stage:
    """What a frame is edited on: the motion before any edit; for frame 0 the placed character, solved or not."""
    return stages.base(character_id) if frame else stages.start(character_id)


def _and_commit_anew(session: Session, edit: Edit, character_id: str) -> None:
    from imitation.propagation import commit_edit

    document = edit.document
    for frame, pose in document.character(character_id).edits.items():
        moves = {vertex: np.array(move.place) for vertex, move in pose.moves.items() if not move.muted}
        if pose.committed or not moves:
            continue
        # As if the moves that are gone had never been: for frame 0 from the character as it was placed.
        ground: Any = session.result(_ground_of(Stages(document) if frame else session.stages, character_id, frame))
        places = commit_edit(ground, frame, moves, pose=None if frame else ground.rest)
        fresh = {vertex: (float(x), float(y), float(z)) for vertex, (x, y, z) in places.items()}
        document = poses.recommit(document, character_id, frame, fresh).document
    session.apply(Edit(document, edit.label, edit.frame))
