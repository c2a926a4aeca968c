"""One step, convergence, softness, stiffness, volume: what is solved is the energy that is documented."""

import itertools

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.deformation.constraints import build_rows
from imitation.geometry import Camera, edge_stretch, mesh_volume
from tests.imitation.deformation.reference import best_rotations, direct_step
from tests.imitation.deformation.shapes import ball, bent, cylinder, farthest, pulled

BALL = ball()


def camera_before(vertices: np.ndarray, distance: float) -> Camera:
    """A camera that looks along y at the middle of the vertices, z up."""
    R = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    centre = vertices.mean(axis=0) - [0, distance, 0]
    return Camera([[1200, 0, 480], [0, 1200, 270], [0, 0, 1]], R, -R @ centre)


def test_one_step_agrees_with_an_assembled_sparse_system() -> None:
    """Points, soft points, rays and depths: the Schur complement gives what a direct solve gives, to 1e-8."""
    from imitation.deformation.kernels import one_step
    from imitation.geometry import quaternion_of

    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    handles = farthest(vertices, 10)
    camera = camera_before(vertices, 8)
    asked = FrameConstraints(
        {v: vertices[v] * 1.2 for v in handles[:5]},
        {v: camera.project(vertices[v]) + 3 for v in handles[5:]},
        camera,
        {handles[5]: 7.0},
        {handles[0]: 0.5, handles[6]: 0.9},
    )
    rows = build_rows(deformer.mesh, asked)
    pose = deformer.mesh.positions * [1.1, 0.9, 1.0] + 0.1 * np.sin(5 * deformer.mesh.positions[:, [1, 2, 0]])
    order = deformer.system.order
    turns = np.array([quaternion_of(turn) for turn in best_rotations(deformer, pose)])[order]
    ours = one_step(
        np.ascontiguousarray(pose[order]),
        np.ascontiguousarray(turns),
        deformer.system.arrays,
        deformer.system.small(rows).arrays(rows.target),
    )
    direct = direct_step(deformer, rows, pose, 300.0)[order]
    assert np.abs(ours - direct).max() <= 1e-8 * np.abs(direct).max()


def test_rotations_reach_the_polar_factor() -> None:
    """The Newton steps end at the rotations of a singular value decomposition."""
    from imitation.geometry import quaternion_matrix

    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    pose = vertices * [1.2, 0.8, 1.0] + 0.1 * np.sin(3 * vertices[:, [1, 2, 0]])
    ours = quaternion_matrix(deformer.pose_of(pose).turns)
    inner = (pose - deformer.mesh.centre) / deformer.mesh.diagonal
    assert np.abs(ours - best_rotations(deformer, inner)[deformer.system.order]).max() <= 1e-9


def test_hard_handles_are_met_exactly_and_soft_ones_on_the_way() -> None:
    """A hard handle lies on its target; a soft one comes nearer with growing softness value."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    points = pulled(vertices, farthest(vertices, 8), 2)
    posed = deformer.solve(points)
    assert max(np.abs(posed[v] - p).max() for v, p in points.items()) <= 1e-12
    moved = next(v for v, p in points.items() if np.abs(p - vertices[v]).max() > 0.01)
    misses = [
        np.linalg.norm(deformer.solve(points, softness={moved: soft})[moved] - points[moved])
        for soft in (0.1, 0.5, 0.9, 0.999, 1)
    ]
    assert all(a > b for a, b in itertools.pairwise(misses))
    assert misses[3] < 0.01 * misses[0]


def test_tolerance_means_distance_to_the_solution() -> None:
    """At the default tolerance a cold pull is within 1e-4 diagonals of where many more steps lead."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    points = FrameConstraints(pulled(vertices, farthest(vertices, 12), 5))
    far = deformer.solve_pose(points, tolerance=1e-11, most=2000)
    near = deformer.solve_pose(points)
    assert near.converged
    assert np.abs(near.vertices - far.vertices).max() <= 1e-4 * deformer.mesh.diagonal


def test_warm_start_and_cold_start_meet() -> None:
    """The pose does not depend on where the iteration began."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    points = pulled(vertices, farthest(vertices, 12), 5)
    cold = deformer.solve(points, tolerance=1e-8)
    warm = deformer.solve(points, start=vertices, tolerance=1e-8)
    assert np.abs(cold - warm).max() <= 1e-5


def test_volume_is_kept_when_asked() -> None:
    """The volume of the rest pose is back within half a percent and the handles stay exact."""
    vertices, faces = BALL
    points = pulled(vertices, farthest(vertices, 12), 5)
    posed = Deformer(vertices, faces, keep_volume=True).solve(points)
    assert mesh_volume(posed, faces) == pytest.approx(mesh_volume(vertices, faces), rel=0.005)
    assert max(np.abs(posed[v] - p).max() for v, p in points.items()) <= 1e-10


def test_cylinder_bends_without_collapsing() -> None:
    """Bent by its end rings a cylinder keeps its volume and its edges, near the exact arc."""
    vertices, faces = cylinder()
    target = bent(vertices, np.pi / 2)
    handles = [ring * 32 + k for ring in (0, 74) for k in range(0, 32, 4)]
    posed = Deformer(vertices, faces).solve({v: target[v] for v in handles}, iterations=10)
    assert mesh_volume(posed, faces) / mesh_volume(target, faces) > 0.95
    assert edge_stretch(vertices, posed, faces).max() <= 1.15


def test_stiff_region_keeps_its_shape_better() -> None:
    """A hundred times stiffer half is stretched far less than before, and the rest pose stays exact."""
    vertices, faces = BALL
    stiff = np.where(vertices[:, 1] > 0.3, 100.0, 1.0)
    points = pulled(vertices, [v for v in farthest(vertices, 12) if vertices[v, 1] < 0.3], 5, 3)
    inside = (vertices[faces][:, :, 1] > 0.3).all(axis=1)

    def strain(stiffness: np.ndarray | None) -> float:
        posed = Deformer(vertices, faces, stiffness=stiffness).solve(points)
        return float(np.abs(edge_stretch(vertices, posed, faces[inside]) - 1).mean())

    assert strain(stiff) < 0.3 * strain(None)
    rest = Deformer(vertices, faces, stiffness=stiff).solve({v: vertices[v] for v in points})
    assert np.abs(rest - vertices).max() <= 1e-9


def test_printed_form_keeps_rest_and_follows_pulls() -> None:
    """Mode paper: exact at rest, handles met softly, different from the default."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces, method="paper")
    handles = farthest(vertices, 12)
    rest = deformer.solve({v: vertices[v] for v in handles}, iterations=10)
    assert np.abs(rest - vertices).max() <= 1e-8
    points = pulled(vertices, handles, 5)
    posed = deformer.solve(points, iterations=10)
    assert max(np.abs(posed[v] - p).max() for v, p in points.items()) <= 0.02
    assert np.abs(posed - Deformer(vertices, faces).solve(points)).max() > 1e-3
