"""Normals for drawing."""

from __future__ import annotations

import numpy as np

from imitation.geometry import vertex_normals
from imitation.geometry.drawing import drawn_normals


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
