"""What can be measured on a triangle mesh: edges, normals, stretch, volume, closedness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.geometry.projection import Array

Indices = NDArray[np.int64]


def unique_edges(faces: ArrayLike) -> Indices:
    """Edges (e, 2) of triangles (m, 3), each once, smaller index first, sorted."""
    triangles = np.asarray(faces, np.int64)
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    return np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)


def is_closed(faces: ArrayLike) -> bool:
    """Whether every directed edge of the triangles (m, 3) has exactly one partner, so that a volume is defined."""
    triangles = np.asarray(faces, np.int64)
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    size = int(triangles.max()) + 1 if len(triangles) else 1
    there, back = np.sort(directed @ [size, 1]), np.sort(directed[:, ::-1] @ [size, 1])
    return bool(len(triangles)) and bool(np.array_equal(there, back))


def vertex_normals(vertices: ArrayLike, faces: ArrayLike) -> Array:
    """Unit normals (n, 3) at the vertices, faces weighted by area; zero where no face of positive area meets."""
    points, triangles = np.asarray(vertices, np.float64), np.asarray(faces, np.int64)
    corners = points[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.stack(
        [np.bincount(triangles.ravel(), np.repeat(across[:, axis], 3), len(points)) for axis in range(3)], axis=1
    )
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals: Array = np.divide(total, length, out=np.zeros_like(total), where=length > 0)
    return normals


def edge_stretch(rest: ArrayLike, posed: ArrayLike, faces: ArrayLike) -> Array:
    """Length of each edge in the pose over its length at rest (e,), in the order of ``unique_edges``.

    Edges of no length at rest count as 1 while they stay so and as infinite when they open.
    """
    edges = unique_edges(faces)
    before, after = (
        np.linalg.norm(place[edges[:, 0]] - place[edges[:, 1]], axis=1)
        for place in (np.asarray(rest, np.float64), np.asarray(posed, np.float64))
    )
    unknown = np.where(after > 0, np.inf, 1.0)
    stretch: Array = np.divide(after, before, out=unknown, where=before > 0)
    return stretch


def mesh_volume(vertices: ArrayLike, faces: ArrayLike) -> float:
    """Signed volume inside a closed mesh, positive with outward normals (sum of tetrahedra to the first vertex)."""
    points = np.asarray(vertices, np.float64)
    corners = points[np.asarray(faces, np.int64)] - points[0]
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)


def volume_gradient(vertices: ArrayLike, faces: ArrayLike) -> Array:
    """Derivative (n, 3) of ``mesh_volume`` with respect to each vertex of a closed mesh."""
    points, triangles = np.asarray(vertices, np.float64), np.asarray(faces, np.int64)
    a, b, c = (points[triangles[:, corner]] - points[0] for corner in range(3))
    parts = np.concatenate([np.cross(b, c), np.cross(c, a), np.cross(a, b)]) / 6
    order = triangles.T.ravel()
    return np.stack([np.bincount(order, parts[:, axis], len(points)) for axis in range(3)], axis=1)
