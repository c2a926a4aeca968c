"""How far each vertex of a deformed mesh is stretched or squeezed, against its shape at rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.geometry.measures import unique_edges
from imitation.geometry.projection import Array


class VertexStretch:
    """Measures poses of one mesh; what depends on its shape at rest alone is prepared once.

    Parameters
    ----------
    rest : (v, 3). faces : (m, 3).
    """

    def __init__(self, rest: ArrayLike, faces: ArrayLike) -> None:
        places = np.asarray(rest, np.float64)
        edges = unique_edges(faces)
        length = np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1)
        kept = length > 0
        self._edges, self._length = edges[kept], length[kept]
        self._count = len(places)
        ends = self._edges.T.ravel()
        order = np.argsort(ends, kind="stable")
        self._owner = np.tile(np.arange(len(self._edges)), 2)[order]
        self._touched, self._starts = np.unique(ends[order], return_index=True)

    def __call__(self, posed: ArrayLike) -> Array:
        """Length over length at rest (v,) of the edge at each vertex that has changed most; 1 where none has.

        Raises ``InputError`` for a pose with another number of vertices.
        """
        places = np.asarray(posed, np.float64)
        if places.shape != (self._count, 3):
            raise InputError(f"The pose needs {self._count} vertices as the mesh at rest, but has {places.shape}.")
        stretch = np.ones(self._count)
        if len(self._starts):
            now = np.linalg.norm(places[self._edges[:, 0]] - places[self._edges[:, 1]], axis=1)
            change = np.log(np.maximum(now / self._length, 1e-6))[self._owner]
            longest = np.maximum.reduceat(change, self._starts)
            shortest = np.minimum.reduceat(change, self._starts)
            stretch[self._touched] = np.exp(np.where(longest >= -shortest, longest, shortest))
        return stretch
