"""Limbs found again however far they moved: ends of a body, and places told by their distances from them.

Closest points lose a limb that is elsewhere. Distances along the surface do not change when a limb swings, so the ends
of limbs (where the distance from the middle is largest around) and the distances of all other places from them say
which part is which in both meshes, whatever the pose.
"""

from __future__ import annotations

import itertools

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.cuts.nodes import adjacency, vertex_normals
from tvmedit.features.measure import vertex_areas

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
Counterparts = tuple[NDArray[np.int64], Array]
"""Vertices of one body, and where they are in the other."""
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
BEGINNINGS = 6.0
"""Weight of where limbs begin beside where they are: hips and shoulders keep their places on the trunk."""
UNLIKE = 0.45
"""Of the longest: bodies whose ends lie so much further from or nearer to each other, on average, are not the same."""
CLEAR = 0.03
"""How much worse the next best way to match limbs must be, in squares of the longest; otherwise sides are not told."""
AROUND_ENDS = np.array([0.15, 0.3])
"""Of the longest: a hand has less surface so near to its end than a head has, whatever the pose."""
SIZES, OTHER_SIZE = 0.3, 0.5
"""Weight of the squared logarithm of how much more that is, and the most that counts: limbs that touch share it."""
HOLLOW = (10.0, 25.0)
"""Curvature along an edge from which it counts as hollow, and counts fully, over the root of the body's surface."""
DETOUR = 20.0
"""How much longer ways through hollows count."""
NEAR = 0.25
"""Of the longest: distances from an end count by their logarithm beyond this, for the far ones change with the pose."""
BLUR = 0.1
"""Width of the places that are averaged: wider than a limb is thick, so that they are its middle line."""
LIMB = 0.55
"""Of the way to the next end: so far from its own a limb reaches."""
SAMPLES = 900


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


def limb_ends(vertices: Array, faces: Faces, *, around_hollows: bool = True) -> Ends | None:
    """Find the ends of a body's limbs, the furthest first; None where it hangs too little together or has none.

    Around hollows, where limbs that touch the body are one surface with it, or straight through them: truer for a body
    whose limbs are free.
    """
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    offsets, neighbours, lengths = adjacency(vertices, faces)
    if around_hollows:
        lengths = lengths * _detour(vertices, faces, offsets, neighbours, lengths)
    # Vertices that share a place would have edges of no length, which a sparse table takes for none.
    table = csr_matrix((np.maximum(lengths, 1e-12), neighbours, offsets), shape=(len(vertices),) * 2)
    middle = int(np.argmin(((vertices - vertices.mean(axis=0)) ** 2).sum(axis=1)))
    out = np.asarray(dijkstra(table, directed=False, indices=np.array([middle])))[0]
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
        row = np.asarray(dijkstra(table, directed=False, indices=np.array([end])))[0]
        near = row < AROUND * reach
        if out[end] >= out[near].max():
            chosen.append(end)
            rows.append(row)
        open_ &= ~near
    if len(chosen) < FEWEST_ENDS:
        return None
    distances = np.array(rows)
    middles = np.array([_middle_line(vertices, row, out, out[end]) for row, end in zip(rows, chosen, strict=True)])
    if not np.isfinite(middles).all():
        return None
    area, _ = vertex_areas(vertices, faces)
    sizes = (distances[:, :, None] < AROUND_ENDS * reach).transpose(0, 2, 1) @ area / area.sum()
    return Ends(distances, np.array(chosen), reach, middles, sizes)


def limb_count(vertices: Array, faces: Faces) -> int:
    """How many limbs of a body hang free; 0 where it has too few to tell."""
    ends = limb_ends(vertices, faces, around_hollows=False)
    return 0 if ends is None else min(len(ends.vertices), FREE_ENDS)


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

    used, ends = np.unique(edges, return_inverse=True)
    if not len(used):
        return 0, 0
    first, second = ends.reshape(-1, 2).T
    table = coo_matrix((np.ones(len(first)), (first, second)), shape=(len(used), len(used)))
    return int(connected_components(table, directed=False)[0]), len(used)


