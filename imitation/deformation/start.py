"""Where the iteration begins: a pose and a rotation for every vertex (the initial rotation is part of the method)."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.deformation.constraints import Rows
from imitation.geometry import axis_rotation, kabsch, rotation_of
from imitation.geometry.projection import Array

FAR = 0.05
"""Handles that have moved by more than this share of the diagonal ask for a new start."""


def residuals(rows: Rows, handles: Array) -> Array:
    """Residual (r,) of every row at handle positions (k, 3), weak rows scaled down."""
    distance = np.einsum("ri,ri->r", rows.direction, handles[rows.owner]) - rows.target
    weighted: Array = distance * np.sqrt(rows.softness)
    return weighted


def behind(rows: Rows, handles: Array) -> NDArray[np.bool_]:
    """Which handles (k,) on rays lie behind the camera at positions (k, 3)."""
    if rows.pinned.all():
        return np.zeros(len(rows.handles), bool)
    hidden: NDArray[np.bool_] = ((handles - rows.origin) @ rows.axis <= 0) & ~rows.pinned
    return hidden


def rigid_fit(rows: Rows, handles: Array, rotation: Array, translation: Array) -> tuple[Array, Array, float]:
    """Best rigid motion of handles (k, 3) to the rows from one start, by damped Gauss-Newton; with its cost."""
    if rows.pinned.all():
        turn, shift = kabsch(handles @ rotation.T + translation, rows.place)
        rotation, translation = turn @ rotation, turn @ translation + shift
        error = residuals(rows, handles @ rotation.T + translation)
        return rotation, translation, float(error @ error)
    weight = np.sqrt(rows.softness)
    damping = 1e-4
    error = residuals(rows, handles @ rotation.T + translation)
    cost = float(error @ error)
    for _ in range(60):
        # About the handles' own centre, so that a lone handle moves the mesh and does not turn it.
        arm = (handles - handles.mean(axis=0)) @ rotation.T
        slope = np.concatenate([np.cross(arm[rows.owner], rows.direction), rows.direction], axis=1) * weight[:, None]
        normal = slope.T @ slope
        size = np.diagonal(normal) + 1e-9 * np.trace(normal)
        step = -np.linalg.solve(normal + damping * np.diag(size), slope.T @ error)
        tried = rotation_of(step[:3]) @ rotation
        moved = translation + step[3:] + (rotation - tried) @ handles.mean(axis=0)
        new = residuals(rows, handles @ tried.T + moved)
        lower = float(new @ new)
        if lower <= cost:
            done = cost - lower <= 1e-12 * cost + 1e-24
            rotation, translation, error, cost, damping = tried, moved, new, lower, damping * 0.3
            if done:
                break
        else:
            damping *= 5
            if damping > 1e8:
                break
    return rotation, translation, cost


def first_motion(rows: Rows, handles: Array) -> tuple[Array, Array]:
    """Rigid motion of the rest pose to the constraints of a frame that has no earlier pose.

    Points alone: Kabsch. With rays: rigid fits from six turns about the vertical axis, the cheapest wins; the turn
    of the rest pose is kept where another is not clearly better.
    """
    if rows.pinned.all():
        return kabsch(handles, rows.place)
    starts = [axis_rotation([0, 0, 1], angle) for angle in np.arange(6) * np.pi / 3]
    if rows.pinned.sum() >= 3:
        starts.insert(0, kabsch(handles[rows.pinned], rows.place[rows.pinned])[0])
    best: tuple[float, Array, Array] | None = None
    for rotation in starts:
        turned, moved, cost = rigid_fit(rows, handles, rotation, _shift(rows, handles @ rotation.T))
        if behind(rows, handles @ turned.T + moved).any():
            cost = np.inf  # a mirrored body behind the camera has the same picture
        if best is None or cost < 0.8 * best[0] - 1e-12:
            best = cost, turned, moved
    assert best is not None
    return best[1], best[2]


def _shift(rows: Rows, handles: Array) -> Array:
    """Translation (3,) that fits the rows best, the shortest one where some direction is free."""
    weight = np.sqrt(rows.softness)
    wanted = -residuals(rows, handles)
    shift = np.linalg.lstsq(rows.direction * weight[:, None], wanted, rcond=1e-6)[0]
    return np.asarray(shift, np.float64)


def warp(rest: Array, handles: Array, targets: Array) -> Array | None:
    """Smooth warp of the rest pose (m, 3) that takes handles to targets (k, 3), |r|^3 kernel with an affine part.

    None where the handles are fewer than four or nearly in one plane, so that the affine part is not determined.
    """
    centred = handles - handles.mean(axis=0)
    spread = np.linalg.svd(centred, compute_uv=False)
    if len(handles) < 4 or spread[2] < 0.05 * spread[0]:
        return None
    count = len(handles)
    matrix = np.zeros((count + 4, count + 4))
    matrix[:count, :count] = np.linalg.norm(handles[:, None] - handles[None], axis=2) ** 3
    matrix[:count, count] = matrix[count, :count] = 1
    matrix[:count, count + 1 :] = handles
    matrix[count + 1 :, :count] = handles.T
    try:
        weights = np.linalg.solve(matrix, np.concatenate([targets, np.zeros((4, 3))]))
    except np.linalg.LinAlgError:
        return None
    result = weights[count] + rest @ weights[count + 1 :]
    for handle, weight in zip(handles, weights[:count], strict=True):
        away = rest - handle
        result += (np.einsum("ij,ij->i", away, away) ** 1.5)[:, None] * weight
    return result if np.isfinite(result).all() else None


def complete(rows: Rows, handles: Array) -> tuple[Rows, tuple[str, ...]]:
    """Rows that leave no place of the mesh open, with one sentence on everything that the given ones leave open.

    A direction in which nothing holds the mesh (a lone ray, parallel rays) gets a weak row that keeps the first handle
    where it begins; an open turn is left to the rotations of the start, which the iteration keeps.
    """
    if rows.pinned.all() and len(handles) > 2:
        spread = np.linalg.svd(handles - handles.mean(axis=0), compute_uv=False)
        if spread[1] > 1e-6 * spread[0]:
            return rows, ()
    notes = []
    values, axes = np.linalg.eigh(rows.direction.T @ rows.direction)
    arm = (handles - handles.mean(axis=0)) / max(float(np.abs(handles - handles.mean(axis=0)).max()), 1e-12)
    slope = np.concatenate([np.cross(arm[rows.owner], rows.direction), rows.direction], axis=1)
    if np.linalg.matrix_rank(slope, tol=1e-6 * len(slope) ** 0.5) < 6:
        notes.append("The constraints leave the turn or the place of the mesh open; it keeps what it had before.")
    free = axes.T[values < 1e-9 * values[-1]]
    if len(free):
        notes.append("The rays are parallel, so nothing says how far away the mesh is; it keeps its distance.")
        rows = attrs.evolve(
            rows,
            owner=np.concatenate([rows.owner, np.zeros(len(free), np.int64)]),
            direction=np.concatenate([rows.direction, free]),
            target=np.concatenate([rows.target, free @ handles[0]]),
            softness=np.concatenate([rows.softness, np.full(len(free), 0.01)]),
        )
    return rows, tuple(notes)
