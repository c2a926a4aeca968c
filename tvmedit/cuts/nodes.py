"""Nodes of a deformation graph on a mesh, and which vertex follows which, by distances along the surface."""

from __future__ import annotations

import heapq

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Adjacency = tuple[Index, Index, Array]
"""Where each vertex's neighbours begin (v + 1,), the neighbours, how far each is."""
FOLLOWED = 4
"""Nodes a vertex follows."""
MOST_STARTS = 300
"""So many ways to number the nodes of a part are tried."""


@attrs.frozen(eq=False)
class DeformationGraph:
    """Nodes spread over a mesh.

    Attributes
    ----------
    places : (m, 3) float64
    bound : (v, 4) int64
        Nodes each vertex follows; repeated with weight 0 where there are fewer.
    weights : (v, 4) float64
        Sum to 1.
    edges : (e, 2) int64
        Pairs of nodes that some vertex follows together.
    bandwidth : int
        Largest difference of the numbers of such a pair, plus 1: nodes are numbered along the body.
    """

    places: Array
    bound: Index
    weights: Array
    edges: Index
    bandwidth: int


def spread_nodes(
    vertices: Array, faces: NDArray[np.int32], spacing: float, around: Adjacency | None = None
) -> DeformationGraph:
    """Cover a mesh greedily with nodes about one spacing apart along the surface.

    Distances run along edges, never through the air: otherwise a hand beside a hip would follow the hip. ``around`` is
    what ``adjacency`` gives, if it is there already.
    """
    offsets, neighbours, lengths = around or adjacency(vertices, faces)
    chosen, bound, distances = _cover(len(vertices), offsets, neighbours, lengths, spacing)
    weights = np.exp(-((distances / spacing) ** 2))
    weights[~np.isfinite(distances)] = 0.0
    bound = np.where(np.isfinite(distances), bound, bound[:, :1])
    weights /= weights.sum(axis=1, keepdims=True)
    pairs = np.concatenate([bound[:, [a, b]] for a in range(FOLLOWED) for b in range(a + 1, FOLLOWED)])
    # One number for each pair: rows are slow to tell apart.
    named = np.unique(pairs.min(axis=1) * len(chosen) + pairs.max(axis=1))
    pairs = np.stack(np.divmod(named, len(chosen)), axis=1)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    order = _along(len(chosen), pairs)
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    pairs, bound = rank[pairs], rank[bound]
    widest = int(np.abs(pairs[:, 0] - pairs[:, 1]).max(initial=0)) + 1
    return DeformationGraph(vertices[chosen[order]], bound, weights, pairs, widest)


def _along(count: int, pairs: Index) -> Index:
    """Number nodes so that those which meet have near numbers: in waves (Cuthill and McKee 1969), the best start."""
    ends = np.concatenate([pairs, pairs[:, ::-1]])
    degree = np.bincount(ends[:, 0], minlength=count)
    # Of each node's neighbours, those with few neighbours of their own come first.
    ends = ends[np.lexsort((ends[:, 1], degree[ends[:, 1]], ends[:, 0]))]
    return _waves(np.concatenate([[0], np.cumsum(degree)]), np.ascontiguousarray(ends[:, 1]))


@compiled
def _waves(offsets: Index, neighbours: Index) -> Index:
    """Order of nodes (m,) in waves, each part from that of its nodes, or of some of them, that keeps meeting ones near.

    Against a start chosen by its degree the largest difference shrinks by a quarter or more on bodies, and with its
    square the time of a solution.
    """
    count = len(offsets) - 1
    order, best, rank = np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count, np.int64)
    done, seen = np.zeros(count, np.bool_), np.full(count, -1)
    placed = 0
    for root in range(count):
        if done[root]:
            continue
        size, narrowest, tries, starts = 1, count + 1, 1, np.array([root])
        tried = 0
        while tried < tries:
            start = starts[tried * len(starts) // tries]
            length = 1
            order[0], rank[start], seen[start] = start, 0, start
            widest, at = 0, 0
            while at < length and widest < narrowest:
                node = order[at]
                for row in range(offsets[node], offsets[node + 1]):
                    other = neighbours[row]
                    if seen[other] != start:
                        order[length], rank[other], seen[other] = other, length, start
                        length += 1
                    widest = max(widest, rank[other] - at)
                at += 1
            if widest < narrowest:
                size, narrowest = length, widest
                best[placed : placed + size] = order[:size]
            if len(starts) == 1 and size > 1:
                # The first wave has found out what hangs together.
                starts, tries, tried = order[:size].copy(), min(size, MOST_STARTS), -1
                seen[:] = -1
            tried += 1
        for k in range(placed, placed + size):
            done[best[k]] = True
        placed += size
    return best


def vertex_normals(vertices: Array, faces: NDArray[np.int32]) -> Array:
    """Unit normals (v, 3), triangles weighted by area; (0, 0, 0) where a vertex has none."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    out = np.zeros_like(vertices)
    for k in range(3):
        for axis in range(3):
            out[:, axis] += np.bincount(faces[:, k], weights=normal[:, axis], minlength=len(vertices))
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))


def adjacency(vertices: Array, faces: NDArray[np.int32]) -> Adjacency:
    """Neighbours of each vertex with edge lengths, as one row-compressed table."""
    from scipy.sparse import coo_matrix

    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = np.concatenate([ends, ends[:, ::-1]])
    count = len(vertices)
    table = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count)).tocsr()
    rows = np.repeat(np.arange(count), np.diff(table.indptr))
    lengths = np.linalg.norm(vertices[rows] - vertices[table.indices], axis=1)
    return table.indptr.astype(np.int64), table.indices.astype(np.int64), lengths


@compiled
def _cover(count: int, offsets: Index, neighbours: Index, lengths: Array, spacing: float) -> tuple[Index, Index, Array]:
    """Nodes (vertex numbers), the four nearest nodes of each vertex, and their distances."""
    covered = np.zeros(count, np.bool_)
    chosen = np.empty(count, np.int64)
    nodes = 0
    nearest = np.zeros((count, FOLLOWED), np.int64)
    distances = np.full((count, FOLLOWED), np.inf)
    reached = np.full(count, np.inf)
    touched = np.empty(count, np.int64)
    for vertex in range(count):
        if covered[vertex]:
            continue
        chosen[nodes] = vertex
        touched[0], tally = vertex, 1
        reached[vertex] = 0.0
        queue = [(0.0, vertex)]
        while len(queue) > 0:
            far, at = heapq.heappop(queue)
            # Four nodes that are nearer are nearer to all that lies behind, too.
            if far > reached[at] or far >= distances[at, FOLLOWED - 1]:
                continue
            if far <= spacing:
                covered[at] = True
            slot = FOLLOWED
            while slot > 0 and far < distances[at, slot - 1]:
                slot -= 1
            if slot < FOLLOWED:
                for k in range(FOLLOWED - 1, slot, -1):
                    distances[at, k], nearest[at, k] = distances[at, k - 1], nearest[at, k - 1]
                distances[at, slot], nearest[at, slot] = far, nodes
            for row in range(offsets[at], offsets[at + 1]):
                further, other = far + lengths[row], neighbours[row]
                if further < reached[other] and further <= 2.6 * spacing:
                    if reached[other] == np.inf:
                        touched[tally] = other
                        tally += 1
                    reached[other] = further
                    heapq.heappush(queue, (further, other))
        for k in range(tally):
            reached[touched[k]] = np.inf
        nodes += 1
    return chosen[:nodes].copy(), nearest, distances
