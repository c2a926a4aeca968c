"""Nodes of a deformation part of the way: turned by their share, and placed so that the body keeps its lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.cuts.nodes import DeformationGraph
from tvmedit.cuts.rotations import rotation_matrices, rotation_vectors

Array = NDArray[np.float64]
AT_REST = 0.02
"""Share of the body's extent below which nodes count as hardly moved."""


def partly(graph: DeformationGraph, rotations: Array, moves: Array, share: float) -> tuple[Array, Array]:
    """Rotations (m, 3, 3) and moves (m, 3) of a share of a deformation: 0 none of it, 1 all of it.

    Moved straight, a limb that swings would be too short half-way. Here the way from node to node is turned by the
    share of each end's rotation, as long as the share says, and the nodes are placed where these ways fit best (least
    squares). Where the body stands is told by the nodes that move least over the ground, such as feet on it.
    """
    turned = rotation_matrices(share * rotation_vectors(rotations))
    places = graph.places
    if not len(graph.edges):
        return turned, share * moves
    first, second = graph.edges.T
    rest, now = places[second] - places[first], (places + moves)[second] - (places + moves)[first]
    ways = 0.5 * sum(
        np.einsum("eij,ej->ei", turned[end], (1 - share) * rest + share * np.einsum("eji,ej->ei", rotations[end], now))
        for end in (first, second)
    )
    count = len(places)
    right = np.zeros((count, 3))
    np.add.at(right, second, ways)
    np.add.at(right, first, -ways)
    part = _parts(count, graph.edges)
    placed = _fitted(count, graph.edges, part, right)
    straight = places + share * moves
    steps = np.linalg.norm(moves[:, :2], axis=1)
    slow = AT_REST * float(np.ptp(places, axis=0).max())
    weights = 1.0 / (steps**2 + slow**2)
    for number in range(int(part.max()) + 1):
        mine = part == number
        placed[mine] += np.average(straight[mine] - placed[mine], axis=0, weights=weights[mine])
    return turned, placed - places


def _parts(count: int, edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Which connected part each node belongs to."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    table = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return np.asarray(connected_components(table, directed=False)[1], np.int64)


def _fitted(count: int, edges: NDArray[np.int64], part: NDArray[np.int64], right: Array) -> Array:
    """Places (m, 3) whose differences fit best, the first node of each part at 0."""
    from scipy.linalg import cho_factor, cho_solve

    matrix = np.zeros((count, count))
    first, second = edges.T
    np.add.at(matrix, (first, second), -1.0)
    np.add.at(matrix, (second, first), -1.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    held = np.unique(part, return_index=True)[1]
    matrix[held, held] += 1.0
    return np.asarray(cho_solve(cho_factor(matrix), right))
