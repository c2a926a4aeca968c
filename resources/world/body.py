"""Bodies of the sample world: a closed mesh on a skeleton, with the 16 vertices that a user would track."""

from __future__ import annotations

from functools import lru_cache

import attrs
import numpy as np

from resources.world.skeleton import SUBJECT, Array, Kind, Proportions, Skeleton, make_skeleton
from resources.world.surface import Faces, body_mesh, skin_weights


@attrs.frozen(eq=False)
class Body:
    """A skinned body in its rest pose: metres, Z up, facing +x, soles at z = 0.

    Attributes
    ----------
    skeleton : bones, legs and flesh.
    vertices : (n, 3), faces (m, 3) int32 of a closed surface without handles (Euler number 2), outward.
    weights : (n, bones) skin weights in the order of ``skeleton.bones``.
    key_vertices : the vertex of each of the 16 key points, by name.
    """

    skeleton: Skeleton
    vertices: Array
    faces: Faces
    weights: Array
    key_vertices: dict[str, int]

    @property
    def joints(self) -> dict[str, Array]:
        """The joint (3,) that each bone turns about, rest pose."""
        return {name: bone.head for name, bone in self.skeleton.bones.items()}

    @property
    def diagonal(self) -> float:
        """Diagonal of the bounding box of the rest pose, metres."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    def pose(self, rotations: Array, translations: Array) -> Array:
        """Vertices (..., n, 3) under bone motions ``x -> R x + t`` (..., bones, 3, 3) and (..., bones, 3)."""
        moved = np.einsum("...bij,nj->...nbi", rotations, self.vertices) + translations[..., None, :, :]
        posed: Array = np.einsum("nb,...nbi->...ni", self.weights, moved)
        return posed


def key_vertices(skeleton: Skeleton, vertices: Array) -> dict[str, int]:
    """The vertex nearest to each key point's place in the rest pose; for soles, of those that touch the ground."""
    soles = {name for leg in skeleton.legs for name, _ in leg.soles}
    lifted = vertices[:, 2] > 1e-3
    found = {}
    for name, place in skeleton.keys.items():
        off = np.sum((vertices - place) ** 2, axis=1)
        found[name] = int(np.argmin(np.where(lifted, np.inf, off) if name in soles else off))
    return found


def body_of(skeleton: Skeleton, vertices: int) -> Body:
    """Skin a skeleton with about ``vertices`` vertices."""
    points, faces = body_mesh(skeleton, vertices)
    points = points.astype(np.float32).astype(np.float64)  # so that files hold the same bits
    return Body(skeleton, points, faces, skin_weights(points, faces, skeleton), key_vertices(skeleton, points))


@lru_cache(maxsize=16)
def make_body(kind: Kind = "quadruped", proportions: Proportions = SUBJECT, vertices: int = 2500) -> Body:
    """A body of a kind with given proportions and about ``vertices`` vertices; the same call, the same bits."""
    return body_of(make_skeleton(kind, proportions), vertices)
