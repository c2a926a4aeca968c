"""Aligning two captures of nearly one pose: yaw about up and ground translation, from surface points alone."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]
KEPT = 0.9
"""Share of the point pairs that count; the rest is trimmed as having no partner."""
SPREAD = np.deg2rad(20.0)
MOST_STEPS = 25


@attrs.frozen
class GroundMove:
    """Yaw about up, then a translation on the ground: x' = Rz(yaw) x + (x, y, 0).

    ``residual`` is the mean distance of the trimmed point pairs, both ways, in the unit of the points.
    """

    yaw: float
    x: float
    y: float
    residual: float = float("nan")

    def after(self, first: GroundMove) -> GroundMove:
        """Do ``first``, then this."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        x, y = c * first.x - s * first.y + self.x, s * first.x + c * first.y + self.y
        return GroundMove(float(np.angle(np.exp(1j * (self.yaw + first.yaw)))), float(x), float(y), self.residual)

    def apply(self, points: NDArray[np.floating]) -> Array:
        """Move points (..., 3)."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        moved = np.array(points, np.float64)
        moved[..., 0] = c * points[..., 0] - s * points[..., 1] + self.x
        moved[..., 1] = s * points[..., 0] + c * points[..., 1] + self.y
        return moved


def align_frames(
    moving: Sequence[NDArray[np.floating]],
    fixed: Sequence[NDArray[np.floating]],
    *,
    yaw: float | None = None,
    steps: int = MOST_STEPS,
) -> GroundMove:
    """Move one window of frames onto another by one yaw and one ground translation.

    Symmetric trimmed closest points; z is left as it is. With a yaw to start from (where the performer faces there
    against here), that and 20 degrees to either side are tried, which also keeps the performer from being turned
    round; without, twelve starts and the best three refined.

    Parameters
    ----------
    moving, fixed : sequences of as many frames of (p, 3) points spread over the surface, z up
    yaw : float, optional
        Radians.
    steps : int

    Returns
    -------
    GroundMove
    """
    if len(moving) != len(fixed) or not moving:
        raise InputError(f"{len(moving)} frames cannot be aligned with {len(fixed)}: give as many of both.")
    window = _Window([np.asarray(f, np.float64) for f in moving], [np.asarray(f, np.float64) for f in fixed])
    if yaw is not None:
        starts = [yaw, yaw - SPREAD, yaw + SPREAD]
    else:
        coarse = _Window([f[::3] for f in window.moving], [f[::3] for f in window.fixed])
        turns = [2 * np.pi * k / 12 for k in range(12)]
        tried = sorted((coarse.refine(turn, 4).residual, turn) for turn in turns)
        starts = [turn for _, turn in tried[:3]]
    first = window.refine(starts[0], steps)
    # Another start has to be clearly better: where the surface cannot tell, the heading decides.
    others = [window.refine(start, steps) for start in starts[1:]]
    best = min(others, key=lambda move: move.residual, default=first)
    return best if best.residual < 0.98 * first.residual else first


class _Window:
    """Search trees of both windows: those of the moving points stay valid under the motion's inverse."""

    def __init__(self, moving: list[Array], fixed: list[Array]) -> None:
        from scipy.spatial import cKDTree

        self.moving, self.fixed = moving, fixed
        self.moving_trees = [cKDTree(points) for points in moving]
        self.fixed_trees = [cKDTree(points) for points in fixed]
        self.moving_centre = np.concatenate(moving).mean(axis=0)
        self.fixed_centre = np.concatenate(fixed).mean(axis=0)

    def refine(self, yaw: float, steps: int) -> GroundMove:
        """Closest points and the best move in turn, from a yaw with the centroids on each other."""
        c, s = np.cos(yaw), np.sin(yaw)
        x = self.fixed_centre[0] - c * self.moving_centre[0] + s * self.moving_centre[1]
        y = self.fixed_centre[1] - s * self.moving_centre[0] - c * self.moving_centre[1]
        move = GroundMove(float(yaw), float(x), float(y))
        for _ in range(steps):
            following = self._step(move)
            small = abs(following.yaw - move.yaw) < 1e-4 and abs(following.x - move.x) + abs(following.y - move.y) < (
                1e-4 * max(1e-12, float(np.ptp(self.fixed[0][:, 2])))
            )
            move = following
            if small:
                break
        return move

    def _step(self, move: GroundMove) -> GroundMove:
        sources, targets, gaps = [], [], []
        back = GroundMove(-move.yaw, 0.0, 0.0)
        for mine, mine_tree, theirs, theirs_tree in zip(
            self.moving, self.moving_trees, self.fixed, self.fixed_trees, strict=True
        ):
            distance, index = theirs_tree.query(move.apply(mine))
            sources.append(mine)
            targets.append(theirs[index])
            gaps.append(distance)
            distance, index = mine_tree.query(back.apply(theirs - [move.x, move.y, 0.0]))
            sources.append(mine[index])
            targets.append(theirs)
            gaps.append(distance)
        source, target, gap = np.concatenate(sources), np.concatenate(targets), np.concatenate(gaps)
        kept = gap <= np.partition(gap, int(KEPT * (len(gap) - 1)))[int(KEPT * (len(gap) - 1))]
        a = source[kept, 0] + 1j * source[kept, 1]
        b = target[kept, 0] + 1j * target[kept, 1]
        mean_a, mean_b = a.mean(), b.mean()
        turn = np.vdot(a - mean_a, b - mean_b)
        yaw = float(np.angle(turn)) if abs(turn) > 0 else move.yaw
        shift = mean_b - np.exp(1j * yaw) * mean_a
        return GroundMove(yaw, float(shift.real), float(shift.imag), float(gap[kept].mean()))
