"""A mesh, and what is asked of it again and again while it is registered: made once."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.cuts.limbs import Ends, handle_count, limb_count, limb_ends
from tvmedit.cuts.nodes import Adjacency, DeformationGraph, adjacency, spread_nodes, vertex_normals

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Faces = NDArray[np.int32]


@attrs.frozen(eq=False)
class Surface:
    """A triangle mesh that does not change.

    Attributes
    ----------
    vertices : (v, 3) float64
    faces : (m, 3) int32
    """

    vertices: Array
    faces: Faces
    _nodes: dict[float, DeformationGraph] = attrs.field(factory=dict, init=False)
    _ends: dict[bool, Ends | None] = attrs.field(factory=dict, init=False)

    @classmethod
    def of(cls, mesh: Mesh) -> Surface:
        """Give the mesh, with what is known of it already."""
        return mesh if isinstance(mesh, Surface) else cls(*mesh)

    @cached_property
    def normals(self) -> Array:
        """Unit normals (v, 3)."""
        return vertex_normals(self.vertices, self.faces)

    @cached_property
    def around(self) -> Adjacency:
        """Neighbours of each vertex; see ``adjacency``."""
        return adjacency(self.vertices, self.faces)

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the vertices."""
        from scipy.spatial import cKDTree

        return cKDTree(self.vertices)

    @cached_property
    def volume(self) -> float:
        """Volume enclosed."""
        return mesh_volume(self.vertices, self.faces)

    @cached_property
    def limbs(self) -> int:
        """How many limbs hang free."""
        return limb_count(self.vertices, self.faces, self.around)

    @cached_property
    def handles(self) -> int:
        """How many ways lead round and back over it."""
        return handle_count(self.faces)

    def nodes(self, spacing: float) -> DeformationGraph:
        """Nodes spread over it; see ``spread_nodes``."""
        if spacing not in self._nodes:
            self._nodes[spacing] = spread_nodes(self.vertices, self.faces, spacing, self.around)
        return self._nodes[spacing]

    def ends(self, *, around_hollows: bool) -> Ends | None:
        """Ends of the limbs; see ``limb_ends``."""
        if around_hollows not in self._ends:
            found = limb_ends(self.vertices, self.faces, around_hollows=around_hollows, around=self.around)
            self._ends[around_hollows] = found
        return self._ends[around_hollows]


Mesh: TypeAlias = Surface | tuple[Array, Faces]
"""A mesh, or its vertices and faces."""


def mesh_volume(vertices: Array, faces: Faces) -> float:
    """Volume enclosed, for closed meshes with outward normals."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def evenly(count: int, most: int) -> NDArray[np.int64]:
    """Evenly spread numbers below a count, so many at most."""
    return np.unique(np.linspace(0, count - 1, min(most, count)).astype(np.int64))
