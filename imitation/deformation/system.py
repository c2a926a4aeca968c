"""The constant part of a mesh's deformation: order, edges, two factors, and the responses of handles."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from imitation.deformation.constraints import Rows
from imitation.deformation.factor import elimination_order, factorise, solve_one
from imitation.errors import InputError
from imitation.geometry import PreparedMesh
from imitation.geometry.projection import Array

KEPT = 4
"""Small systems kept; a frame of rays has its own, and it is soon dropped."""


class System:
    """Matrix ``Q = L M^-1 (L + c M)``, c = a / S, of a prepared mesh, factored once.

    Attributes
    ----------
    order : (m,) welded vertex at each place of the elimination order. place : (m,) the other way round.
    rest : (m, 3) rest positions in elimination order. arrays : what the compiled loops take.
    ``even`` gives all vertices the same area, as the printed form has it.
    """

    def __init__(
        self, mesh: PreparedMesh, stretch_weight: float, stiffness: ArrayLike | None = None, even: bool = False
    ) -> None:
        from scipy import sparse

        areas, weights = mesh.areas, mesh.weights
        if even:
            areas = np.full_like(areas, areas.mean())
        coupling = stretch_weight / float(areas.sum())
        if stiffness is not None:
            stiff = _welded_stiffness(mesh, stiffness)
            areas = areas * stiff
            root = sparse.diags_array(np.sqrt(stiff))
            weights = sparse.csr_array(root @ weights @ root)
        laplacian = sparse.diags_array(np.asarray(weights.sum(axis=1)).ravel()) - weights
        shifted = sparse.csc_array(laplacian + coupling * sparse.diags_array(areas))
        self.order = elimination_order(shifted)
        self.place = np.empty_like(self.order)
        self.place[self.order] = np.arange(len(self.order))
        self.mesh, self.stretch_weight, self.coupling = mesh, stretch_weight, coupling
        self.area = np.ascontiguousarray(areas[self.order])
        self.total = float(self.area.sum())
        self.rest = np.ascontiguousarray(mesh.positions[self.order])
        self.weights = sparse.csr_array(weights)[self.order][:, self.order].tocsr()
        self.weights.sort_indices()
        self.laplacian = sparse.csc_array(laplacian)[self.order][:, self.order]
        held = self.laplacian.copy()
        last = len(self.order) - 1
        held[last, last] += held.diagonal().mean()
        self._ground = factorise(held)
        # Without a stretch term the second factor is the Laplacian's own.
        self._shifted = factorise(shifted[self.order][:, self.order]) if coupling > 0 else self._ground
        self._columns: dict[int, Array] = {}
        self._small: dict[tuple[bytes, ...], SmallSystem] = {}
        self._lock = threading.Lock()
        self.arrays = self._arrays()

    def _arrays(self) -> tuple[Any, ...]:
        start, other = self.weights.indptr.astype(np.int32), self.weights.indices.astype(np.int32)
        owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
        edge = self.weights.data[:, None] * (self.rest[owner] - self.rest[other])
        detail = np.stack([np.bincount(owner, edge[:, axis], len(self.rest)) for axis in range(3)], axis=1)
        factors = [(f.start, f.row, f.value, f.inverse) for f in (self._ground, self._shifted)]
        return start, other, edge, detail, self.area, self.total, self.coupling, *factors

    def response(self, handle: int) -> Array:
        """Column (m,) of the pseudo-inverse G of Q for a vertex in elimination order; kept once computed."""
        if handle not in self._columns:
            column = -self.area / self.total
            column[handle] += 1.0
            self._columns[handle] = self.invert(column)
        return self._columns[handle]

    def invert(self, load: Array) -> Array:
        """Solve ``Q x = load`` for a load (m,) that sums to zero; x is M-orthogonal to constants."""
        middle = load.copy()
        ground, shifted = self._ground, self._shifted
        solve_one(ground.start, ground.row, ground.value, ground.inverse, middle)
        middle = self.area * (middle - (self.area * middle).sum() / self.total)
        solve_one(shifted.start, shifted.row, shifted.value, shifted.inverse, middle)
        inverted: Array = middle - (self.area * middle).sum() / self.total
        return inverted

    def apply(self, pose: Array) -> Array:
        """``Q pose`` for (m, 3) or (m,)."""
        bent = self.laplacian @ pose
        scaled = (bent.T / self.area).T + self.coupling * pose
        result: Array = self.laplacian @ scaled
        return result

    def small(self, rows: Rows) -> SmallSystem:
        """The dense system of one set of rows; the last few are kept, for frames of points share them."""
        key = rows.signature
        with self._lock:
            found = self._small.get(key)
            if found is None:
                if len(self._small) >= KEPT:
                    self._small.pop(next(iter(self._small)))
                found = self._small[key] = SmallSystem(self, rows)
        return found


class SmallSystem:
    """Schur complement of one set of constraint rows; no factor of the mesh is touched (note on handles: exact).

    ``[C G C' + diag(eps), -C N; N' C', 0] [mu; t] = [C G b - p; 0]`` with compliance ``eps = g (1 - s) / s``, g the
    median of the handles' own responses, and N the translations.
    """

    def __init__(self, system: System, rows: Rows) -> None:
        self.rows = rows
        self.handle = system.place[rows.handles]
        self.response = np.empty((len(system.rest), len(self.handle)))
        for position, vertex in enumerate(self.handle.tolist()):
            self.response[:, position] = system.response(vertex)
        own = self.response[self.handle]
        typical = _median(np.diagonal(own).tolist())
        compliance = typical * (1 - rows.softness) / rows.softness
        count = len(rows.owner)
        matrix = np.zeros((count + 3, count + 3))
        matrix[:count, :count] = own[np.ix_(rows.owner, rows.owner)] * (rows.direction @ rows.direction.T)
        matrix.reshape(-1)[: count * (count + 4) : count + 4] += compliance
        matrix[:count, count:] = -rows.direction
        matrix[count:, :count] = rows.direction.T
        self.matrix = matrix
        self.typical = typical
        # Both blocks to one size, so that the inverse keeps its digits.
        scale = np.concatenate([np.full(count, typical**-0.5), np.full(3, typical**0.5)])
        self.inverse = np.ascontiguousarray(scale[:, None] * np.linalg.inv(scale[:, None] * matrix * scale) * scale)

    def arrays(self, target: Array) -> tuple[Any, ...]:
        """What the compiled loops take, for targets (r,)."""
        rows = self.rows
        return self.response, self.handle, rows.owner, rows.direction, target, self.matrix, self.inverse


def _median(values: list[float]) -> float:
    """The median of a few numbers; numpy's own takes longer than all else here."""
    ordered, half = sorted(values), len(values) // 2
    return ordered[half] if len(values) % 2 else (ordered[half - 1] + ordered[half]) / 2


def _welded_stiffness(mesh: PreparedMesh, stiffness: ArrayLike) -> Array:
    given = np.asarray(stiffness, np.float64)
    if given.shape != (len(mesh.vertices),) or not np.isfinite(given).all() or (given <= 0).any():
        raise InputError(
            f"The stiffness must be {len(mesh.vertices)} positive numbers, one a vertex, but has shape {given.shape}."
        )
    welded = np.zeros(len(mesh.positions))
    np.maximum.at(welded, mesh.index, given)
    return welded
