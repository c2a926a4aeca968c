"""The pose in frame 0: part of placing the character on the subject, before the clip is solved (paper A, 3.3)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.geometry import Camera
from imitation.motion.keys import KeyTracks
from imitation.propagation.base import Base, make_deformer
from imitation.propagation.edits import check_places

if TYPE_CHECKING:
    from imitation.deformation import Deformer


def placed_frame(
    vertices: ArrayLike,
    faces: ArrayLike,
    camera: Camera,
    pairs: Mapping[str, int],
    planted: Collection[str] = (),
) -> Base:
    """Frame 0 alone, as a solution of one frame: what is needed to edit it before anything else is known.

    Parameters
    ----------
    vertices, faces : the character (v, 3), (m, 3), aligned with the subject in frame 0, world.
    camera : of frame 0.
    pairs : track name -> vertex.
    planted : names of the tracks in contact in frame 0; an edit leaves them where they are.

    Raises
    ------
    InputError
        A pair names a vertex that the character does not have.
    """
    rest, triangles = np.asarray(vertices, np.float64), np.asarray(faces, np.int32)
    names, chosen = tuple(pairs), np.array(list(pairs.values()), np.int64)
    if len(chosen) and not ((chosen >= 0) & (chosen < len(rest))).all():
        raise InputError(f"A pair names vertex {int(chosen.max())}, but the character has {len(rest)} vertices.")
    places, count = rest[chosen], len(names)
    touching: NDArray[np.bool_] = np.array([[name in planted for name in names]], bool).reshape(1, count)
    keys = KeyTracks(
        names, chosen, places, camera.project(places).reshape(1, count, 2), np.ones((1, count), bool), touching,
        np.where(touching[..., None], places[None], np.nan), np.ones((1, count)), np.zeros(count),
    )  # fmt: skip
    cameras = CameraPath(camera.K[None], camera.R[None], np.asarray(camera.T)[None], "static")
    softness = np.ones((1, count))
    return Base(rest, triangles, cameras, keys, places[None], softness, rest[None].copy(), "joint", np.zeros(count), {})


def start_pose(placed: Base, committed: Mapping[int, ArrayLike], *, deformer: Deformer | None = None) -> Base:
    """Pose frame 0: a function of the placed character and the frame's committed positions alone.

    The lengths and offsets of the whole solution come from this pose and not from the one in the mesh's file, so that a
    head that is down when the film begins is not carried as an offset, too high, through the clip.

    Parameters
    ----------
    placed : from `placed_frame`.
    committed : vertex -> place (3,), world, as `commit_edit` gives it for frame 0 of ``placed``.

    Returns
    -------
    Base
        ``placed`` with the posed character in its only frame: give ``.vertices[0]`` to `solve_base` as its start.
    """
    check_places(placed, {0: committed})
    if not committed:
        return placed
    deformer = deformer or make_deformer(placed.rest, placed.faces)
    points = {int(vertex): np.asarray(place, np.float64) for vertex, place in committed.items()}
    pose = deformer.solve(points, start=placed.rest)
    pose[list(points)] = list(points.values())
    keys = attrs.evolve(placed.keys, start=pose[placed.keys.vertices])
    return attrs.evolve(placed, keys=keys, lifted=keys.start[None], vertices=pose[None])
