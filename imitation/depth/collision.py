"""The measured background as a surface that a character stands on and must not go into."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.depth.surface import BackgroundMesh
from imitation.errors import InputError
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

NEIGHBOURS = 8
"""Places of the surface that are asked of each vertex; the median of what they say silences strays."""


@attrs.frozen(eq=False)
class Penetration:
    """How far a moving character goes into the background.

    Attributes
    ----------
    depth : (n,) of each frame's deepest vertex, world units; 0 where none is behind the surface.
    share : (n,) of the vertices near the surface that are deeper than ``tolerance``. vertex : (n,) the deepest, or -1.
    tolerance : world units.
    """

    depth: Array
    share: Array
    vertex: NDArray[np.int64]
    tolerance: float


class Collider:
    """Tells how far points lie behind the nearest surface of a background mesh.

    The surface has one side, the one that the cameras saw, and no thickness: what lies farther behind it than ``reach``
    is taken to be elsewhere, behind a post and not inside it. Beyond the mesh's rim nothing is known.

    Parameters
    ----------
    mesh : background, its triangles counter-clockwise as the cameras saw them.
    reach : world units.
    """

    def __init__(self, mesh: BackgroundMesh, reach: float) -> None:
        from scipy.spatial import cKDTree

        if not len(mesh.faces):
            raise InputError("The background has no surface that several frames confirm, so that nothing can meet it.")
        if not reach > 0:
            raise InputError(f"A collider needs a positive reach, but got {reach}.")
        corners = mesh.vertices[mesh.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = np.zeros_like(mesh.vertices)
        for corner in range(3):
            np.add.at(normals, mesh.faces[:, corner], across)
        length = np.linalg.norm(normals, axis=1)
        kept = length > 0
        self.points, self.normals = mesh.vertices[kept], normals[kept] / length[kept, None]
        self.spacing = float(np.median(np.sqrt(np.linalg.norm(across, axis=1))))
        self.reach = reach
        self._tree = cKDTree(self.points)

    def behind(self, points: ArrayLike) -> Array:
        """How far points (k, 3) lie behind the surface, negative before it; NaN where none is within ``reach``."""
        p = np.asarray(points, np.float64).reshape(-1, 3)
        count = min(NEIGHBOURS, len(self.points))
        found: Any = self._tree.query(p, k=count, distance_upper_bound=self.reach)
        away, index = (np.asarray(each).reshape(len(p), count) for each in found)
        there = np.isfinite(away)
        safe = np.where(there, index, 0)
        offset = p[:, None] - self.points[safe]
        along = (offset * self.normals[safe]).sum(axis=-1)
        # Beside the surface's rim its nearest places say nothing of what lies below: the foot must be on them.
        aside = np.sqrt(np.maximum((offset**2).sum(axis=-1) - along**2, 0))
        there &= aside <= 2.0 * self.spacing + 0.2 * np.abs(along)
        enough = 2 * there.sum(axis=1) >= count
        deep = np.full(len(p), np.nan)
        deep[enough] = np.nanmedian(np.where(there[enough], -along[enough], np.nan), axis=1)
        return deep


def penetration(
    poses: Sequence[Any] | NDArray[np.floating],
    collider: Collider,
    *,
    tolerance: float,
    progress: Progress | None = None,
) -> Penetration:
    """How far a character goes into the background in each frame.

    Parameters
    ----------
    poses : n poses (v, 3), world.
    tolerance : world units that are nothing to speak of: the background's own error, or a paw's softness.
    """
    report = progress or silent
    depth, share = np.zeros(len(poses)), np.zeros(len(poses))
    vertex = np.full(len(poses), -1, np.int64)
    for t, pose in enumerate(poses):
        report(t / len(poses))
        behind = collider.behind(pose)
        known = np.isfinite(behind)
        if not known.any():
            continue
        share[t] = float((behind[known] > tolerance).mean())
        worst = int(np.nanargmax(behind))
        if behind[worst] > 0:
            depth[t], vertex[t] = behind[worst], worst
    report(1.0)
    return Penetration(depth, share, vertex, tolerance)
