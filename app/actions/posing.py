"""Pose a character by hand: drag vertices of one frame, then commit the pose and let it spread."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

import numpy as np

from app.actions.session import Session
from app.model.character import Character, PoseEdit
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
    ) -> None:
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
        self._base = base
        self._before: Array = np.array(before)
        edit = character.edits.get(frame)
        counting = {vertex: move for vertex, move in edit.moves.items() if not move.muted} if edit else {}
        self._moves: dict[int, Array] = {vertex: np.array(move.place) for vertex, move in counting.items()}
        self._on_rays = {vertex for vertex, move in counting.items() if move.on_ray}
        self._deformer = session.media.deformer(base.rest, base.faces, character.solve.keep_volume)
        self._pose: object = self._before

    @property
    def before(self) -> Array:
        """The frame (v, 3) as it was before the drag."""
        return self._before

    @property
    def moves(self) -> Mapping[int, Array]:
        """Control vertices of this frame and where they are now."""
        return self._moves

    @property
    def on_rays(self) -> frozenset[int]:
        """Those of which only the image point is chosen."""
        return frozenset(self._on_rays)

    def move(self, places: Mapping[int, Place], on_rays: Collection[int] = ()) -> Array:
        """Put vertices somewhere and give the mesh (v, 3) that follows, nearly relaxed.

        Of the vertices ``on_rays`` only the image point of their place counts: they slide along its ray.
        """
        from imitation.propagation import edit_constraints

        for vertex, place in places.items():
            self._moves[int(vertex)] = np.array(tuple(place), np.float64)
        self._on_rays = (self._on_rays - places.keys()) | (set(on_rays) & places.keys())
        asked = edit_constraints(self._base, self.frame, self._moves, self._before, on_rays=self._on_rays)
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
            on_rays=self._on_rays,
            deformer=self._deformer,
        )
        return {vertex: (float(x), float(y), float(z)) for vertex, (x, y, z) in places.items()}


def release(session: Session, drag: PoseDrag, moved: Iterable[int]) -> Edit:
    """Make the edit that a finished drag of these vertices is; apply it with ``session.apply``."""
    committed = drag.committed()
    moves = placed_moves(drag, moved, committed)
    return poses.move_vertices(session.document, drag.character_id, drag.frame, moves, committed, drag.on_rays)


def placed_moves(
    drag: PoseDrag, moved: Iterable[int], committed: Mapping[int, tuple[float, float, float]]
) -> dict[int, tuple[float, float, float]]:
    """Where a finished drag has put these vertices: where the hand left them, or on its ray where the mesh took it."""
    places = {}
    for vertex in moved:
        x, y, z = committed[vertex] if vertex in drag.on_rays else (float(value) for value in drag.moves[vertex])
        places[vertex] = (x, y, z)
    return places


def move_vertex(session: Session, character_id: str, frame: int, vertex: int, place: Place) -> None:
    """Put one vertex somewhere in one frame, as a drag would."""
    if not frame:
        session.result(session.stages.start(character_id))
    drag = PoseDrag(session, character_id, frame)
    if not 0 <= vertex < len(drag.before):
        raise InputError(f"There is no vertex {vertex}: the mesh has {len(drag.before)}.")
    drag.move({vertex: place})
    session.apply(release(session, drag, [vertex]))


def edited_frame(session: Session, character_id: str, frame: int) -> Array | None:
    """The pose (v, 3) that an edited frame was committed in, spread or not; None for frames without an edit.

    It may be called in any thread, and solves one frame at most.
    """
    from app.stages.animation import counting_edits
    from imitation.propagation import edited_pose

    character = session.document.character(character_id)
    placed = next((places for at, places, _ in counting_edits(character) if at == frame), None)
    ground: Any = session.ready(_ground_of(session.stages, character_id, frame))
    if ground is None:
        return None
    if placed is None or not frame:
        vertices: Array = ground.vertices[frame]
        return vertices
    deformer = session.media.deformer(ground.rest, ground.faces, character.solve.keep_volume)
    return edited_pose(ground, frame, {vertex: np.array(place) for vertex, place in placed}, deformer=deformer)


def delete_move(session: Session, character_id: str, frame: int, vertex: int) -> None:
    """Delete one vertex's move; what remains of the edited frame is committed anew, as one entry."""
    session.apply(committed_anew(session, poses.delete_move(session.document, character_id, frame, vertex)))


