"""Preparation of any mesh for deformation: weld, robust Laplacian, no part left behind; the caller's order stays."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Array

WELD = 1e-7
"""Vertices closer than this share of the diagonal are one."""
LARGEST_WEIGHT = 50.0
TIE_WEIGHT = 0.5
TIES = 4
"""A loose part is tied by this many vertices with as many links each."""


@attrs.frozen(eq=False)
class PreparedMesh:
    """A mesh as a solver wants it, with the way back to the caller's vertices.

    Attributes
    ----------
    vertices : (n, 3) the caller's vertices.
    faces : (f, 3) the caller's triangles.
    index : (n,) for each of the caller's vertices, its welded vertex.
    positions : (m, 3) welded vertices, moved to the centre of the box and divided by ``diagonal``.
    triangles : (g, 3) triangles between welded vertices, none with two equal corners.
    weights : (m, m) sparse symmetric matrix of edge weights, all positive; one connected graph.
    areas : (m,) vertex areas, in squared diagonals, all positive.
    centre : (3,) centre of the bounding box, world.
    diagonal : length of the bounding box' diagonal, world units.
    parts : number of separate parts before they were tied.
    """

    vertices: Array
    faces: NDArray[np.int32]
    index: NDArray[np.int64]
    positions: Array
    triangles: NDArray[np.int64]
    weights: Any
    areas: Array
    centre: Array
    diagonal: float
    parts: int


def check_mesh(vertices: ArrayLike, faces: ArrayLike) -> tuple[Array, NDArray[np.int32]]:
    """Vertices (n, 3) float64 and faces (f, 3) int32, or one sentence about what is wrong with them."""
    points = np.array(vertices, dtype=np.float64)
    triangles = np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,) or not len(points):
        raise InputError(f"A mesh needs vertices of shape (n, 3), but got an array of shape {points.shape}.")
    if triangles.ndim != 2 or triangles.shape[1:] != (3,) or not len(triangles):
        raise InputError("The mesh has no triangles; give faces of shape (m, 3) with at least one row.")
    if not np.issubdtype(triangles.dtype, np.integer):
        raise InputError(f"The faces of a mesh must be whole numbers, but are of type {triangles.dtype}.")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise InputError(
            f"{len(bad)} vertices of the mesh have NaN or infinite coordinates, the first is vertex {bad[0]}."
        )
    wrong = np.flatnonzero(((triangles < 0) | (triangles >= len(points))).any(axis=1))
    if len(wrong):
        raise InputError(
            f"Face {wrong[0]} of the mesh names a vertex that does not exist ({triangles[wrong[0]].tolist()} of "
            f"{len(points)} vertices)."
        )
    return points, triangles.astype(np.int32)


def prepare_mesh(vertices: ArrayLike, faces: ArrayLike) -> PreparedMesh:
    """Make any triangle mesh fit for deformation.

    Open, non-manifold, unwelded and degenerate meshes, slivers, several parts and unreferenced vertices are all
    accepted. The steps: weld equal positions; intrinsic Delaunay Laplacian with mollification (Sharp and Crane,
    "A Laplacian for nonmanifold triangle meshes", 2020), weights clipped to [0, 50], areas floored at one hundredth
    of their mean; separate parts tied by weak links, so that constants stay the only kernel.

    Parameters
    ----------
    vertices : (n, 3), any unit. faces : (f, 3) indices into them.

    Raises
    ------
    InputError
        NaN coordinates, no faces, an index out of range, all vertices in one place, or no face with an area.
    """
    from scipy import sparse

    points, triangles = check_mesh(vertices, faces)
    low, high = points.min(axis=0), points.max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    if diagonal == 0 or not np.isfinite(diagonal):
        raise InputError("All vertices of the mesh lie in one place, so it has no shape to keep.")
    centre = (low + high) / 2
    scaled = (points - centre) / diagonal
    index, first = _weld(scaled)
    positions = scaled[first]
    welded = index[triangles]
    distinct = (welded[:, 0] != welded[:, 1]) & (welded[:, 1] != welded[:, 2]) & (welded[:, 2] != welded[:, 0])
    welded = welded[distinct]
    if not len(welded):
        raise InputError("No face of the mesh has three different corners, so it has no surface.")
    weights, areas = _laplacian(positions, welded)
    weights, parts = _tie(positions, weights)
    return PreparedMesh(
        vertices=points,
        faces=triangles,
        index=index,
        positions=positions,
        triangles=welded,
        weights=sparse.csr_array(weights),
        areas=areas,
        centre=centre,
        diagonal=diagonal,
        parts=parts,
    )


def _weld(positions: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(positions).query_pairs(WELD, output_type="ndarray")
    size = len(positions)
    joined = sparse.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    labels = connected_components(joined, directed=False)[1]
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    return rank[inverse].astype(np.int64), np.sort(first).astype(np.int64)


def _laplacian(positions: Array, triangles: NDArray[np.int64]) -> tuple[Any, Array]:
    from robust_laplacian import mesh_laplacian
    from scipy import sparse

    stiffness, mass = mesh_laplacian(positions, triangles, mollify_factor=1e-4)
    entries = sparse.coo_array(stiffness)
    keep = entries.row != entries.col
    value = np.clip(-entries.data[keep], 0, LARGEST_WEIGHT)
    value[~(value > 1e-8)] = 0.0  # a NaN from a face without any extent goes the same way
    weights = sparse.csr_array((value, (entries.row[keep], entries.col[keep])), shape=stiffness.shape)
    weights = (weights + weights.T) / 2
    weights.eliminate_zeros()
    areas = np.nan_to_num(np.asarray(mass.diagonal(), np.float64))
    return weights, np.maximum(areas, 0.01 * areas.mean())


def _tie(positions: Array, weights: Any) -> tuple[Any, int]:
    """Link separate parts to the largest, nearest first, so that the graph becomes one."""
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    parts, labels = connected_components(weights, directed=False)
    if parts == 1:
        return weights, 1
    tied = labels == np.argmax(np.bincount(labels))
    rows: list[NDArray[np.int64]] = []
    cols: list[NDArray[np.int64]] = []
    rounds = 0
    while not tied.all():
        there, loose = np.flatnonzero(tied), np.flatnonzero(~tied)
        links = min(TIES, len(there))
        found = cKDTree(positions[there]).query(positions[loose], k=links)
        distance = np.asarray(found[0], np.float64).reshape(len(loose), links)
        nearest = np.asarray(found[1], np.int64).reshape(len(loose), links)
        gap = np.full(parts, np.inf)
        np.minimum.at(gap, labels[loose], distance[:, 0])
        rounds += 1
        reach = np.inf if rounds > 40 else 1.5 * gap.min() + 1e-9
        order = np.lexsort((distance[:, 0], labels[loose]))
        for part in np.flatnonzero(gap <= reach):
            begin = np.searchsorted(labels[loose][order], part)
            for chosen in order[begin : begin + TIES]:
                if labels[loose[chosen]] != part:
                    break
                rows.append(np.full(links, loose[chosen]))
                cols.append(there[nearest[chosen]])
            tied |= labels == part
    row, col = np.concatenate(rows), np.concatenate(cols)
    links_matrix = sparse.coo_array((np.full(len(row), TIE_WEIGHT), (row, col)), shape=weights.shape)
    return weights + links_matrix + links_matrix.T, parts