def _detour(
    vertices: Array, faces: Faces, offsets: NDArray[np.int64], neighbours: NDArray[np.int64], lengths: Array
) -> Array:
    """How many times as long each edge counts: much where the surface bends inwards along it.

    A hand that rests on a hip is one surface with it; a way over the bridge between them goes through a hollow, one
    along the body does not.
    """
    rows = np.repeat(np.arange(len(vertices)), np.diff(offsets))
    normals = vertex_normals(vertices, faces)
    around = [np.bincount(rows, weights=normals[neighbours, axis], minlength=len(vertices)) for axis in range(3)]
    normals = normals + np.stack(around, axis=1) / np.maximum(np.diff(offsets), 1)[:, None]
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


def counterparts(source: tuple[Array, Faces], target: tuple[Array, Faces]) -> Counterparts | None:
    """Where places of one body are in the other.

    Parameters
    ----------
    source, target : (vertices, faces)
        Aligned, z up.

    Returns
    -------
    (vertices of the source (n,), where they are in the target (n, 3)), or None where limbs cannot be told
        Of places around a limb the middle moves: how it turns about itself is not told.
    """
    if len(source[0]) == len(target[0]) and np.array_equal(source[1], target[1]):
        # One mesh that moves: every vertex is its own counterpart.
        same = _picked(len(source[0]))
        return same, target[0][same]
    matched = _matched(source, target)
    return None if matched is None else _counterparts(source, target, *matched)


def end_places(source: tuple[Array, Faces], target: tuple[Array, Faces]) -> Counterparts | None:
    """Where the ends of a body's limbs are in the other: as ``counterparts``, but of the ends (e,) alone, exactly."""
    matched = _matched(source, target)
    if matched is None:
        return None
    ours, theirs, (mine, other) = matched
    return ours.vertices[mine], target[0][theirs.vertices[other]]


def _matched(
    source: tuple[Array, Faces], target: tuple[Array, Faces]
) -> tuple[Ends, Ends, tuple[list[int], list[int]]] | None:
    """Ends of both bodies and which is which: straight through hollows where all hang free, else around them."""
    for around in (False, True):
        ours, theirs = (limb_ends(*mesh, around_hollows=around) for mesh in (source, target))
        if ours is None or theirs is None:
            continue
        free = min(len(ours.vertices), len(theirs.vertices)) >= FREE_ENDS
        pairs = matched_ends(ours, theirs) if free or around else None
        if pairs is not None:
            return ours, theirs, pairs
    return None


def _counterparts(
    source: tuple[Array, Faces],
    target: tuple[Array, Faces],
    ours: Ends,
    theirs: Ends,
    pairs: tuple[list[int], list[int]],
) -> Counterparts:
    """See ``counterparts``, with the ends matched."""
    mine, other = pairs
    scale = 0.5 * (ours.reach + theirs.reach)
    here, there = _picked(len(source[0])), _picked(len(target[0]))
    shift = np.full((len(here), 3), np.nan)
    a = np.log(ours.distances[mine][:, here].T / scale + NEAR)
    b = np.log(theirs.distances[other][:, there].T / scale + NEAR)
    told, known = np.isfinite(a).all(axis=1), np.isfinite(b).all(axis=1)
    own, own_weight = _averaged(a[told], a[told], source[0][here[told]])
    far, far_weight = _averaged(a[told], b[known], target[0][there[known]])
    # Without anything alike on the other side a place has no counterpart.
    shift[told] = np.where((far_weight > 0.05 * own_weight * known.sum() / told.sum())[:, None], far - own, np.nan)
    for first, second in zip(mine, other, strict=True):
        limb, by = _along_limb(source[0], target[0], ours, theirs, first, second, here)
        shift[limb] = by
    kept = np.isfinite(shift).all(axis=1)
    return here[kept], source[0][here[kept]] + shift[kept]