def mute_move(session: Session, character_id: str, frame: int, vertex: int, muted: bool) -> None:
    """Mute one vertex's move or let it count again; the edited frame is committed anew, as one entry."""
    session.apply(committed_anew(session, poses.mute_move(session.document, character_id, frame, vertex, muted)))


def delete_control_vertex(session: Session, character_id: str, vertex: int) -> None:
    """Delete a control vertex in all frames; the frames it was moved in are committed anew, as one entry."""
    session.apply(committed_anew(session, poses.delete_control_vertex(session.document, character_id, vertex)))


def committed_anew(session: Session, edit: Edit) -> Edit:
    """The edit with all its frames committed whose committed pose it has cleared; solves, but changes nothing.

    It may be called in a thread of its own while the session's document stays as it is.
    """
    from imitation.propagation import commit_edit

    document, before = edit.document, session.stages
    for character in document.characters:
        for frame, pose in character.edits.items():
            moves = {vertex: np.array(move.place) for vertex, move in pose.moves.items() if not move.muted}
            if not _open(pose):
                continue
            # As if the moves that are gone had never been: for frame 0 from the character as it was placed.
            stages = Stages(document) if frame else before
            ground: Any = session.result(_ground_of(stages, character.id, frame))
            deformer = session.media.deformer(ground.rest, ground.faces, character.solve.keep_volume)
            loose = [vertex for vertex in moves if pose.moves[vertex].on_ray]
            before_any = None if frame else ground.rest
            places = commit_edit(ground, frame, moves, pose=before_any, on_rays=loose, deformer=deformer)
            fresh = {vertex: (float(x), float(y), float(z)) for vertex, (x, y, z) in places.items()}
            document = poses.recommit(document, character.id, frame, fresh).document
    return Edit(document, edit.label, edit.frame)


def is_committed(edit: Edit) -> bool:
    """Whether an edit leaves no frame to be committed anew, so that it can be applied at once."""
    return not any(_open(pose) for character in edit.document.characters for pose in character.edits.values())


def _open(pose: PoseEdit) -> bool:
    return not pose.committed and not all(move.muted for move in pose.moves.values())


def make_ready(session: Session, character_id: str, frame: int | None = None, vertices: Iterable[int] = ()) -> None:
    """Do in advance what the first drag, or the release of these vertices in a frame, would wait for.

    It changes no result, may run in any thread, and does nothing where the character has no motion yet.
    """
    from imitation.propagation import typical_modes

    document = session.document
    character = document.character(character_id)
    base: Any = session.ready(session.stages.base(character_id))
    if base is None:
        return
    deformer = session.media.deformer(base.rest, base.faces, character.solve.keep_volume)
    keys = set(base.keys.vertices.tolist())
    typical_modes(base, deformer, [])
    if frame is None:
        return
    around = sorted({*character.edits, frame})
    place = around.index(frame)
    controls = {int(vertex) for vertex in vertices} | _controls(character, frame)
    for other in (None, *around[max(place - 1, 0) : place], *around[place + 1 : place + 2]):
        both = controls | (set() if other is None else _controls(character, other))
        typical_modes(base, deformer, sorted(both - keys))


def _controls(character: Character, frame: int) -> set[int]:
    edit = character.edits.get(frame)
    return {vertex for vertex, move in edit.moves.items() if not move.muted} if edit else set()


def _ground_of(stages: Stages, character_id: str, frame: int) -> Stage:
    """What a frame is edited on: the motion before any edit; for frame 0 the placed character, solved or not."""
    return stages.base(character_id) if frame else stages.start(character_id)
