"""The few slow directions in which the iteration creeps, found once for a set of handles and solved exactly.

Near a solution the step ``U -> G b(R(U))`` is linear, with real eigenvalues in [0, 1). All but some twenty lie below
0.8; those twenty (limbs held by one point, twist) reach 0.99 and make a frame need hundreds of steps. In the frame
of the local rotations they hardly depend on the pose, so those of the rest pose serve a whole sequence: in every step
the residual along them is divided by ``1 - eigenvalue`` (a Galerkin coarse correction, deflation).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.deformation.constraints import Rows
from imitation.deformation.system import SmallSystem, System
from imitation.geometry.projection import Array

COUNT, KRYLOV = 24, 72
"""Directions, and steps of the process that finds them, where one frame is solved."""
COUNT_OF_MANY, KRYLOV_OF_MANY = 48, 140
"""The same where many frames share them: twice the price, a third of the steps less in every frame."""
SMALL = NDArray[np.float32]


@attrs.frozen(eq=False)
class Modes:
    """Slow directions in the frame of the local rotations; single precision, for they only steer the iteration.

    Attributes
    ----------
    dual : (m, 3, k) covectors that read a residual's share of each direction.
    moved : (m, 3, k) what one step makes of each direction.
    inverse : (k, k) inverse of ``dual' (1 - J) direction``.
    reach : (k,) the farthest any vertex goes along each moved direction.
    eigenvalues : (k,) descending.
    """

    dual: SMALL
    moved: SMALL
    inverse: Array
    reach: Array
    eigenvalues: Array

    def arrays(self) -> tuple[Any, ...]:
        """What the compiled loops take."""
        return self.dual, self.moved, self.inverse, self.reach


def no_modes(size: int) -> Modes:
    """No correction at all."""
    none = np.zeros((size, 3, 0), np.float32)
    return Modes(none, none, np.zeros((0, 0)), np.zeros(0), np.zeros(0))


def slow_modes(
    system: System,
    rows: Rows,
    rotation: Array,
    count: int = COUNT,
    krylov: int = KRYLOV,
    heard: Callable[[], object] | None = None,
) -> Modes:
    """Slow directions of a set of handles at rest, by an Arnoldi process in the inner product of Q.

    Parameters
    ----------
    rows : the constraints of a typical frame. rotation : (3, 3) overall turn of the body in that frame.
    heard : called now and then; it may raise to stop.
    """
    from imitation.deformation.products import combine, products

    rest = system.rest
    size = len(rest)
    count = min(count, 3 * size // 4)
    krylov = min(max(krylov, count + 8), 3 * size - 1)
    held = attrs.evolve(rows, direction=rows.direction @ rotation)
    step = _Step(system, SmallSystem(system, held))
    basis, after, loads = np.empty((krylov, 3 * size)), np.empty((krylov, 3 * size)), np.empty((krylov, 3 * size))
    vector = step(np.random.default_rng(0).normal(size=(size, 3)))
    for made in range(krylov):
        if heard is not None:
            heard()
        vector = vector - combine(products(loads[:made], vector.reshape(1, -1)).T, basis[:made]).reshape(size, 3)
        load = system.apply(vector)
        norm = np.sqrt(max(float((vector * load).sum()), 0.0))
        if norm < 1e-12:
            basis, after, loads = basis[:made], after[:made], loads[:made]
            break
        basis[made], loads[made] = vector.ravel() / norm, load.ravel() / norm
        vector = step(basis[made].reshape(size, 3))
        after[made] = vector.ravel()
    projected = products(loads, after)
    right, left = _invariant(projected, count)
    moved, dual = combine(right.T.copy(), after), combine(left.T.copy(), loads)
    inner = left.T @ projected @ right
    inverse = np.linalg.inv(left.T @ right - inner)
    moved = moved.reshape(-1, size, 3)
    moved[:, system.place[rows.handles[rows.pinned]]] = 0.0
    shape = (size, 3, -1)
    return Modes(
        np.ascontiguousarray(dual.T.reshape(shape), np.float32),
        np.ascontiguousarray(moved.transpose(1, 2, 0), np.float32),
        np.ascontiguousarray(inverse),
        np.linalg.norm(moved, axis=2).max(axis=1),
        np.sort(np.linalg.eigvals(inner).real)[::-1],
    )


def _invariant(projected: Array, count: int) -> tuple[Array, Array]:
    """Right and left bases (k, count) of the eigenspace of a matrix' largest eigenvalues, biorthonormal.

    The matrix is not symmetric, so the left basis differs: read with it, a residual along the fast directions is not
    mistaken for one along the slow.
    """
    from scipy.linalg import eig

    found: Any = eig(projected, left=True, right=True)
    values, left, right = found
    order = np.argsort(-values.real, kind="stable")
    real = values.real[order]
    # Cut in the widest gap near the wanted number, so that no cluster and no conjugate pair is cut in two.
    low = max(1, count - 4)
    cut = low + int(np.argmax(real[low - 1 : count] - real[low : count + 1]))
    chosen = [k for k in order[:cut] if values[k].imag >= 0]
    bases = []
    for vectors in (right[:, chosen], left[:, chosen]):
        paired = vectors[:, values[chosen].imag > 0]
        bases.append(np.linalg.qr(np.concatenate([vectors.real, paired.imag], axis=1))[0])
    return bases[0], bases[1] @ np.linalg.inv(bases[0].T @ bases[1])


class _Step:
    """The derivative of one step at rest."""

    def __init__(self, system: System, small: SmallSystem) -> None:
        rest = system.rest
        rows = small.rows
        target = np.einsum("ri,ri->r", rows.direction, rest[small.handle][rows.owner])
        self.system, self.constraints = system, small.arrays(target)
        self.still = self._step(rest)

    def _step(self, pose: Array) -> Array:
        from imitation.deformation.kernels import one_step

        turn = np.tile([1.0, 0.0, 0.0, 0.0], (len(pose), 1))
        result: Array = one_step(np.ascontiguousarray(pose), turn, self.system.arrays, self.constraints)
        return result

    def __call__(self, direction: Array) -> Array:
        small = 1e-6 / float(np.abs(direction).max())
        result: Array = (self._step(self.system.rest + small * direction) - self.still) / small
        return result
