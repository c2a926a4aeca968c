"""Key-pose interpolation by differential coordinates: local edges and rotations blended ([35] in paper A)."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from imitation.motion.banded import Array
from imitation.progress import Progress, silent


def interpolate_poses(
    rest: Array, faces: NDArray[np.int32], poses: Mapping[int, Array], count: int, progress: Progress | None = None
) -> Array:
    """Vertices (n, v, 3) between given poses; before the first and after the last they are held.

    Between two poses each one-ring is turned by a growing share of its rotation from the one to the other while its
    edges blend, the surface is put together again in the least-squares sense, and its centroid moves straight.
    """
    report = progress or silent
    frames = sorted(poses)
    result = np.empty((count, *rest.shape))
    result[: frames[0] + 1] = poses[frames[0]]
    result[frames[-1] :] = poses[frames[-1]]
    mesh = _Rings(rest, faces)
    for first, last in pairwise(frames):
        result[last] = poses[last]
        if last - first > 1:
            between = mesh.between(poses[first], poses[last])
            for frame in range(first + 1, last):
                report(frame / count)
                result[frame] = between((frame - first) / (last - first))
    report(1.0)
    return result


class _Rings:
    """The mesh's edges with their weights, and its Laplacian factored once."""

    def __init__(self, rest: Array, faces: NDArray[np.int32]) -> None:
        from scipy import sparse
        from scipy.sparse.linalg import splu

        from imitation.geometry import prepare_mesh

        self.mesh = prepare_mesh(rest, faces)
        weights = sparse.coo_array(self.mesh.weights)
        keep = (weights.row != weights.col) & (weights.data > 0)
        self.tail, self.head, self.weight = weights.row[keep], weights.col[keep], weights.data[keep]
        self.count = len(self.mesh.positions)
        graph = sparse.coo_array((self.weight, (self.tail, self.head)), shape=(self.count,) * 2).tocsr()
        laplacian = (sparse.diags_array(graph.sum(axis=1)) - graph).tocsc()
        self.factor = splu(laplacian[1:, 1:])
        self.welded = np.zeros(self.count, np.int64)
        self.welded[self.mesh.index[::-1]] = np.arange(len(rest))[::-1]

    def between(self, first: Array, last: Array) -> _Blend:
        """Everything that does not depend on the share."""
        return _Blend(self, first[self.welded], last[self.welded])

    def edges(self, positions: Array) -> Array:
        """Edge vectors (e, 3) from tail to head."""
        vectors: Array = positions[self.head] - positions[self.tail]
        return vectors

    def assemble(self, edges: Array, centroid: Array) -> Array:
        """Positions whose edges are nearest to the given ones, with the given centroid, in the caller's order."""
        flow = self.weight[:, None] * edges
        right = np.empty((self.count, 3))
        for axis in range(3):
            into = np.bincount(self.head, flow[:, axis], self.count)
            right[:, axis] = into - np.bincount(self.tail, flow[:, axis], self.count)
        positions = np.zeros((self.count, 3))
        # Each edge is there in both directions, so it pulls twice.
        positions[1:] = self.factor.solve(right[1:] / 2)
        placed: Array = (positions + centroid - positions.mean(axis=0))[self.mesh.index]
        return placed


class _Blend:
    """Poses between two poses."""

    def __init__(self, rings: _Rings, first: Array, last: Array) -> None:
        from scipy.spatial.transform import Rotation

        self.rings = rings
        self.centroids = first.mean(axis=0), last.mean(axis=0)
        self.start = rings.edges(first)
        end = rings.edges(last)
        moments = np.zeros((rings.count, 3, 3))
        np.add.at(moments, rings.tail, rings.weight[:, None, None] * end[:, :, None] * self.start[:, None, :])
        # A ring of few or nearly collinear edges leaves its turn open; its neighbours' rings decide.
        around = rings.weight[:, None, None] * moments[rings.head]
        spread = np.zeros_like(moments)
        np.add.at(spread, rings.tail, around)
        total = np.bincount(rings.tail, rings.weight, rings.count)
        u, _, v = np.linalg.svd(moments + 0.1 * spread / total[:, None, None])
        u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]
        self.turns = Rotation.from_matrix(u @ v).as_rotvec()
        back = Rotation.from_rotvec(-self.turns[rings.tail])
        self.end = back.apply(end)

    def __call__(self, share: float) -> Array:
        """The pose at a share in (0, 1) of the way."""
        from scipy.spatial.transform import Rotation

        edges = (1 - share) * self.start + share * self.end
        turned = Rotation.from_rotvec(share * self.turns[self.rings.tail]).apply(edges)
        centroid = (1 - share) * self.centroids[0] + share * self.centroids[1]
        return self.rings.assemble(turned, centroid)
