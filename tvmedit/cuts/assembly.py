"""Normal equations of an embedded deformation: what each sample and each pair of nodes adds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled

Array = NDArray[np.float64]
Index = NDArray[np.int64]


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

    The matrix is symmetric; row r - c of column c of the result holds entry (r, c), for r >= c (LAPACK's lower band).

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
    size = 6 * len(places)
    matrix, right = np.zeros((6 * bandwidth, size)), np.zeros(size)
    jacobian = np.zeros((3, 24))
    weighed = np.zeros((3, 24))
    metric = np.zeros((3, 3))
    for i in range(len(points)):
        if trust[i] <= 0.0:
            continue
        for r in range(3):
            for c in range(3):
                metric[r, c] = trust[i] * (normals[i, r] * normals[i, c] + (point_share if r == c else 0.0))
        for k in range(4):
            node, weight = bound[i, k], weights[i, k]
            _arm(jacobian, 6 * k, rotations[node], points[i] - places[node], weight)
        for r in range(3):
            for c in range(24):
                weighed[r, c] = (
                    metric[r, 0] * jacobian[0, c] + metric[r, 1] * jacobian[1, c] + metric[r, 2] * jacobian[2, c]
                )
        for a in range(4):
            if weights[i, a] == 0.0:
                continue
            for p in range(6):
                row, column = 6 * bound[i, a] + p, 6 * a + p
                for r in range(3):
                    right[row] -= weighed[r, column] * gaps[i, r]
                for b in range(4):
                    if weights[i, b] == 0.0 or bound[i, b] > bound[i, a]:
                        continue
                    for q in range(6):
                        other = 6 * bound[i, b] + q
                        if other > row:
                            break
                        total = 0.0
                        for r in range(3):
                            total += jacobian[r, column] * weighed[r, 6 * b + q]
                        matrix[row - other, other] += total
    for e in range(len(edges)):
        for side in range(2):
            j, k = edges[e, side], edges[e, 1 - side]
            arm = places[k] - places[j]
            _arm(jacobian, 0, rotations[j], arm, 1.0)
            for r in range(3):
                turned = 0.0
                for c in range(3):
                    turned += rotations[j, r, c] * arm[c]
                gap = turned + places[j, r] + moves[j, r] - places[k, r] - moves[k, r]
                for p in range(6):
                    right[6 * j + p] -= stiffness * jacobian[r, p] * gap
                    for q in range(p + 1):
                        matrix[p - q, 6 * j + q] += stiffness * jacobian[r, p] * jacobian[r, q]
                    # The other node's move enters with -1 in row r; only the lower half is kept.
                    if k < j:
                        matrix[6 * (j - k) + p - 3 - r, 6 * k + 3 + r] -= stiffness * jacobian[r, p]
                    else:
                        matrix[6 * (k - j) + 3 + r - p, 6 * j + p] -= stiffness * jacobian[r, p]
                right[6 * k + 3 + r] += stiffness * gap
                matrix[0, 6 * k + 3 + r] += stiffness
    return matrix, right


@compiled
def _arm(jacobian: Array, column: int, rotation: Array, arm: Array, weight: float) -> None:
    """Derivative of weight (exp(w) R arm + t) by w and t, into six columns."""
    x, y, z = 0.0, 0.0, 0.0
    for c in range(3):
        x += rotation[0, c] * arm[c]
        y += rotation[1, c] * arm[c]
        z += rotation[2, c] * arm[c]
    for r in range(3):
        for c in range(6):
            jacobian[r, column + c] = 0.0
    jacobian[0, column + 1], jacobian[0, column + 2] = weight * z, -weight * y
    jacobian[1, column + 0], jacobian[1, column + 2] = -weight * z, weight * x
    jacobian[2, column + 0], jacobian[2, column + 1] = weight * y, -weight * x
    for r in range(3):
        jacobian[r, column + 3 + r] = weight
