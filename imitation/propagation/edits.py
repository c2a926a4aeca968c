"""Edits: what a drag in one frame commits, and the pose it leaves there (paper A, 3.6)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.propagation.base import SOFT, Base, make_deformer

if TYPE_CHECKING:
    from imitation.deformation import Deformer, FrameConstraints
    from imitation.deformation.modes import Modes

Committed = Mapping[int, ArrayLike]
"""vertex -> place (3,): positions of all key points and of the control vertices in one edited frame."""

DEPTH_PULL = 0.1
"""Softness of the pull to its depth of a key point that went back on its ray: between free and held."""


def commit_edit(
    base: Base,
    frame: int,
    moves: Mapping[int, ArrayLike],
    *,
    pose: Array | None = None,
    pinned: Collection[int] = (),
    on_rays: Collection[int] = (),
    deformer: Deformer | None = None,
) -> dict[int, Array]:
    """Deform one frame after its control vertices were moved, and say where that leaves everything.

    The moved vertices are hard. The other key points go back on their rays with a weak pull to their depth, so that
    they give way in the direction that the video says nothing about; those in contact and the pinned ones stay.

    Parameters
    ----------
    base : the base solution.
    frame : the edited frame.
    moves : vertex -> place (3,), world: all control vertices of this frame, earlier ones too.
    pose : (v, 3) the frame as the user sees it; default the base solution's.
    pinned : key points or control vertices that must stay where they are in ``pose``.
    on_rays : moved vertices of which only the image point is asked for: they keep to the ray through their place, and
        their depth gives way.
    deformer : a prepared `Deformer` of this mesh.

    Returns
    -------
    vertex -> place (3,) of every key point and of every moved or pinned vertex: the edit's committed positions.
    """
    check_places(base, {frame: moves})
    return _solve_edit(base, frame, moves, pose, pinned, on_rays, deformer)[0]


def edited_pose(base: Base, frame: int, committed: Committed, *, deformer: Deformer | None = None) -> Array:
    """The pose (v, 3) of an edited frame: a function of the base solution and the frame's committed positions alone."""
    from imitation.deformation import FrameConstraints

    check_places(base, {frame: committed})
    deformer = deformer or make_deformer(base.rest, base.faces)
    points = dict(zip(base.keys.vertices.tolist(), base.lifted[frame], strict=True))
    points.update({int(vertex): np.asarray(place, np.float64) for vertex, place in committed.items()})
    keys = set(base.keys.vertices.tolist())
    modes = typical_modes(base, deformer, sorted(points.keys() - keys))
    asked = FrameConstraints(points=points)
    pose = deformer.solve_pose(asked, start=base.vertices[frame], modes=modes).vertices
    pose[list(points)] = list(points.values())
    return pose


def typical_modes(
    base: Base, deformer: Deformer, controls: Sequence[int], heard: Callable[[], object] | None = None
) -> Modes | None:
    """Slow directions of a frame with these control vertices, the same for all frames and edits of a clip.

    They cost as much as several frames and only steer the solver, so a frame's own softness does not matter.
    ``heard`` is called now and then while they are found and may raise to stop.
    """
    from imitation.deformation import FrameConstraints

    keys = base.keys.vertices.tolist()
    points = {vertex: base.rest[vertex] for vertex in (*keys, *controls)}
    softness = dict(zip(keys, np.median(base.softness, axis=0).tolist(), strict=True))
    return deformer.modes_of(FrameConstraints(points=points, softness=softness), heard)


def check_places(base: Base, edits: Mapping[int, Mapping[int, ArrayLike]]) -> None:
    """Refuse edits outside the clip or of vertices that do not exist, and places that are not finite."""
    for frame, places in edits.items():
        if not 0 <= frame < len(base):
            raise InputError(
                f"The edit in frame {frame} is outside the clip, whose frames are 0 to {len(base) - 1}; remove it."
            )
        for vertex, place in places.items():
            if not 0 <= vertex < len(base.rest):
                raise InputError(
                    f"The edit in frame {frame} moves vertex {vertex}, but the character has {len(base.rest)} vertices."
                )
            point = np.asarray(place, np.float64)
            if point.shape != (3,) or not np.isfinite(point).all():
                raise InputError(f"The place of vertex {vertex} in edited frame {frame} needs three finite numbers.")


def edit_constraints(
    base: Base,
    frame: int,
    moves: Mapping[int, ArrayLike],
    pose: Array,
    pinned: Collection[int] = (),
    on_rays: Collection[int] = (),
) -> FrameConstraints:
    """What an edited frame asks of the mesh while its control vertices are being moved.

    ``pose`` is the frame as it was before; see `commit_edit` for the rest. An interactive drag solves the same
    constraints with few steps that `commit_edit` solves to the end.
    """
    from imitation.deformation import FrameConstraints

    camera = base.cameras[frame]
    points = {int(vertex): np.asarray(place, np.float64) for vertex, place in moves.items() if vertex not in on_rays}
    for vertex in pinned:
        points.setdefault(int(vertex), pose[vertex])
    rays, depths, softness = {}, {}, {}
    for vertex in moves.keys() & set(on_rays):
        pixel = camera.project(np.asarray(moves[vertex], np.float64))
        rays[int(vertex)] = (float(pixel[0]), float(pixel[1]))
        depths[int(vertex)] = float(camera.depth(pose[vertex]))
    for key, vertex in enumerate(base.keys.vertices.tolist()):
        if vertex in points or vertex in rays:
            continue
        if base.keys.planted[frame, key]:
            points[vertex] = pose[vertex]
        else:
            pixel = camera.project(pose[vertex])
            rays[vertex] = (float(pixel[0]), float(pixel[1]))
            depths[vertex] = float(camera.depth(pose[vertex]))
            softness[vertex] = SOFT
    return FrameConstraints(points, rays, camera, depths, softness, DEPTH_PULL)


def _solve_edit(
    base: Base,
    frame: int,
    moves: Mapping[int, ArrayLike],
    pose: Array | None,
    pinned: Collection[int],
    on_rays: Collection[int],
    deformer: Deformer | None,
) -> tuple[dict[int, Array], Array]:
    deformer = deformer or make_deformer(base.rest, base.faces)
    current = base.vertices[frame] if pose is None else np.asarray(pose, np.float64)
    if current.shape != base.rest.shape:
        raise InputError(f"The pose to edit needs shape {base.rest.shape}, but has {current.shape}.")
    asked = edit_constraints(base, frame, moves, current, pinned, on_rays)
    keys = set(base.keys.vertices.tolist())
    loose = sorted(set(on_rays) & moves.keys())
    modes = typical_modes(base, deformer, sorted(set(asked.points).union(loose) - keys))
    posed = deformer.solve_pose(asked, start=current, modes=modes).vertices
    committed = {vertex: posed[vertex].copy() for vertex in base.keys.vertices.tolist()}
    committed.update({vertex: np.array(place, np.float64) for vertex, place in asked.points.items()})
    camera = base.cameras[frame]
    committed.update({vertex: camera.lift(asked.rays[vertex], float(camera.depth(posed[vertex]))) for vertex in loose})
    return committed, posed
