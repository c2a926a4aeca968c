"""Bundle adjustment: poses, points and one focal length that explain all tracked pixels best.

Levenberg-Marquardt with the points eliminated (Schur complement), Cauchy loss; one thread, same bits on every run.
"""

from __future__ import annotations

from functools import partial

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.patience import patiently
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

Index = NDArray[np.int64]


@attrs.frozen(eq=False)
class Bundle:
    """Cameras, points and what was seen.

    Attributes
    ----------
    focal : pixels, shared by all cameras.
    centre : (2,) principal point, pixels.
    R, T : (n, 3, 3), (n, 3), world to camera.
    points : (p, 3), world.
    camera, point, pixels : (m,), (m,), (m, 2), sorted by point, then camera.
    weight : (m,) of each observation.
    """

    focal: float
    centre: Array
    R: Array
    T: Array
    points: Array
    camera: Index
    point: Index
    pixels: Array
    weight: Array

    @classmethod
    def of(
        cls,
        focal: float,
        centre: Array,
        R: Array,
        T: Array,
        points: Array,
        camera: Index,
        point: Index,
        pixels: Array,
        weight: Array | None = None,
    ) -> Bundle:
        """Sort the observations; weights are 1 where none are given."""
        order = np.lexsort((camera, point))
        weight = np.ones(len(order)) if weight is None else weight[order]
        return cls(focal, centre, R, T, points, camera[order], point[order], pixels[order], weight)

    def errors(self) -> Array:
        """Length of each observation's reprojection error (m,), pixels."""
        from imitation.cameras.kernels import residuals

        out = np.zeros((len(self.camera), 2))
        residuals(self.R, self.T, self.focal, *self.centre, self.points, self.camera, self.point, self.pixels, out)
        lengths: Array = np.hypot(out[:, 0], out[:, 1])
        return lengths

    def keep(self, good: NDArray[np.bool_], fewest: int = 2) -> Bundle:
        """Only the observations chosen, of points that are then still seen ``fewest`` times; points renumbered."""
        good = good & (np.bincount(self.point[good], minlength=len(self.points))[self.point] >= fewest)
        used = np.zeros(len(self.points), bool)
        used[self.point[good]] = True
        names = np.cumsum(used) - 1
        return attrs.evolve(
            self,
            points=self.points[used],
            camera=self.camera[good],
            point=names[self.point[good]],
            pixels=self.pixels[good],
            weight=self.weight[good],
        )

    def angles(self) -> Array:
        """Widest angle (p,) between two rays of each point, radians (to the mean of its rays, doubled)."""
        centres = -np.einsum("nji,nj->ni", self.R, self.T)
        rays = self.points[self.point] - centres[self.camera]
        rays /= np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-12)
        mean = np.zeros_like(self.points)
        np.add.at(mean, self.point, rays)
        mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-12)
        off = np.linalg.norm(rays - mean[self.point], axis=1)
        widest = np.zeros(len(self.points))
        np.maximum.at(widest, self.point, off)
        return 2 * widest


def turned(R: Array, step: Array) -> Array:
    """Rotations (n, 3, 3) after small rotations (n, 3), radians, on the left."""
    from scipy.spatial.transform import Rotation

    moved: Array = Rotation.from_rotvec(step).as_matrix() @ R
    return moved


def adjust(
    bundle: Bundle,
    *,
    loss: float = 1.0,
    free_focal: bool = True,
    turn_only: bool = False,
    iterations: int = 40,
    tolerance: float = 1e-7,
    progress: Progress | None = None,
) -> Bundle:
    """Minimise the Cauchy loss (scale ``loss``, pixels) of the reprojection errors.

    The gauge (position, orientation, scale) is left to the damping: it hardly moves. ``turn_only`` keeps the
    translations; then the points serve as directions.
    """
    from imitation.cameras import kernels

    report = progress or silent
    count, points, seen = len(bundle.R), len(bundle.points), len(bundle.camera)
    start = np.searchsorted(bundle.point, np.arange(points + 1)).astype(np.int64)
    U, uf, bc = np.zeros((count, 6, 6)), np.zeros((count, 6)), np.zeros((count, 6))
    V, bp, Wf = np.zeros((points, 3, 3)), np.zeros((points, 3)), np.zeros((points, 3))
    W, inverse = np.zeros((seen, 6, 3)), np.zeros((points, 3, 3))
    size = 6 * count + 1
    S, right, moved = np.zeros((size, size)), np.zeros(size), np.zeros((points, 3))
    errors = np.zeros((seen, 2))
    R, T, X, f = bundle.R.copy(), bundle.T.copy(), bundle.points.copy(), bundle.focal
    camera, point, uv, weight = bundle.camera, bundle.point, bundle.pixels, bundle.weight
    cx, cy = map(float, bundle.centre)
    s2, damping, grow = loss * loss, 1e-4, 2.0
    cost, ff, bf = kernels.linearise(
        R, T, f, cx, cy, X, camera, point, uv, weight, s2, turn_only, U, uf, bc, V, bp, W, Wf
    )

    def reduced(damping: float, ff: float, bf: float) -> bool:
        kernels.reduce_points(camera, start, damping, free_focal, U, uf, ff, bc, bf, V, bp, W, Wf, inverse, S, right)
        return bool(kernels.solve_lower(S, right))

    for step in range(iterations):
        report(step / iterations)
        solved = patiently(partial(reduced, damping, ff, bf), partial(report, step / iterations))
        better = np.inf
        if solved and np.isfinite(right).all():
            if not free_focal:
                right[-1] = 0.0
            kernels.step_points(camera, start, bp, W, Wf, inverse, right, moved)
            turn = right[:-1].reshape(count, 6)
            f_new, X_new = f + right[-1], X + moved
            R_new = turned(R, turn[:, :3])
            # T' = exp(w) T would belong to a turn of the whole camera point; the kernel turns R X only.
            T_new = T + turn[:, 3:]
            if f_new > 0:
                kernels.residuals(R_new, T_new, f_new, cx, cy, X_new, camera, point, uv, errors)
                better = float((weight * s2 * np.log1p((errors**2).sum(1) / s2)).sum())
        if better < cost:
            gain = (cost - better) / cost
            R, T, X, f = R_new, T_new, X_new, f_new
            damping, grow = max(damping / 5, 1e-10), 2.0
            if gain < tolerance:
                break
            cost, ff, bf = kernels.linearise(
                R, T, f, cx, cy, X, camera, point, uv, weight, s2, turn_only, U, uf, bc, V, bp, W, Wf
            )
        else:
            damping, grow = damping * grow, grow * 2
            if damping > 1e8:
                break
    report(1.0)
    return attrs.evolve(bundle, R=R, T=T, points=X, focal=float(f))