def _along_limb(
    source: Array, target: Array, ours: Ends, theirs: Ends, first: int, second: int, here: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], Array]:
    """Which of the places lie on a limb, and how far its middle line moves there, by the distance from its end."""
    lines, far = [], np.inf
    for ends, number in ((ours, first), (theirs, second)):
        between = np.delete(ends.distances[number, ends.vertices], number)
        far = min(far, LIMB * float(between[np.isfinite(between)].min(initial=ends.reach)))
    marks = np.linspace(0.0, far, 12)
    for vertices, ends, number in ((source, ours, first), (target, theirs, second)):
        row = ends.distances[number]
        nearest = row <= np.min(ends.distances, axis=0) + 1e-12
        middles = np.full((len(marks), 3), np.nan)
        for k, mark in enumerate(marks):
            ring = nearest & (np.abs(row - mark) < 0.75 * marks[1])
            if ring.any():
                middles[k] = vertices[ring].mean(axis=0)
        lines.append(middles)
    moved = lines[1] - lines[0]
    row = ours.distances[first, here]
    limb = (row <= np.min(ours.distances[:, here], axis=0) + 1e-12) & (row < far)
    return limb, np.stack([np.interp(row[limb], marks, moved[:, axis]) for axis in range(3)], axis=1)


def matched_ends(ours: Ends, theirs: Ends) -> tuple[list[int], list[int]] | None:
    """Match the ends of two bodies by their distances from each other, left and right by where limbs begin."""
    if max(len(ours.vertices), len(theirs.vertices)) <= FEWEST_ENDS:
        # One of each is lost, as a hand that lies on the hip is; nothing says that it is the same one.
        return None
    swapped = len(ours.vertices) > len(theirs.vertices)
    few, many = (theirs, ours) if swapped else (ours, theirs)
    scale = 0.5 * (few.reach + many.reach)
    between = [_symmetric(ends.distances[:, ends.vertices]) for ends in (few, many)]
    # The nearer to the middle of the body, the less a limb's place depends on the pose.
    share = STATIONS[:-1] / STATIONS[:-1].sum()
    apart = ((few.middles[:, None, :-1] - many.middles[None, :, :-1]) ** 2).sum(axis=3) @ share
    sizes = np.log(few.sizes[:, None] / many.sizes[None]) ** 2
    other = SIZES * scale**2 * np.minimum(sizes, OTHER_SIZE).sum(axis=2)
    costs = []
    pairs = np.triu_indices(len(few.vertices), 1)
    for order in itertools.permutations(range(len(many.vertices)), len(few.vertices)):
        unlike = float(np.abs(between[0] - between[1][np.ix_(order, order)])[pairs].mean()) / scale
        if unlike <= UNLIKE:
            limbs = (apart + other)[np.arange(len(order)), order].sum() + (2.0 * scale * unlike) ** 2
            trunk = _rigidly_apart(few.middles[:, -1], many.middles[list(order), -1])
            costs.append((limbs + BEGINNINGS * trunk, order))
    costs.sort()
    if not costs or (len(costs) > 1 and costs[1][0] < costs[0][0] + CLEAR * scale**2):
        return None
    first, second = list(range(len(few.vertices))), list(costs[0][1])
    return (second, first) if swapped else (first, second)


def _rigidly_apart(first: Array, second: Array) -> float:
    """Sum of squared distances after the best turn and shift; a mirrored body is far apart."""
    a, b = first - first.mean(axis=0), second - second.mean(axis=0)
    left, values, right = np.linalg.svd(a.T @ b)
    values[-1] *= np.sign(np.linalg.det(left @ right))
    return float((a**2).sum() + (b**2).sum() - 2.0 * values.sum())


def _symmetric(distances: Array) -> Array:
    return 0.5 * (distances + distances.T)


def _picked(count: int) -> NDArray[np.int64]:
    return np.unique(np.linspace(0, count - 1, min(SAMPLES, count)).astype(np.int64))


def _averaged(wanted: Array, known: Array, places: Array) -> tuple[Array, Array]:
    """Mean place of what is alike, weighted by how much, and the sum of the weights."""
    square = (wanted**2).sum(axis=1)[:, None] + (known**2).sum(axis=1) - 2.0 * wanted @ known.T
    weight = np.exp(-np.maximum(square, 0.0) / (2.0 * BLUR**2))
    total = weight.sum(axis=1)
    return weight @ places / np.maximum(total, 1e-300)[:, None], total
