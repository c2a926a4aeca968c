"""Normals for drawing."""

from __future__ import annotations

import numpy as np

from imitation.geometry import vertex_normals
from imitation.geometry.drawing import drawn_normals, hides_its_inside
from imitation.geometry.measures import is_closed


def test_they_are_the_usual_normals() -> None:
    """Those weighted by area, to single precision; a vertex without faces has none."""
    random = np.random.default_rng(4)
    vertices = random.standard_normal((60, 3))
    faces = random.permuted(np.tile(np.arange(59), (40, 1)), axis=1)[:, :3].astype(np.int32)
    normals = drawn_normals(vertices.astype(np.float32), faces)
    assert normals.dtype == np.float32
    np.testing.assert_allclose(normals, vertex_normals(vertices, faces), atol=2e-5)
    assert (normals[59] == 0).all()


def test_a_mesh_without_faces_has_none() -> None:
    """Nothing is divided by zero."""
    assert (drawn_normals(np.ones((3, 3), np.float32), np.zeros((0, 3), np.int32)) == 0).all()


def test_closed_meshes_hide_their_inside() -> None:
    """A ball does; with a hole, inside out, or without faces it does not; the answer is that of sorting all edges."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=3)
    vertices, faces = np.asarray(ball.vertices, np.float32), np.asarray(ball.faces, np.int32)
    assert hides_its_inside(vertices, faces)
    assert not hides_its_inside(vertices, faces[1:])
    assert not hides_its_inside(vertices, faces[:, ::-1].copy())
    assert not hides_its_inside(vertices, faces[:0])
    two = np.concatenate([faces, faces[:5], faces[:5, ::-1]])
    assert hides_its_inside(vertices, two) == is_closed(two) is True
    random = np.random.default_rng(1)
    for _ in range(200):
        some = np.delete(faces, random.integers(0, len(faces), random.integers(0, 3)), axis=0)
        assert hides_its_inside(vertices, some) == is_closed(some)
