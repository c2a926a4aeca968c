"""Limbs found again in another pose, told apart by distances along the surface."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

import tvmedit
from resources.performer import Part, body_capsules, body_joints, body_mesh, motion_pose, perform
from tests.benchmarks.carried import worst_steps
from tvmedit.cuts.landmarks import counterparts, end_places, matched_ends
from tvmedit.cuts.limbs import handle_count, limb_ends
from tvmedit.cuts.registration import REFUSED_EDGES

Mesh = tuple[np.ndarray, np.ndarray]
UP, SPREAD, EDGE = ("wave both", 0.3), ("twist", 0.25), 0.024


def body(name: str, phase: float, seed: int) -> tuple[Mesh, np.ndarray]:
    """Mesh of a performer's pose, and its joints."""
    joints = body_joints(motion_pose(name, phase))
    vertices, faces, _ = body_mesh(body_capsules(joints), offset=np.random.default_rng(seed).random(3))
    return (vertices, faces), joints


def carried(places: np.ndarray, moved: np.ndarray, joints: np.ndarray) -> np.ndarray:
    """Joints moved along with the dozen places nearest to each."""
    near = cKDTree(places).query(joints, k=12)[1]
    return joints + (moved - places)[near].mean(axis=1)


def test_hands_feet_and_head_are_the_ends_of_a_body() -> None:
    """Five ends, each at the joint furthest out."""
    mesh, joints = body(*SPREAD, 1)
    ends = limb_ends(*mesh)
    assert ends is not None
    nearest = cKDTree(joints).query(mesh[0][ends.vertices])[1]
    assert set(nearest.tolist()) == {2, 5, 9, 12, 16}


def test_places_are_found_however_far_a_limb_moved() -> None:
    """Joints carried by the counterparts come within 6 cm on average of where they are, moved by up to a metre."""
    (source, before), (target, after) = body(*UP, 2), body(*SPREAD, 3)
    found = counterparts(source, target)
    assert found is not None
    vertices, places = found
    assert np.linalg.norm(before - after, axis=1).max() > 0.6
    moved = carried(source[0][vertices], places, before)
    assert np.linalg.norm(moved - after, axis=1).mean() < 0.06


def test_raised_hands_are_not_taken_for_the_head() -> None:
    """By how much surface lies near each end, where distances between ends would tell no end from another."""
    (source, before), (target, after) = body("wave both", 0.05, 4), body("squat", 0.02, 5)
    ours, theirs = (limb_ends(*mesh) for mesh in (source, target))
    assert ours is not None
    assert theirs is not None
    pairs = matched_ends(ours, theirs)
    assert pairs is not None
    for mine, other in zip(*pairs, strict=True):
        here = cKDTree(before).query(source[0][ours.vertices[mine]])[1]
        assert here == cKDTree(after).query(target[0][theirs.vertices[other]])[1]


def test_ends_of_limbs_have_their_places_in_the_other_body() -> None:
    """Each end of one body's limbs is at the joint it belongs to in the other, exactly on its surface."""
    (source, before), (target, after) = body(*UP, 2), body(*SPREAD, 3)
    ends = end_places(source, target)
    assert ends is not None
    vertices, places = ends
    assert cKDTree(target[0]).query(places)[0].max() == 0.0
    assert np.array_equal(cKDTree(before).query(source[0][vertices])[1], cKDTree(after).query(places)[1])


def test_a_hand_on_the_hip_is_a_handle() -> None:
    """None on a body whose limbs hang free, holes or not; one a limb that touches it; parts beside it count apart."""
    (_, free), _ = body(*SPREAD, 1)
    (_, tied), _ = body("squat", 0.02, 2)
    assert handle_count(free) == 0
    assert handle_count(free[7:]) == 0
    assert handle_count(tied) >= 1
    apart = np.concatenate([free, tied + free.max() + 1])
    assert handle_count(apart) == handle_count(tied)


def test_one_mesh_that_moves_needs_no_search() -> None:
    """The same faces: every vertex is its own counterpart."""
    source, _ = body(*UP, 2)
    moved = source[0] @ np.diag([1.0, 0.5, 2.0])
    found = counterparts(source, (moved, source[1]))
    assert found is not None
    assert np.array_equal(found[1], moved[found[0]])


def test_a_body_in_pieces_has_no_ends() -> None:
    """Its halves do not hang together."""
    mesh, _ = body(*SPREAD, 1)
    low = mesh[0][:, 2].mean()
    halved = mesh[1][(mesh[0][mesh[1], 2] < low).all(axis=1) | (mesh[0][mesh[1], 2] > low).all(axis=1)]
    assert limb_ends(mesh[0], halved) is None


@pytest.mark.slow
def test_arms_far_from_their_goal_are_registered() -> None:
    """Closest points lose raised arms that come down; with the limbs known they arrive, and half-way is whole."""
    (source, before), (target, after) = body(*UP, 2), body(*SPREAD, 3)
    found = tvmedit.register(source, target, height=1.75, edge=EDGE, iterations=14)
    assert found.reason == ""
    assert found.residual < REFUSED_EDGES * EDGE
    moved = carried(source[0], found.between(1.0), before)
    assert np.linalg.norm(moved - after, axis=1).max() < 0.15


@pytest.mark.slow
def test_hands_that_come_down_from_before_the_face_onto_the_thighs_are_registered() -> None:
    """The way back is barred, since the hands are one surface with the thighs there; the ends of the limbs decide."""
    (source, before), (target, after) = body("wave both", 0.9, 4), body("squat", 0.02, 5)
    found = tvmedit.register(source, target, height=1.75, edge=EDGE, iterations=14)
    assert found.reason == ""
    assert np.linalg.norm(before - after, axis=1).max() > 0.7
    moved = carried(source[0], found.between(1.0), before)
    assert np.linalg.norm(moved - after, axis=1).max() < 0.15


@pytest.mark.slow
def test_a_cut_out_of_a_rest_with_the_hands_on_the_hips_is_blended() -> None:
    """Where a hand is grown together with the body, the other clip's mesh or a neighbour's is bent; nothing jumps."""
    capture = perform([Part("squat", 3), Part("twist", 3)], fps=25, seed=21)
    analysis = tvmedit.analyse(capture.meshes(), fps=25)
    textons = [cluster.textons[1] for cluster in analysis.structure.clusters]
    graph = tvmedit.motion_graph([analysis], textons=[(0, *texton) for texton in textons])
    performance = tvmedit.compose(graph, [0, 1])
    (cut,) = (joint for joint in performance.cuts if joint.kind == "cut")
    blend = tvmedit.blend_cut(graph, performance, cut, lambda _, frame: capture.mesh(frame))
    assert len(blend.shapes) >= 3
    assert sorted(blend.meshes) == sorted(blend.shapes)
    for position, (sequence, frame) in blend.meshes.items():
        assert sequence == 0
        vertices, faces, _ = capture.mesh(frame)
        assert np.array_equal(blend.shapes[position].faces, faces)
        assert blend.shapes[position].vertices.shape == vertices.shape
    placed, blended = worst_steps(
        graph, performance, lambda _, frame: capture.joints[frame], lambda _, frame: capture.mesh(frame), [blend]
    )
    assert blended < 0.5 * placed
