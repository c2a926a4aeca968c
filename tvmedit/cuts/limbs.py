"""Limbs of a body: where they end, how many hang free, and how often they are grown together with it."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.cuts.nodes import Adjacency, adjacency, vertex_normals
from tvmedit.features.measure import vertex_areas

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
MOST_ENDS, FEWEST_ENDS = 6, 4
FREE_ENDS = 5
"""A head and four limbs: more ends than that are no sign of more freedom."""
SHORTEST = 0.45
"""Of the longest: limbs that reach less far from the middle are none."""
AROUND = 0.3
"""Of the longest: an end is further out than all that lies so near."""
HANGING_TOGETHER = 0.9
"""Share of the vertices that one connected part must have."""
STATIONS = np.array([0.25, 0.5, 0.75, 0.65])
"""Places along a limb, from its end (0) to the middle (1), that tell whose limb it is; the last is where it begins."""
AROUND_ENDS = np.array([0.15, 0.3])
"""Of the longest: a hand has less surface so near to its end than a head has, whatever the pose."""
HOLLOW = (10.0, 25.0)
"""Curvature along an edge from which it counts as hollow, and counts fully, over the root of the body's surface."""
DETOUR = 20.0
"""How much longer ways through hollows count."""


@attrs.frozen(eq=False)
class Ends:
    """Ends of a body's limbs.

    Attributes
    ----------
    distances : (e, v) float64
        Along the surface, of each vertex from each end.
    vertices : (e,) int64
    reach : float
        Of the furthest end from the middle.
    middles : (e, s, 3) float64
        Middle line of each limb at the stations.
    sizes : (e, 2) float64
        Shares of the surface that lie near each end.
    """

    distances: Array
    vertices: NDArray[np.int64]
    reach: float
    middles: Array
    sizes: Array


def limb_ends(
    vertices: Array, faces: Faces, *, around_hollows: bool = True, around: Adjacency | None = None
) -> Ends | None:
    """Find the ends of a body's limbs, the furthest first; None where it hangs too little together or has none.

    Around hollows, where limbs that touch the body are one surface with it, or straight through them: truer for a body
    whose limbs are free. ``around`` is what ``adjacency`` gives, if it is there already.
    """
    around = around or adjacency(vertices, faces)
    found = _found(vertices, around, _detour(vertices, faces, around) if around_hollows else None, whole=True)
    if found is None:
        return None
    chosen, rows, out, reach = found
    distances = np.array(rows)
    middles = np.array([_middle_line(vertices, row, out, out[end]) for row, end in zip(rows, chosen, strict=True)])
    if not np.isfinite(middles).all():
        return None
    area, _ = vertex_areas(vertices, faces)
    sizes = (distances[:, :, None] < AROUND_ENDS * reach).transpose(0, 2, 1) @ area / area.sum()
    return Ends(distances, np.array(chosen), reach, middles, sizes)


def limb_count(vertices: Array, faces: Faces, around: Adjacency | None = None) -> int:
    """How many limbs of a body hang free; 0 where it has too few to tell."""
    found = _found(vertices, around or adjacency(vertices, faces), None, whole=False)
    return 0 if found is None else min(len(found[0]), FREE_ENDS)


def _found(
    vertices: Array, around: Adjacency, detour: Array | None, *, whole: bool
) -> tuple[list[int], list[Array], Array, float] | None:
    """Ends, the distances of all vertices from each (or only of near ones) and from the middle, and the furthest."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    offsets, neighbours, lengths = around
    if detour is not None:
        lengths = lengths * detour
    # Vertices that share a place would have edges of no length, which a sparse table takes for none.
    table = csr_matrix((np.maximum(lengths, 1e-12), neighbours, offsets), shape=(len(vertices),) * 2)
    middle = int(np.argmin(((vertices - vertices.mean(axis=0)) ** 2).sum(axis=1)))
    # The table holds both ways already; told so, the search would look at each edge twice.
    out = np.asarray(dijkstra(table, directed=True, indices=np.array(middle)))
    if np.isfinite(out).mean() < HANGING_TOGETHER:
        return None
    reach = float(out[np.isfinite(out)].max())
    open_ = np.isfinite(out)
    chosen: list[int] = []
    rows: list[Array] = []
    for _ in range(3 * MOST_ENDS):
        left = np.where(open_, out, -1.0)
        end = int(left.argmax())
        if left[end] < SHORTEST * reach or len(chosen) == MOST_ENDS:
            break
        near = np.asarray(dijkstra(table, directed=True, indices=np.array(end), limit=AROUND * reach)) < AROUND * reach
        if out[end] >= out[near].max():
            chosen.append(end)
        open_ &= ~near
    if len(chosen) < FEWEST_ENDS:
        return None
    if whole:
        rows = list(np.asarray(dijkstra(table, directed=True, indices=np.array(chosen))))
    return chosen, rows, out, reach


def handle_count(faces: Faces) -> int:
    """How many ways lead round and back over a surface: one for each limb that touches the body and hangs on besides.

    By the characteristic of Euler: vertices less edges plus faces are two for each closed part, less two for each
    handle and one for each hole.
    """
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1).astype(np.int64)
    # One number for each edge: rows are slow to tell apart.
    size = int(ends.max(initial=0)) + 1
    names, counts = np.unique(ends[:, 0] * size + ends[:, 1], return_counts=True)
    edges = np.stack(np.divmod(names, size), axis=1)
    parts, vertices = _pieces(edges)
    holes, _ = _pieces(edges[counts == 1])
    return max(0, (2 * parts - holes - (vertices - len(edges) + len(faces))) // 2)


def _pieces(edges: NDArray[np.integer]) -> tuple[int, int]:
    """How many pieces edges hang together in, and how many vertices they have."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    size = int(edges.max(initial=-1)) + 1
    if not size:
        return 0, 0
    used = np.zeros(size, np.bool_)
    used[edges] = True
    table = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(size, size))
    count = int(used.sum())
    # A number that no edge has would be a piece of its own.
    return int(connected_components(table, directed=False)[0]) - (size - count), count


def _detour(vertices: Array, faces: Faces, around: Adjacency) -> Array:
    """How many times as long each edge counts: much where the surface bends inwards along it.

    A hand that rests on a hip is one surface with it; a way over the bridge between them goes through a hollow, one
    along the body does not.
    """
    offsets, neighbours, lengths = around
    rows = np.repeat(np.arange(len(vertices)), np.diff(offsets))
    normals = vertex_normals(vertices, faces)
    summed = [np.bincount(rows, weights=normals[neighbours, axis], minlength=len(vertices)) for axis in range(3)]
    normals = normals + np.stack(summed, axis=1) / np.maximum(np.diff(offsets), 1)[:, None]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    ways = vertices[neighbours] - vertices[rows]
    bend = -((normals[neighbours] - normals[rows]) * ways).sum(axis=1) / np.maximum(lengths, 1e-12) ** 2
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    size = np.sqrt(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return np.asarray(1.0 + DETOUR * np.clip((size * bend - HOLLOW[0]) / (HOLLOW[1] - HOLLOW[0]), 0.0, 1.0))


def _middle_line(vertices: Array, row: Array, out: Array, length: float) -> Array:
    """Middle of the limb at each station: of the vertices on about the shortest way from end to middle."""
    places = []
    on_the_way = row + out < 1.15 * length
    for station in STATIONS:
        here = on_the_way & (np.abs(row - station * length) < 0.08 * length)
        places.append(vertices[here].mean(axis=0) if here.any() else np.full(3, np.nan))
    return np.array(places)
