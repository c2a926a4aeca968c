"""Shapes in between two meshes of other faces: ends, lengths, ground."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

import tvmedit
from resources.performer import body_capsules, body_joints, body_mesh, motion_pose
from tvmedit.cuts.interpolation import partly
from tvmedit.cuts.nodes import DeformationGraph
from tvmedit.cuts.registration import Registration
from tvmedit.cuts.rotations import rotation_matrices
from tvmedit.cuts.surface import mesh_volume

Mesh = tuple[np.ndarray, np.ndarray]


def body(name: str, phase: float, seed: int) -> Mesh:
    """Mesh of a performer's pose."""
    joints = body_joints(motion_pose(name, phase))
    vertices, faces, _ = body_mesh(body_capsules(joints), offset=np.random.default_rng(seed).random(3))
    return vertices, faces


@pytest.fixture(scope="module")
def spread() -> Registration:
    """Raised arms and closed legs into raised arms and spread legs."""
    return tvmedit.register(body("wave both", 0.6, 1), body("jumping jack", 0.5, 2), height=1.75, edge=0.024)


def chain(angle: float, links: int = 6) -> tuple[DeformationGraph, np.ndarray, np.ndarray]:
    """A straight limb of unit links that swings about its first node, as a deformation graph, with its motions."""
    places = np.c_[np.arange(links + 1.0), np.zeros((links + 1, 2))]
    edges = np.c_[np.arange(links), np.arange(1, links + 1)]
    nobody = np.zeros((0, 4))
    graph = DeformationGraph(places, nobody.astype(np.int64), nobody, edges.astype(np.int64), 2)
    turn = rotation_matrices(np.array([[0.0, angle, 0.0]]))[0]
    return graph, np.tile(turn, (links + 1, 1, 1)), places @ turn.T - places


@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 1.0])
def test_a_limb_that_swings_keeps_its_length(share: float) -> None:
    """It turns about its joint by its share, where a straight way would cut the corner."""
    graph, rotations, moves = chain(2.0)
    turned, moved = partly(graph, rotations, moves, share)
    expected = graph.places @ rotation_matrices(np.array([[0.0, 2.0 * share, 0.0]]))[0].T
    placed = graph.places + moved
    assert np.linalg.norm(np.diff(placed, axis=0), axis=1) == pytest.approx(np.ones(6))
    assert placed - placed[0] == pytest.approx(expected, abs=1e-9)
    assert turned[3] == pytest.approx(rotation_matrices(np.array([[0.0, 2.0 * share, 0.0]]))[0])


def test_parts_that_do_not_hang_together_move_on_their_own() -> None:
    """Two pieces, one of them still: it stays where it is."""
    graph, rotations, moves = chain(1.0)
    edges = np.array([[0, 1], [1, 2], [4, 5], [5, 6]])
    apart = DeformationGraph(graph.places, graph.bound, graph.weights, edges, 2)
    moves[:3], rotations[:3] = 0.0, np.eye(3)
    _, moved = partly(apart, rotations, moves, 0.5)
    assert moved[:3] == pytest.approx(np.zeros((3, 3)), abs=1e-12)
    assert np.linalg.norm(np.diff((graph.places + moved)[4:], axis=0), axis=1) == pytest.approx([1, 1])


def test_both_ends_are_met(spread: Registration) -> None:
    """Nothing of the deformation is the mesh itself; all of it lies on the target."""
    assert not spread.reason
    assert spread.between(0.0) == pytest.approx(spread.vertices, abs=1e-9)
    assert spread.residual < 0.048


def test_half_way_the_body_is_whole_and_stands_on_the_ground(spread: Registration) -> None:
    """Its volume is within 2 %, its feet at the height of both ends."""
    half = spread.between(0.5)
    assert mesh_volume(half, spread.faces) == pytest.approx(mesh_volume(spread.vertices, spread.faces), rel=0.02)
    assert np.sort(half[:, 2])[:20].mean() == pytest.approx(np.sort(spread.vertices[:, 2])[:20].mean(), abs=0.003)


def test_half_way_is_the_pose_half_way(spread: Registration) -> None:
    """Against the truth meshed finely: within a quarter of a mesh edge on average."""
    from scipy.spatial import cKDTree

    pose = 0.5 * (motion_pose("wave both", 0.6) + motion_pose("jumping jack", 0.5))
    fine, _, _ = body_mesh(body_capsules(body_joints(pose)), cell=0.011)
    assert cKDTree(fine).query(spread.between(0.5))[0].mean() < 0.006


def test_a_limb_far_on_its_way_is_caught_and_a_wrong_one_refused() -> None:
    """An arm raised by a quarter period is found by looking further, legs of another stride by the limbs' ends."""
    arm = tvmedit.register(body("side bend", 0.05, 1), body("side bend", 0.25, 2), height=1.75, edge=0.024)
    assert not arm.reason
    assert arm.residual < 0.03
    legs = tvmedit.register(body("walk", 0.18, 3), body("walk", 0.99, 4), height=1.75, edge=0.024)
    crossed = tvmedit.register(body("march", 0.34, 5), body("kick", 0.3, 6), height=1.75, edge=0.024)
    assert not legs.reason
    before, after = (body_joints(motion_pose("walk", phase)) for phase in (0.18, 0.99))
    near = cKDTree(legs.vertices).query(before, k=12)[1]
    reached = before + (legs.between(1.0) - legs.vertices)[near].mean(axis=1)
    assert np.linalg.norm(before - after, axis=1).max() > 0.5
    assert np.linalg.norm(reached - after, axis=1).max() < 0.1
    assert crossed.reason
