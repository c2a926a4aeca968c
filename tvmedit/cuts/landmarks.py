"""Limbs found again however far they moved: ends of a body, and places told by their distances from them.

Closest points lose a limb that is elsewhere. Distances along the surface do not change when a limb swings, so the ends
of limbs (where the distance from the middle is largest around) and the distances of all other places from them say
which part is which in both meshes, whatever the pose.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled
from tvmedit.cuts.limbs import FEWEST_ENDS, FREE_ENDS, STATIONS, Ends
from tvmedit.cuts.surface import Mesh, Surface, evenly

Array = NDArray[np.float64]
Counterparts = tuple[NDArray[np.int64], Array]
"""Vertices of one body, and where they are in the other."""
BEGINNINGS = 6.0
"""Weight of where limbs begin beside where they are: hips and shoulders keep their places on the trunk."""
UNLIKE = 0.45
"""Of the longest: bodies whose ends lie so much further from or nearer to each other, on average, are not the same."""
CLEAR = 0.03
"""How much worse the next best way to match limbs must be, in squares of the longest; otherwise sides are not told."""
SIZES, OTHER_SIZE = 0.3, 0.5
"""Weight of the squared logarithm of how much more that is, and the most that counts: limbs that touch share it."""
NEAR = 0.25
"""Of the longest: distances from an end count by their logarithm beyond this, for the far ones change with the pose."""
BLUR = 0.1
"""Width of the places that are averaged: wider than a limb is thick, so that they are its middle line."""
ALIKE = 40.0
"""Places whose weight would be below exp(-40) count as not alike at all."""
LIMB = 0.55
"""Of the way to the next end: so far from its own a limb reaches."""
SAMPLES = 900


def counterparts(source: Mesh, target: Mesh) -> Counterparts | None:
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
    source, target = Surface.of(source), Surface.of(target)
    if len(source.vertices) == len(target.vertices) and np.array_equal(source.faces, target.faces):
        # One mesh that moves: every vertex is its own counterpart.
        same = evenly(len(source.vertices), SAMPLES)
        return same, target.vertices[same]
    matched = _matched(source, target)
    return None if matched is None else _counterparts(source.vertices, target.vertices, *matched)


def end_places(source: Mesh, target: Mesh) -> Counterparts | None:
    """Where the ends of a body's limbs are in the other: as ``counterparts``, but of the ends (e,) alone, exactly."""
    source, target = Surface.of(source), Surface.of(target)
    matched = _matched(source, target)
    if matched is None:
        return None
    ours, theirs, (mine, other) = matched
    return ours.vertices[mine], target.vertices[theirs.vertices[other]]


def _matched(source: Surface, target: Surface) -> tuple[Ends, Ends, tuple[list[int], list[int]]] | None:
    """Ends of both bodies and which is which: straight through hollows where all hang free, else around them."""
    for around in (False, True):
        ours, theirs = (mesh.ends(around_hollows=around) for mesh in (source, target))
        if ours is None or theirs is None:
            continue
        free = min(len(ours.vertices), len(theirs.vertices)) >= FREE_ENDS
        pairs = matched_ends(ours, theirs) if free or around else None
        if pairs is not None:
            return ours, theirs, pairs
    return None


def _counterparts(
    source: Array,
    target: Array,
    ours: Ends,
    theirs: Ends,
    pairs: tuple[list[int], list[int]],
) -> Counterparts:
    """See ``counterparts``, with the ends matched."""
    mine, other = pairs
    scale = 0.5 * (ours.reach + theirs.reach)
    here, there = evenly(len(source), SAMPLES), evenly(len(target), SAMPLES)
    shift = np.full((len(here), 3), np.nan)
    a = np.ascontiguousarray(np.log(ours.distances[mine][:, here].T / scale + NEAR))
    b = np.ascontiguousarray(np.log(theirs.distances[other][:, there].T / scale + NEAR))
    told, known = np.isfinite(a).all(axis=1), np.isfinite(b).all(axis=1)
    own, own_weight = _averaged(a[told], a[told], source[here[told]])
    far, far_weight = _averaged(a[told], b[known], target[there[known]])
    # Without anything alike on the other side a place has no counterpart.
    shift[told] = np.where((far_weight > 0.05 * own_weight * known.sum() / told.sum())[:, None], far - own, np.nan)
    for first, second in zip(mine, other, strict=True):
        limb, by = _along_limb(source, target, ours, theirs, first, second, here)
        shift[limb] = by
    kept = np.isfinite(shift).all(axis=1)
    return here[kept], source[here[kept]] + shift[kept]


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
    orders = np.array(list(itertools.permutations(range(len(many.vertices)), len(few.vertices))))
    first, second = np.triu_indices(len(few.vertices), 1)
    wanted = between[0][first, second]
    unlike = np.abs(wanted - between[1][orders[:, first], orders[:, second]]).mean(axis=1) / scale
    orders, unlike = orders[unlike <= UNLIKE], unlike[unlike <= UNLIKE]
    if not len(orders):
        return None
    limbs = (apart + other)[np.arange(orders.shape[1]), orders].sum(axis=1) + (2.0 * scale * unlike) ** 2
    costs = limbs + BEGINNINGS * _rigidly_apart(few.middles[:, -1], many.middles[orders, -1])
    ranking = np.argsort(costs, kind="stable")
    if len(ranking) > 1 and costs[ranking[1]] < costs[ranking[0]] + CLEAR * scale**2:
        return None
    matched = list(range(len(few.vertices))), orders[ranking[0]].tolist()
    return matched[::-1] if swapped else matched


def _rigidly_apart(first: Array, second: Array) -> Array:
    """Sums of squared distances (n,) of points (p, 3) from others (n, p, 3) after the best turn and shift.

    A mirrored body is far apart.
    """
    a, b = first - first.mean(axis=0), second - second.mean(axis=1, keepdims=True)
    left, values, right = np.linalg.svd(a.T @ b)
    values[:, -1] *= np.sign(np.linalg.det(left @ right))
    return np.asarray((a**2).sum() + (b**2).sum(axis=(1, 2)) - 2.0 * values.sum(axis=1))


def _symmetric(distances: Array) -> Array:
    return 0.5 * (distances + distances.T)


@compiled
def _averaged(wanted: Array, known: Array, places: Array) -> tuple[Array, Array]:
    """Mean place of what is alike, weighted by how much, and the sum of the weights."""
    means, totals = np.zeros((len(wanted), 3)), np.zeros(len(wanted))
    furthest = 2.0 * ALIKE * BLUR**2
    for i in range(len(wanted)):
        for j in range(len(known)):
            square = 0.0
            for k in range(wanted.shape[1]):
                square += (wanted[i, k] - known[j, k]) ** 2
                if square > furthest:
                    break
            if square > furthest:
                continue
            weight = np.exp(-square / (2.0 * BLUR**2))
            totals[i] += weight
            for axis in range(3):
                means[i, axis] += weight * places[j, axis]
        if totals[i] > 0.0:
            for axis in range(3):
                means[i, axis] /= totals[i]
    return means, totals
