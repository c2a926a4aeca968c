"""From capsules to a closed triangle mesh with smooth skin weights."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from resources.world.skeleton import Array, Flesh, Skeleton

Faces = NDArray[np.int32]


def capsule_distance(points: Array, flesh: Flesh) -> Array:
    """Signed distance (n,) of points (n, 3) to a capsule whose radius runs linearly from end to end."""
    axis = flesh.end - flesh.start
    length = float(axis @ axis)
    at = np.clip((points - flesh.start) @ axis / length, 0, 1) if length > 0 else np.zeros(len(points))
    radius = flesh.radii[0] + at * (flesh.radii[1] - flesh.radii[0])
    distance: Array = np.linalg.norm(points - flesh.start - at[:, None] * axis, axis=1) - radius
    return distance


def body_distance(points: Array, skeleton: Skeleton) -> Array:
    """Signed distance (n,) to the blended capsules of a body, its soles cut flat at z = 0."""
    total = np.full(len(points), 10.0)
    k = skeleton.blend
    for flesh in skeleton.flesh:
        distance = capsule_distance(points, flesh)
        mix = np.maximum(k - np.abs(total - distance), 0) / k
        total = np.minimum(total, distance) - mix * mix * k / 4
    cut: Array = np.maximum(total, -points[:, 2])
    return cut


def gradient(points: Array, skeleton: Skeleton, step: float = 1e-4) -> Array:
    """Central differences (n, 3) of ``body_distance``."""
    columns = [
        (body_distance(points + step * axis, skeleton) - body_distance(points - step * axis, skeleton)) / (2 * step)
        for axis in np.eye(3)
    ]
    return np.stack(columns, axis=1)


def body_mesh(skeleton: Skeleton, vertices: int, spacing: float = 0.0125) -> tuple[Array, Faces]:
    """A closed mesh of about ``vertices`` vertices: marching cubes, shortest edges collapsed, relaxed on the surface.

    Needs scikit-image and libigl (of the development extras), which nothing else of the program does.
    """
    import igl
    from skimage.measure import marching_cubes

    low = np.min([np.minimum(f.start, f.end) - max(f.radii) for f in skeleton.flesh], axis=0) - 3 * spacing
    high = np.max([np.maximum(f.start, f.end) + max(f.radii) for f in skeleton.flesh], axis=0) + 3 * spacing
    axes = [np.arange(a, b, spacing) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    field = body_distance(grid.reshape(-1, 3), skeleton).reshape(grid.shape[:3])
    fine, triangles, _, _ = marching_cubes(field, 0.0, spacing=(spacing,) * 3, gradient_direction="ascent")
    fine = fine.astype(np.float64) + low
    triangles = triangles.astype(np.int64)
    fine = relax(fine, triangles.astype(np.int32), skeleton, 4)
    coarse = igl.decimate(fine, triangles, 2 * vertices - 4)
    points, faces = np.ascontiguousarray(coarse[0]), np.ascontiguousarray(coarse[1]).astype(np.int32)
    points = relax(points, faces, skeleton, 12)
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    if np.sum(a * np.cross(b, c)) < 0:
        faces = faces[:, ::-1].copy()
    return points, faces


def relax(points: Array, faces: Faces, skeleton: Skeleton, rounds: int) -> Array:
    """Even out a mesh along the surface of its body, (n, 3): mean of the neighbours, then back onto the surface."""
    from scipy import sparse

    i = faces.ravel()
    j = np.roll(faces, -1, axis=1).ravel()
    n = len(points)
    links: Any = sparse.csr_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(n, n))
    links.data[:] = 1.0
    degree = np.asarray(links.sum(axis=1)).ravel()
    for _ in range(rounds):
        points = 0.5 * points + 0.5 * (links @ points) / degree[:, None]
        for _ in range(2):
            normal = gradient(points, skeleton)
            size = np.maximum(np.sum(normal**2, axis=1, keepdims=True), 0.25)
            points = points - body_distance(points, skeleton)[:, None] * normal / size
    return points


def skin_weights(points: Array, faces: Faces, skeleton: Skeleton, reach: float = 0.035) -> Array:
    """Weights (n, bones) that sum to 1: the nearest bone of each vertex, diffused over the mesh by about ``reach``.

    Feet move as one piece up to the ankle, so that what is planted stands still exactly.
    """
    import robust_laplacian
    from scipy.sparse.linalg import splu

    names = list(skeleton.bones)
    distance = np.full((len(points), len(names)), np.inf)
    for flesh in skeleton.flesh:
        at = names.index(flesh.bone)
        distance[:, at] = np.minimum(distance[:, at], capsule_distance(points, flesh))
    label = np.argmin(distance, axis=1)
    laplacian, mass = robust_laplacian.mesh_laplacian(points, faces)
    solve = splu((mass + reach**2 / 2 * laplacian).tocsc())
    weights = np.eye(len(names))[label]
    for _ in range(2):
        weights = solve.solve(mass @ weights)
    weights = np.maximum(weights, 0)
    keep = np.sort(weights, axis=1)[:, -4][:, None]
    weights = np.where(weights >= np.maximum(keep, 0.01), weights, 0)
    for leg in skeleton.legs:
        foot = names.index(leg.foot)
        ankle = skeleton.bones[leg.foot].head[2]
        near = np.linalg.norm(points[:, :2] - skeleton.bones[leg.foot].head[:2], axis=1) < 0.25
        lock = np.clip((ankle * 1.5 - points[:, 2]) / (ankle * 0.8), 0, 1) * near
        lock *= np.isin(label, [foot, names.index(leg.lower)])
        weights = (1 - lock[:, None]) * weights
        weights[:, foot] += lock
    weights = np.where(weights >= np.sort(weights, axis=1)[:, -4][:, None], weights, 0)
    weights = (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32).astype(np.float64)
    total: Array = weights / weights.sum(axis=1, keepdims=True)
    return total
