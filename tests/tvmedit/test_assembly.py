"""Normal equations of a deformation against its derivatives, and nodes numbered so that their table is narrow."""

from __future__ import annotations

import numpy as np
import pytest

from tvmedit.cuts.assembly import deform, normal_equations
from tvmedit.cuts.nodes import DeformationGraph, spread_nodes
from tvmedit.cuts.rotations import rotation_matrices
from tvmedit.features.measure import extent

STIFFNESS, POINT_SHARE = 0.7, 0.25


def tube(rings: int = 40, around: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """A tube a metre long and 6 cm thick."""
    angles = 2 * np.pi * np.arange(around) / around
    z, angle = np.meshgrid(np.linspace(0.0, 1.0, rings), angles, indexing="ij")
    vertices = np.stack([0.06 * np.cos(angle), 0.06 * np.sin(angle), z], axis=2).reshape(-1, 3)
    ring, k = np.meshgrid(np.arange(rings - 1), np.arange(around), indexing="ij")
    a, b = ring * around + k, ring * around + (k + 1) % around
    faces = np.stack([a, b, b + around, a, b + around, a + around], axis=2).reshape(-1, 3)
    return vertices, faces.astype(np.int32)


def residuals(
    graph: DeformationGraph,
    motion: np.ndarray,
    rotations: np.ndarray,
    moves: np.ndarray,
    points: np.ndarray,
    goals: np.ndarray,
    normals: np.ndarray,
    trust: np.ndarray,
) -> np.ndarray:
    """What the squares are summed of, after a motion (m, 6) of every node."""
    turned, moved = rotation_matrices(motion[:, :3]) @ rotations, moves + motion[:, 3:]
    gaps = deform(points, graph.places, graph.bound[: len(points)], graph.weights[: len(points)], turned, moved) - goals
    along = np.sqrt(trust) * (gaps * normals).sum(axis=1)
    whole = np.sqrt(POINT_SHARE * trust)[:, None] * gaps
    apart = []
    for first, second in np.concatenate([graph.edges, graph.edges[:, ::-1]]):
        arm = turned[first] @ (graph.places[second] - graph.places[first])
        apart.append(arm + graph.places[first] + moved[first] - graph.places[second] - moved[second])
    return np.concatenate([along, whole.ravel(), np.sqrt(STIFFNESS) * np.ravel(apart)])


def test_normal_equations_are_those_of_the_derivatives() -> None:
    """Matrix and right side against differences of the residuals, at a deformation that is far from none."""
    vertices, faces = tube()
    graph = spread_nodes(vertices, faces, 0.15)
    random = np.random.default_rng(1)
    count = len(graph.places)
    rotations, moves = rotation_matrices(0.5 * random.standard_normal((count, 3))), random.standard_normal((count, 3))
    normals = random.standard_normal(vertices.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    goals = random.standard_normal(vertices.shape)
    trust = np.where(random.random(len(vertices)) < 0.2, 0.0, random.random(len(vertices)))
    gaps = deform(vertices, graph.places, graph.bound, graph.weights, rotations, moves) - goals
    matrix, right = normal_equations(
        vertices, graph.bound, graph.weights, gaps, normals, trust, graph.places, rotations, moves, graph.edges,
        STIFFNESS, POINT_SHARE, graph.bandwidth,
    )  # fmt: skip

    def at(motion: np.ndarray) -> np.ndarray:
        return residuals(graph, motion.reshape(-1, 6), rotations, moves, vertices, goals, normals, trust)

    step = 1e-5
    jacobian = np.array([(at(step * row) - at(-step * row)) / (2 * step) for row in np.eye(6 * count)]).T
    expected = jacobian.T @ jacobian
    dense = np.zeros_like(expected)
    for column in range(6 * count):
        rows = min(len(matrix), 6 * count - column)
        dense[column : column + rows, column] = matrix[:rows, column]
    assert np.tril(dense) == pytest.approx(np.tril(expected), abs=1e-6)
    assert right == pytest.approx(-jacobian.T @ at(np.zeros(6 * count)), abs=1e-6)


def test_nodes_are_numbered_along_a_body() -> None:
    """Shuffled vertices change nothing: along a thin tube only few nodes lie between two that meet."""
    vertices, faces = tube()
    order = np.random.default_rng(2).permutation(len(vertices))
    rank = np.argsort(order)
    graph = spread_nodes(vertices[order], rank[faces].astype(np.int32), 0.1)
    assert len(graph.places) > 20
    apart = np.abs(graph.edges[:, 0] - graph.edges[:, 1])
    assert apart.max() + 1 == graph.bandwidth
    assert graph.bandwidth < len(graph.places) / 3


def test_nodes_of_parts_that_do_not_hang_together_are_all_there() -> None:
    """Two tubes: twice the nodes, none of which meets one of the other tube."""
    vertices, faces = tube()
    both = np.concatenate([vertices, vertices + np.array([1.0, 0.0, 0.0])])
    graph = spread_nodes(both, np.concatenate([faces, faces + len(vertices)]), 0.1)
    alone = spread_nodes(vertices, faces, 0.1)
    assert len(graph.places) == 2 * len(alone.places)
    far = graph.places[:, 0] > 0.5
    assert (far[graph.edges[:, 0]] == far[graph.edges[:, 1]]).all()
    assert graph.bandwidth == alone.bandwidth


@pytest.mark.parametrize("count", [1, 2, 50])
def test_extent_is_that_of_all_vertices(count: int) -> None:
    """Least and largest of each coordinate."""
    vertices = np.random.default_rng(count).standard_normal((count, 3))
    low, high = extent(vertices)
    assert np.array_equal(low, vertices.min(axis=0))
    assert np.array_equal(high, vertices.max(axis=0))
