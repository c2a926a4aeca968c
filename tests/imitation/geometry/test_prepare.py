"""Preparation and regions of meshes."""

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components

from imitation.errors import InputError
from imitation.geometry import geodesic_regions, key_adjacency, prepare_mesh
from tests.imitation.deformation.shapes import bad_meshes, ball, cylinder, farthest

BALL = ball()


@pytest.mark.parametrize("kind", sorted(bad_meshes(*BALL)))
def test_every_mesh_becomes_one_graph_with_positive_weights(kind: str) -> None:
    """Symmetric positive weights below the limit, positive areas, one part, a way back for every vertex."""
    vertices, faces = bad_meshes(*BALL)[kind]
    mesh = prepare_mesh(vertices, faces)
    assert connected_components(mesh.weights)[0] == 1
    assert mesh.weights.data.min() > 0
    assert mesh.weights.data.max() <= 50 + 4
    assert abs(mesh.weights - mesh.weights.T).max() == 0
    assert mesh.areas.min() > 0
    back = mesh.positions[mesh.index] * mesh.diagonal + mesh.centre
    assert np.abs(back - vertices).max() <= 2e-7 * mesh.diagonal * (1 + np.abs(vertices).max() / mesh.diagonal * 1e-3)


def test_a_soup_is_welded_and_parts_are_counted() -> None:
    """Triangles of their own become the mesh they came from; separate parts are counted."""
    vertices, faces = BALL
    soup = prepare_mesh(vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3))
    assert len(soup.positions) == len(vertices)
    assert soup.parts == 1
    two = prepare_mesh(np.concatenate([vertices, vertices + 9]), np.concatenate([faces, faces + len(vertices)]))
    assert two.parts == 2


def test_regions_of_a_cylinder() -> None:
    """Keys along a cylinder own the nearest rings and touch only their neighbours."""
    vertices, faces = cylinder(16, 41)
    keys = [16 * ring for ring in (2, 14, 26, 38)]
    region = geodesic_regions(vertices, faces, keys)
    assert (region[: 16 * 7] == 0).all()
    assert (region[16 * 34 : 16 * 41] == 3).all()
    np.testing.assert_array_equal(key_adjacency(vertices, faces, keys), [[0, 1], [1, 2], [2, 3]])


def test_every_key_owns_itself() -> None:
    """A key vertex lies in its own region, also on a soup."""
    vertices, faces = BALL
    keys = farthest(vertices, 9)
    np.testing.assert_array_equal(geodesic_regions(vertices, faces, keys)[keys], np.arange(9))
    with pytest.raises(InputError, match="does not exist"):
        geodesic_regions(vertices, faces, [len(vertices)])
    with pytest.raises(InputError, match="at least one"):
        geodesic_regions(vertices, faces, [])
