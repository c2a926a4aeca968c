"""Joints of a performance as it is delivered: placed, and in blended frames carried along with the surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

import tvmedit

Joints = Callable[[int, int], np.ndarray]
Meshes = Callable[[int, int], Sequence[np.ndarray]]


def blended_cuts(graph: tvmedit.MotionGraph, performance: tvmedit.Performance, mesh_of: Meshes) -> list[tvmedit.Blend]:
    """Blends of all cuts."""
    cuts = [cut for cut in performance.cuts if cut.kind == "cut"]
    return [tvmedit.blend_cut(graph, performance, cut, mesh_of) for cut in cuts]


def worst_steps(
    graph: tvmedit.MotionGraph,
    performance: tvmedit.Performance,
    joints_of: Joints,
    mesh_of: Meshes,
    blends: Sequence[tvmedit.Blend],
) -> tuple[float, float]:
    """Largest step of the body at cuts and wraps, placed alone and blended, over the largest within the motions."""
    placed = np.array([performance.place(k, joints_of(int(s), int(f))) for k, (s, f) in enumerate(performance.frames)])
    blended = placed.copy()
    for blend in blends:
        for position in blend.shapes:
            blended[position] = _carried(graph, performance, blend, position, joints_of, mesh_of)
    at = {cut.position - 1 for cut in performance.cuts if cut.kind != "loop"}
    near = at | {k + step for blend in blends for k in blend.shapes for step in (-1, 0)}
    plain, smooth = (np.linalg.norm(np.diff(joints, axis=0), axis=2).mean(axis=1) for joints in (placed, blended))
    usual = plain[[k for k in range(len(plain)) if k not in at]].max()
    return float(plain[sorted(at)].max() / usual), float(
        smooth[sorted(k for k in near if k < len(smooth))].max() / usual
    )


def _carried(
    graph: tvmedit.MotionGraph,
    performance: tvmedit.Performance,
    blend: tvmedit.Blend,
    position: int,
    joints_of: Joints,
    mesh_of: Meshes,
) -> np.ndarray:
    from scipy.spatial import cKDTree

    sequence, frame = blend.meshes[position]
    stands = blend.cut.position - (not blend.backwards)
    vertices = performance.place(stands, np.asarray(mesh_of(sequence, frame)[0]))
    joints = performance.place(stands, joints_of(sequence, frame))
    near = cKDTree(vertices).query(joints, k=12)[1]
    return np.asarray(joints + (blend.shapes[position].vertices - vertices)[near].mean(axis=1))
