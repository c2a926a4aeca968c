"""The performer: closed meshes, exact labels, the same bits for the same seed."""

from __future__ import annotations

import attrs
import numpy as np
import pytest
from scipy.spatial import cKDTree

from resources.performer import (
    MOTIONS,
    Part,
    body_capsules,
    body_joints,
    body_mesh,
    motion_pose,
    perform,
    perform_hound,
    random_script,
)
from resources.performer.cube_table import EDGES, cube_triangles
from resources.world.sample import load
from resources.world.skeleton import quadruped


def edge_uses(faces: np.ndarray) -> np.ndarray:
    """How often each undirected edge is used."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(edges, axis=0, return_counts=True)[1]


@pytest.mark.parametrize("name", MOTIONS)
def test_every_motion_is_a_closed_body_facing_outwards(name: str) -> None:
    """Each edge has two triangles, the volume is a person's, and the colours are one a vertex."""
    vertices, faces, colours = body_mesh(body_capsules(body_joints(motion_pose(name, 0.3))), offset=np.full(3, 0.37))
    assert (edge_uses(faces) == 2).all()
    volume = (
        np.einsum("ij,ij->i", vertices[faces[:, 0]], np.cross(vertices[faces[:, 1]], vertices[faces[:, 2]])).sum() / 6
    )
    assert 0.05 < volume < 0.09
    assert colours.shape == vertices.shape
    assert abs(vertices[:, 2].min()) < 0.09


def test_cubes_share_their_faces_edges() -> None:
    """Every crossed edge of every cube is used, and none that is not crossed."""
    triangles, counts = cube_triangles()
    for code in range(256):
        crossed = {n for n, (a, b) in enumerate(EDGES) if (code >> a & 1) != (code >> b & 1)}
        assert set(triangles[code, : counts[code]].ravel().tolist()) == crossed


def test_the_standing_foot_of_a_walk_stays() -> None:
    """The body travels, and the lower ankle moves by less than a centimetre a frame at mid-stance."""
    capture = perform([Part("walk", 4)], fps=30, seed=3)
    assert np.linalg.norm(capture.joints[-1, 0, :2] - capture.joints[0, 0, :2]) > 2.5
    toes = capture.joints[:, [9, 16]]
    step = np.linalg.norm(np.diff(toes[:, :, :2], axis=0), axis=2)
    assert np.median(step.min(axis=1)) < 0.01


def test_labels_name_the_middle_of_the_transitions() -> None:
    """Boundaries are where the part changes, and the phase grows by the repeats asked for."""
    capture = perform([Part("squat", 3), Part("kick", 5)], fps=15, seed=4, period_spread=0.0)
    assert capture.boundaries == (int(np.flatnonzero(np.diff(capture.part))[0]) + 1,)
    last = capture.phase[capture.part == 1]
    assert np.ptp(last) == pytest.approx(5, abs=0.2)


def test_poses_run_through_transitions_without_jumps() -> None:
    """No joint moves faster than a hand can, arm circles included, wherever the transition falls."""
    for seed in range(6):
        capture = perform([Part("arm circles", 2.3), Part("bend", 1), Part("arm circles", 2.1)], fps=30, seed=seed)
        step = np.linalg.norm(np.diff(capture.joints - capture.joints[:, :1], axis=0), axis=2).max()
        assert step < 0.35


def test_same_seed_same_bits_and_another_copy_differs() -> None:
    """A frame's mesh depends on seed and frame alone; two copies of a pose share no vertex."""
    captures = [perform(random_script(5, motions=2), fps=10, seed=5, hard=True) for _ in range(2)]
    meshes = [capture.mesh(7) for capture in captures]
    assert all(np.array_equal(a, b) for a, b in zip(*meshes, strict=True))
    other = captures[0].mesh(7, copy=1)[0]
    assert len(other) != len(meshes[0][0]) or not np.array_equal(other, meshes[0][0])


def test_hard_captures_turn_and_vary() -> None:
    """A hard capture turns the performer and changes the number of vertices from frame to frame."""
    capture = perform([Part("march", 6)], fps=10, seed=8, hard=True)
    assert np.ptp(capture.headings) > 0.3
    assert len({len(capture.mesh(frame)[0]) for frame in range(5)}) == 5


def test_the_hound_performs_as_its_character_is() -> None:
    """Closed meshes of its own in every frame, on the ground, as thick and coloured as the sample's hound."""
    capture = perform_hound([Part("walk", 2), Part("bow", 1)], seed=1, cell=0.03)
    assert capture.names == ("walk", "bow")
    hound = load().characters["hound"]
    counts = set()
    for frame in range(0, len(capture), 7):
        vertices, faces, colours = capture.mesh(frame)
        counts.add(len(vertices))
        assert (edge_uses(faces) == 2).all()
        assert abs(vertices[:, 2].min()) < 1e-9
        assert colours.shape == vertices.shape
    assert len(counts) > 3
    rest = attrs.evolve(
        capture,
        rotations=np.tile(np.eye(3), (1, 25, 1, 1)),
        translations=np.zeros((1, 25, 3)),
    )
    vertices, _, colours = rest.mesh(0)
    near, index = cKDTree(hound.moving.rest).query(vertices)
    assert np.median(near) < 0.012
    assert np.abs(colours.astype(int) - hound.colours[index]).mean() < 12


def test_the_hounds_standing_feet_do_not_slide() -> None:
    """While a paw stands in a walk its sole keeps its place to millimetres a frame."""
    capture = perform_hound([Part("walk", 3)], seed=2)
    leg = next(leg for leg in quadruped().legs if leg.name == "left hind")
    bone = list(quadruped().bones).index(leg.foot)
    sole = capture.rotations[:, bone] @ leg.soles[0][1] + capture.translations[:, bone]
    stands = (sole[:-1, 2] < 2e-3) & (sole[1:, 2] < 2e-3)
    steps = np.abs(np.diff(sole[:, 0]))[stands]
    assert stands.sum() > 20
    assert np.median(steps) < 0.004
    assert sole[-1, 0] - sole[0, 0] > 1.0
