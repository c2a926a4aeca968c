"""Geodesic regions of key vertices and which of them touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.measures import unique_edges
from imitation.geometry.prepare import check_mesh, prepare_mesh


def geodesic_regions(vertices: ArrayLike, faces: ArrayLike, key_vertices: ArrayLike) -> NDArray[np.int64]:
    """For each vertex (n,) the position in ``key_vertices`` of the key that is nearest along the edges of the mesh.

    Separate parts count as joined where they come nearest (see ``prepare_mesh``). Ties go to the smaller position.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import dijkstra

    points, triangles = check_mesh(vertices, faces)
    keys = np.asarray(key_vertices, np.int64)
    if not len(keys):
        raise InputError("Regions need at least one key vertex.")
    if keys.min() < 0 or keys.max() >= len(points):
        raise InputError(
            f"A key vertex does not exist: the mesh has {len(points)} vertices, {keys.tolist()} were given."
        )
    mesh = prepare_mesh(points, triangles)
    ties = sparse.coo_array(mesh.weights)
    edges = np.concatenate([unique_edges(mesh.triangles), np.stack([ties.row, ties.col], axis=1)])
    length = np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
    # Shortest, not summed: the same edge may come from a face and from a weight.
    order = np.lexsort((length, edges.max(axis=1), edges.min(axis=1)))
    ends = np.sort(edges[order], axis=1)
    first = np.concatenate([[True], (ends[1:] != ends[:-1]).any(axis=1)])
    ends, length = ends[first], np.maximum(length[order][first], 1e-12)
    graph = sparse.csr_array((length, (ends[:, 0], ends[:, 1])), shape=(len(mesh.positions),) * 2)
    distance = dijkstra(graph, directed=False, indices=mesh.index[keys])
    nearest: NDArray[np.int64] = np.argmin(distance, axis=0)[mesh.index]
    return nearest


def key_adjacency(vertices: ArrayLike, faces: ArrayLike, key_vertices: ArrayLike) -> NDArray[np.int64]:
    """Pairs (p, 2) of positions in ``key_vertices`` whose geodesic regions touch, smaller first, sorted.

    These are the pairs whose distance a moving body roughly keeps.
    """
    region = geodesic_regions(vertices, faces, key_vertices)
    mesh = prepare_mesh(vertices, faces)
    welded = np.zeros(len(mesh.positions), np.int64)
    welded[mesh.index] = region
    from scipy import sparse

    ties = sparse.coo_array(mesh.weights)
    edges = np.concatenate([unique_edges(mesh.triangles), np.stack([ties.row, ties.col], axis=1)])
    pairs = np.sort(welded[edges], axis=1)
    return np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)
