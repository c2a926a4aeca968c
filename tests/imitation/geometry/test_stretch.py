"""Stretch and penetration at the vertices, against what can be told by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from imitation import InputError
from imitation.geometry.measures import edge_stretch, unique_edges
from imitation.geometry.penetration import below_ground
from imitation.geometry.stretch import VertexStretch

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


@given(st.floats(0.2, 5.0))
def test_a_scaled_mesh_is_stretched_by_its_scale(scale: float) -> None:
    """Everywhere alike; a vertex without a triangle is at rest."""
    stretch = VertexStretch(SQUARE, FACES)(scale * SQUARE)
    assert stretch[:4] == pytest.approx(scale)
    assert stretch[4] == 1.0


@given(st.integers(0, 1000))
def test_it_is_the_edge_that_changed_most(seed: int) -> None:
    """Against the edges' own stretch, one vertex after the other."""
    posed = SQUARE + np.random.default_rng(seed).normal(0, 0.3, SQUARE.shape)
    edges, values = unique_edges(FACES), edge_stretch(SQUARE, posed, FACES)
    found = VertexStretch(SQUARE, FACES)(posed)
    for vertex in range(4):
        mine = values[(edges == vertex).any(axis=1)]
        assert found[vertex] == pytest.approx(mine[np.argmax(np.abs(np.log(mine)))])


def test_a_rigid_motion_stretches_nothing() -> None:
    """Turned and shifted, all is 1; another number of vertices is refused."""
    meter = VertexStretch(SQUARE, FACES)
    assert meter(SQUARE[:, [1, 2, 0]] + 3.0) == pytest.approx(1.0)
    with pytest.raises(InputError, match="needs 5 vertices"):
        meter(SQUARE[:4])


def test_below_the_nearest_step() -> None:
    """One point is a plane; of two steps the nearer one counts; above nothing is measured."""
    vertices = np.array([[0.0, 0, -0.2], [0, 0, 0.1], [9, 0, 0.9]])
    assert below_ground(vertices, [[0, 0, 0]]) == pytest.approx([0.2, 0, 0])
    assert below_ground(vertices, [[0, 0, 0], [10, 0, 1.0]]) == pytest.approx([0.2, 0, 0.1])
    assert below_ground(vertices[:, [2, 0, 1]], [[0, 0, 0]], (2.0, 0, 0)) == pytest.approx([0.2, 0, 0])
    assert below_ground(vertices, [[0, 0, 0], [10, 0, 1.0]], reach=0.5) == pytest.approx([0.2, 0, 0])
    with pytest.raises(InputError, match="one point"):
        below_ground(vertices, np.zeros((0, 3)))
