"""Normals, stretch, volume and its gradient against closed forms."""

import numpy as np

from imitation.geometry import edge_stretch, is_closed, mesh_volume, unique_edges, vertex_normals, volume_gradient
from tests.imitation.deformation.shapes import ball, cylinder

TETRAHEDRON = (
    np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


def test_volume_of_a_tetrahedron_and_of_its_inside_out() -> None:
    """One sixth with outward faces, its negative with inward ones."""
    vertices, faces = TETRAHEDRON
    assert abs(mesh_volume(vertices, faces) - 1 / 6) < 1e-15
    assert abs(mesh_volume(vertices + 1000, faces[:, ::-1]) + 1 / 6) < 1e-9


def test_volume_gradient_predicts_small_changes() -> None:
    """First order change of the volume under any small move."""
    vertices, faces = ball(2)
    move = 1e-6 * np.sin(7 * vertices[:, [1, 2, 0]] + 1)
    change = mesh_volume(vertices + move, faces) - mesh_volume(vertices - move, faces)
    assert abs(change / 2 - np.vdot(volume_gradient(vertices, faces), move)) < 1e-14


def test_normals_of_a_sphere_point_outward() -> None:
    """Within a degree of the radius, unit length; a lone vertex has none."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=3)
    normals = vertex_normals(np.concatenate([mesh.vertices, [[9.0, 9, 9]]]), mesh.faces)
    assert np.einsum("ij,ij->i", normals[:-1], np.asarray(mesh.vertices)).min() > 0.9998
    assert not normals[-1].any()


def test_closedness() -> None:
    """A ball and a capped cylinder are closed; with one face less, or one turned round, they are not."""
    for _, faces in (ball(2), cylinder(8, 5)):
        assert is_closed(faces)
        assert not is_closed(faces[1:])
        assert not is_closed(np.concatenate([faces[:1, ::-1], faces[1:]]))


def test_stretch_of_a_scaled_mesh() -> None:
    """Every edge twice as long; an edge of no length counts as one while it stays so."""
    vertices, faces = ball(2)
    assert np.allclose(edge_stretch(vertices, 2 * vertices + 1, faces), 2)
    assert len(unique_edges(faces)) == len(vertices) + len(faces) - 2
    twice = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0]])
    np.testing.assert_array_equal(edge_stretch(twice, twice, [[0, 1, 2]]), 1)
