"""The same energy written plainly in numpy and solved as one assembled sparse system: the tests' oracle."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import spsolve

from imitation.deformation import Deformer
from imitation.deformation.constraints import Rows


def best_rotations(deformer: Deformer, pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotations (m, 3, 3) of the one-rings' edges by singular value decomposition; welded order."""
    mesh = deformer.mesh
    weights = sparse.coo_array(mesh.weights)
    i, j, w = weights.row, weights.col, weights.data
    cover = np.zeros((len(pose), 3, 3))
    np.add.at(
        cover, i, w[:, None, None] * (pose[i] - pose[j])[:, :, None] * (mesh.positions[i] - mesh.positions[j])[:, None]
    )
    left, _, right = np.linalg.svd(cover)
    left[:, :, 2] *= np.sign(np.linalg.det(left @ right))[:, None]
    return left @ right


def direct_step(deformer: Deformer, rows: Rows, pose: NDArray[np.float64], weight: float) -> NDArray[np.float64]:
    """One global step by an assembled sparse system with the constraints' multipliers; welded order."""
    mesh = deformer.mesh
    count = len(pose)
    laplacian = sparse.diags_array(np.asarray(mesh.weights.sum(axis=1)).ravel()) - mesh.weights
    coupling = weight / mesh.areas.sum()
    matrix: Any = laplacian @ sparse.diags_array(1 / mesh.areas) @ laplacian + coupling * laplacian
    turns = best_rotations(deformer, pose)
    detail = laplacian @ mesh.positions
    turned = np.einsum("nij,nj->ni", turns, detail)
    entries = sparse.coo_array(mesh.weights)
    edge = mesh.positions[entries.row] - mesh.positions[entries.col]
    spread = np.zeros_like(pose)
    mean = (turns[entries.row] + turns[entries.col]) / 2
    np.add.at(spread, entries.row, entries.data[:, None] * np.einsum("nij,nj->ni", mean, edge))
    load = laplacian @ (turned / mesh.areas[:, None]) + coupling * spread
    held = sparse.csr_array(
        (
            rows.direction.ravel(),
            (np.repeat(np.arange(len(rows.owner)), 3), (3 * rows.handles[rows.owner][:, None] + np.arange(3)).ravel()),
        ),
        shape=(len(rows.owner), 3 * count),
    )
    own = np.diagonal(deformer.system.small(rows).matrix)[: len(rows.owner)]
    typical = deformer.system.small(rows).typical
    compliance = typical * (1 - rows.softness) / rows.softness
    assert (own > 0).all()
    whole = sparse.block_array([[sparse.kron(matrix, np.eye(3)), held.T], [held, -sparse.diags_array(compliance)]])
    answer = spsolve(sparse.csc_matrix(whole), np.concatenate([load.ravel(), rows.target]))
    return np.asarray(answer[: 3 * count]).reshape(count, 3)
