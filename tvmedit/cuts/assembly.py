"""Normal equations of an embedded deformation: what each sample and each pair of nodes adds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled
from tvmedit.cuts.nodes import FOLLOWED

Array = NDArray[np.float64]
Index = NDArray[np.int64]
U1, U2, U3, U4, U5 = (np.uint64(k) for k in range(1, 6))
"""Unsigned: a negative number would have to be looked for at the end of the array."""


@compiled
def deform(points: Array, places: Array, bound: Index, weights: Array, rotations: Array, moves: Array) -> Array:
    """Points (p, 3) carried by their nodes: sum of w (R (x - g) + g + t)."""
    out = np.zeros_like(points)
    for i in range(len(points)):
        for k in range(bound.shape[1]):
            weight, node = weights[i, k], bound[i, k]
            if weight == 0.0:
                continue
            for r in range(3):
                total = places[node, r] + moves[node, r]
                for c in range(3):
                    total += rotations[node, r, c] * (points[i, c] - places[node, c])
                out[i, r] += weight * total
    return out


@compiled
def turn_normals(normals: Array, bound: Index, weights: Array, rotations: Array) -> Array:
    """Unit normals (p, 3) turned by the weighted rotations of their nodes."""
    out = np.zeros_like(normals)
    for i in range(len(normals)):
        for k in range(bound.shape[1]):
            for r in range(3):
                for c in range(3):
                    out[i, r] += weights[i, k] * rotations[bound[i, k], r, c] * normals[i, c]
        length = np.sqrt(out[i, 0] ** 2 + out[i, 1] ** 2 + out[i, 2] ** 2) + 1e-12
        out[i] /= length
    return out


@compiled
def normal_equations(
    points: Array,
    bound: Index,
    weights: Array,
    gaps: Array,
    normals: Array,
    trust: Array,
    places: Array,
    rotations: Array,
    moves: Array,
    edges: Index,
    stiffness: float,
    point_share: float,
    bandwidth: int,
) -> tuple[Array, Array]:
    """Banded matrix and right side of one Gauss-Newton step.

    The matrix is symmetric; row r - c of column c of the result holds entry (r, c), for r >= c (LAPACK's lower band,
    columns one after another). A node moves a point by weight (exp(w) R (x - g) + t), so its derivative by w and t is
    weight (-[arm]x, 1) with the arm R (x - g); products of two such derivatives are written out.

    Parameters
    ----------
    points, bound, weights : (p, 3), (p, 4), (p, 4)
        Rest points and the nodes they follow.
    gaps : (p, 3)
        Deformed point minus its partner.
    normals : (p, 3)
        Normals at the partners.
    trust : (p,)
        Weight of each pair.
    places, rotations, moves : (m, 3), (m, 3, 3), (m, 3)
    edges : (e, 2)
    stiffness : float
        Weight of two nodes agreeing on each other's place.
    point_share : float
        Weight of the whole gap beside its part along the normal.
    bandwidth : int
        Largest difference of the numbers of two nodes that meet, plus 1.
    """
    width = 6 * bandwidth
    matrix, right = np.zeros(6 * len(places) * width), np.zeros(6 * len(places))
    arms, turns = np.empty((FOLLOWED, 6)), np.empty((FOLLOWED, 6))
    for i in range(len(points)):
        if trust[i] <= 0.0:
            continue
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        u, v, w = gaps[i, 0], gaps[i, 1], gaps[i, 2]
        along = x * u + y * v + z * w
        for a in range(FOLLOWED):
            weight = weights[i, a]
            if weight == 0.0:
                continue
            p, q, r = _arm(rotations, places, bound[i, a], points[i, 0], points[i, 1], points[i, 2])
            share, whole = trust[i] * weight, trust[i] * weight * point_share
            _fill(arms, a, p, q, r, q * w - r * v, r * u - p * w, p * v - q * u)
            _fill(turns, a, q * z - r * y, r * x - p * z, p * y - q * x, x, y, z)
            row = 6 * bound[i, a]
            for k in range(3):
                right[row + k] -= share * along * turns[a, k] + whole * arms[a, 3 + k]
                right[row + 3 + k] -= share * along * normals[i, k] + whole * gaps[i, k]
        for a in range(FOLLOWED):
            for b in range(FOLLOWED):
                low, high = bound[i, b], bound[i, a]
                if weights[i, a] == 0.0 or weights[i, b] == 0.0 or low > high:
                    continue
                both = trust[i] * weights[i, a] * weights[i, b]
                # Rows of the higher node, columns of the lower: the turn of each, then its move.
                if low == high:
                    at = 6 * low * width
                    for c in range(6):
                        for d in range(c, 6):
                            matrix[at + c * width + d - c] += both * turns[a, c] * turns[a, d]
                    _own(matrix, at, width, both * point_share, arms[a, 0], arms[a, 1], arms[a, 2])
                else:
                    _meet(
                        matrix, 6 * low * width + 6 * (high - low), width, both, both * point_share, turns, arms, a, b
                    )
    for e in range(len(edges)):
        for side in range(2):
            j, k = edges[e, side], edges[e, 1 - side]
            p, q, r = _arm(rotations, places, j, places[k, 0], places[k, 1], places[k, 2])
            u = p + places[j, 0] + moves[j, 0] - places[k, 0] - moves[k, 0]
            v = q + places[j, 1] + moves[j, 1] - places[k, 1] - moves[k, 1]
            w = r + places[j, 2] + moves[j, 2] - places[k, 2] - moves[k, 2]
            right[6 * j] -= stiffness * (q * w - r * v)
            right[6 * j + 1] -= stiffness * (r * u - p * w)
            right[6 * j + 2] -= stiffness * (p * v - q * u)
            _own(matrix, 6 * j * width, width, stiffness, p, q, r)
            for axis in range(3):
                gap = u if axis == 0 else v if axis == 1 else w
                following, last = 6 * j + (axis + 1) % 3, 6 * j + (axis + 2) % 3
                here = 6 * k + 3 + axis
                right[6 * j + 3 + axis] -= stiffness * gap
                right[here] += stiffness * gap
                matrix[here * width] += stiffness
                # The other node's move enters with -1; only the lower half is kept.
                _add(matrix, width, following, here, -stiffness * (r if axis == 0 else p if axis == 1 else q))
                _add(matrix, width, last, here, stiffness * (q if axis == 0 else r if axis == 1 else p))
                _add(matrix, width, 6 * j + 3 + axis, here, -stiffness)
    return matrix.reshape(len(right), width).T, right


@compiled
def _arm(rotations: Array, places: Array, node: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """R (x - g) of a node."""
    x, y, z = x - places[node, 0], y - places[node, 1], z - places[node, 2]
    p = rotations[node, 0, 0] * x + rotations[node, 0, 1] * y + rotations[node, 0, 2] * z
    q = rotations[node, 1, 0] * x + rotations[node, 1, 1] * y + rotations[node, 1, 2] * z
    r = rotations[node, 2, 0] * x + rotations[node, 2, 1] * y + rotations[node, 2, 2] * z
    return p, q, r


@compiled
def _fill(table: Array, row: int, a: float, b: float, c: float, d: float, e: float, f: float) -> None:
    table[row, 0], table[row, 1], table[row, 2] = a, b, c
    table[row, 3], table[row, 4], table[row, 5] = d, e, f


@compiled
def _add(matrix: Array, width: int, first: int, second: int, value: float) -> None:
    """Add to the entry of two numbers, whichever is the row."""
    low, high = min(first, second), max(first, second)
    matrix[low * width + high - low] += value


@compiled
def _own(matrix: Array, start: int, width: int, weight: float, x: float, y: float, z: float) -> None:
    """Add the lower half of a derivative (-[arm]x, 1) by itself: (|a|^2 1 - a a'; -[a]x, 1)."""
    at, step = np.uint64(start), np.uint64(width)
    matrix[at] += weight * (y * y + z * z)
    matrix[at + U1] -= weight * x * y
    matrix[at + U2] -= weight * x * z
    matrix[at + U4] -= weight * z
    matrix[at + U5] += weight * y
    at += step
    matrix[at] += weight * (x * x + z * z)
    matrix[at + U1] -= weight * y * z
    matrix[at + U2] += weight * z
    matrix[at + U4] -= weight * x
    at += step
    matrix[at] += weight * (x * x + y * y)
    matrix[at + U1] -= weight * y
    matrix[at + U2] += weight * x
    for _ in range(3):
        at += step
        matrix[at] += weight


@compiled
def _meet(
    matrix: Array, start: int, width: int, weight: float, share: float, turns: Array, arms: Array, a: int, b: int
) -> None:
    """Add the products of two nodes' derivatives: along the normal (arm x n, n), and in full (-[arm]x, 1) by a share.

    The second is ((a.b) 1 - b a', [a]x; -[b]x, 1).
    """
    at, down = np.uint64(start), np.uint64(width - 1)
    t0, t1, t2, t3, t4, t5 = turns[a, 0], turns[a, 1], turns[a, 2], turns[a, 3], turns[a, 4], turns[a, 5]
    ax, ay, az = share * arms[a, 0], share * arms[a, 1], share * arms[a, 2]
    bx, by, bz = arms[b, 0], arms[b, 1], arms[b, 2]
    dot = ax * bx + ay * by + az * bz
    sx, sy, sz = share * bx, share * by, share * bz
    c = weight * turns[b, 0]
    matrix[at] += c * t0 + dot - bx * ax
    matrix[at + U1] += c * t1 - by * ax
    matrix[at + U2] += c * t2 - bz * ax
    matrix[at + U3] += c * t3
    matrix[at + U4] += c * t4 - sz
    matrix[at + U5] += c * t5 + sy
    at += down
    c = weight * turns[b, 1]
    matrix[at] += c * t0 - bx * ay
    matrix[at + U1] += c * t1 + dot - by * ay
    matrix[at + U2] += c * t2 - bz * ay
    matrix[at + U3] += c * t3 + sz
    matrix[at + U4] += c * t4
    matrix[at + U5] += c * t5 - sx
    at += down
    c = weight * turns[b, 2]
    matrix[at] += c * t0 - bx * az
    matrix[at + U1] += c * t1 - by * az
    matrix[at + U2] += c * t2 + dot - bz * az
    matrix[at + U3] += c * t3 - sy
    matrix[at + U4] += c * t4 + sx
    matrix[at + U5] += c * t5
    at += down
    c = weight * turns[b, 3]
    matrix[at] += c * t0
    matrix[at + U1] += c * t1 + az
    matrix[at + U2] += c * t2 - ay
    matrix[at + U3] += c * t3 + share
    matrix[at + U4] += c * t4
    matrix[at + U5] += c * t5
    at += down
    c = weight * turns[b, 4]
    matrix[at] += c * t0 - az
    matrix[at + U1] += c * t1
    matrix[at + U2] += c * t2 + ax
    matrix[at + U3] += c * t3
    matrix[at + U4] += c * t4 + share
    matrix[at + U5] += c * t5
    at += down
    c = weight * turns[b, 5]
    matrix[at] += c * t0 + ay
    matrix[at + U1] += c * t1 - ax
    matrix[at + U2] += c * t2
    matrix[at + U3] += c * t3
    matrix[at + U4] += c * t4
    matrix[at + U5] += c * t5 + share
