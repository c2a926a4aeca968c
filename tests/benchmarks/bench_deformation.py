"""Figures of the deformation beside libigl's ARAP, in the same process and the same run."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.deformation.constraints import build_rows
from imitation.geometry import edge_stretch, mesh_volume, unique_edges
from tests.benchmarks.record import Recorder
from tests.imitation.deformation.reference import best_rotations, direct_step
from tests.imitation.deformation.shapes import (
    Mesh,
    bad_meshes,
    ball,
    bent,
    cylinder,
    farthest,
    moving,
    pulled,
    read_character,
    subdivided,
)
from tests.imitation.deformation.test_invariance import rigid_error

pytestmark = [pytest.mark.bench, pytest.mark.realdata]
ARAP = "libigl ARAP"
SIZES = ["2.5k", "10k"]


class Arap:
    """The named baseline: libigl's as-rigid-as-possible solver with its default energy."""

    def __init__(self, mesh: Mesh, handles: list[int], iterations: int) -> None:
        import igl

        self.igl, self.data, self.handles = igl, igl.ARAPData(), np.array(sorted(handles))
        self.data.max_iter = iterations
        vertices, faces = mesh
        igl.arap_precomputation(vertices, faces.astype(np.int64), 3, self.handles, self.data)

    def solve(self, points: dict[int, np.ndarray], start: np.ndarray) -> np.ndarray:
        """A pose (n, 3) from a start."""
        wanted = np.array([points[int(v)] for v in self.handles])
        return np.asarray(self.igl.arap_solve(wanted, self.data, start.copy()))


def interleaved(*calls: Callable[[], Any], rounds: int = 7) -> list[float]:
    """Median CPU seconds of each call, taken in turn so that a loaded machine treats them alike."""
    spent: list[list[float]] = [[] for _ in calls]
    for call in calls:
        call()
    for _ in range(rounds):
        for call, times in zip(calls, spent, strict=True):
            begin = time.process_time()
            call()
            times.append(time.process_time() - begin)
    return [sorted(times)[rounds // 2] for times in spent]


def horse(folder: Path, size: str) -> Mesh:
    """The horse with 2,502 vertices, or subdivided once."""
    mesh = read_character(folder, "horse_cyberware_2500")
    return mesh if size == "2.5k" else subdivided(*mesh)


def second_difference(poses: np.ndarray) -> float:
    """Largest second difference over time of any vertex."""
    return float(np.linalg.norm(np.diff(poses, 2, axis=0), axis=2).max())


def spike(mesh: Mesh, posed: np.ndarray, handles: list[int]) -> float:
    """How far pulled handles stand out from the mean of their neighbours, more than at rest, in mean edge lengths."""
    vertices, faces = mesh
    edges = unique_edges(faces)
    length = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean()

    def height(pose: np.ndarray, vertex: int) -> float:
        beside = edges[(edges == vertex).any(axis=1)].ravel()
        return float(np.linalg.norm(pose[vertex] - pose[beside[beside != vertex]].mean(axis=0)))

    return max((height(posed, v) - height(vertices, v)) / length for v in handles)


def test_rest_and_rigid_motions(bench: Recorder, shared_data: Path) -> None:
    """All characters and all broken meshes; ARAP from rest on the horse as it is used elsewhere."""
    names = [path.stem for path in sorted((shared_data / "characters").glob("*.ply"))]
    meshes = {name: read_character(shared_data, name) for name in names}
    meshes.update(bad_meshes(*ball()))
    worst = 0.0
    for vertices, faces in meshes.values():
        deformer = Deformer(vertices, faces)
        errors = [rigid_error(deformer, vertices, k, a) for k in (4, 8, 20) for a in (0, 90, 130, 170)]
        worst = max(worst, *errors)
    vertices, faces = meshes["horse_cyberware_2500"]
    handles = farthest(vertices, 8)
    moved = vertices * [-1, 1, -1]
    arap = Arap((vertices, faces), handles, 10).solve({v: moved[v] for v in handles}, vertices)
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    bench.record(
        "deformation: rest and rigid motion, worst error",
        worst,
        asked=1e-9,
        unit="diagonals",
        baseline=float(np.abs(arap - moved).max()) / diagonal,
        baseline_name=f"{ARAP} from rest, 180 degrees, 8 handles, 10 iterations",
        note=f"{len(meshes)} meshes, 4, 8 and 20 handles, 0 to 170 degrees",
    )


def test_step_against_direct_solve(bench: Recorder, shared_data: Path) -> None:
    """One global step and one assembled sparse system."""
    from imitation.deformation.kernels import one_step
    from imitation.geometry import quaternion_of

    vertices, faces = horse(shared_data, "2.5k")
    deformer = Deformer(vertices, faces)
    rows = build_rows(deformer.mesh, FrameConstraints(pulled(vertices, farthest(vertices, 16), 21)))
    order = deformer.system.order
    pose = deformer.mesh.positions + 0.02 * np.sin(9 * deformer.mesh.positions[:, [1, 2, 0]])
    turns = np.array([quaternion_of(turn) for turn in best_rotations(deformer, pose)])[order]
    small = deformer.system.small(rows).arrays(rows.target)
    # The rotations are already the best, so the step leaves them as they are.
    ours = one_step(np.ascontiguousarray(pose[order]), turns.copy(), deformer.system.arrays, small)
    direct = direct_step(deformer, rows, pose, 300.0)[order]
    value = float(np.abs(ours - direct).max() / np.abs(direct).max())
    bench.record("deformation: one step against a direct sparse solve", value, asked=1e-8, unit="relative")


def test_bent_cylinder(bench: Recorder) -> None:
    """Bent by 90 degrees with eight handles at each end, ten iterations."""
    mesh = cylinder()
    vertices, faces = mesh
    target = bent(vertices, np.pi / 2)
    points = {ring * 32 + k: target[ring * 32 + k] for ring in (0, 74) for k in range(0, 32, 4)}
    full = mesh_volume(vertices, faces)
    exact = float(edge_stretch(vertices, target, faces).max())
    posed = Deformer(vertices, faces).solve(points, iterations=10)
    loss, longest = 1 - mesh_volume(posed, faces) / full, float(edge_stretch(vertices, posed, faces).max())
    for iterations in (10, 200):
        arap = Arap(mesh, list(points), iterations).solve(points, vertices)
        theirs, other = 1 - mesh_volume(arap, faces) / full, float(edge_stretch(vertices, arap, faces).max())
        by = f"{ARAP}, {iterations} iterations"
        name = f"deformation: bent cylinder, volume lost after 10 iterations, against {iterations}"
        bench.record(name, loss, asked=0.5 * theirs, baseline=theirs, baseline_name=by)
    note = f"the exact arc stretches its longest edge by {exact:.3f}"
    name = "deformation: bent cylinder, longest stretch"
    bench.record(name, longest, asked=1.15, baseline=other, baseline_name=by, note=note)


@pytest.mark.parametrize("name", ["horse_cyberware_2500", "armadillo_6k", "lizard_2500", "cat_sumner_7k"])
def test_pulled_handles(bench: Recorder, shared_data: Path, name: str) -> None:
    """Four of twelve handles pulled: spikes, stretch, volume."""
    mesh = read_character(shared_data, name)
    vertices, faces = mesh
    handles = farthest(vertices, 12)
    deformer, steady = Deformer(vertices, faces), Deformer(vertices, faces, keep_volume=True)
    ours, theirs, volumes, stretch, strain = [], [], [], [], []
    for seed in (101, 102, 103):
        points = pulled(vertices, handles, seed)
        moved = [v for v in handles if np.abs(points[v] - vertices[v]).max() > 0]
        posed, arap = deformer.solve(points), Arap(mesh, handles, 200).solve(points, vertices)
        ours.append(spike(mesh, posed, moved))
        theirs.append(spike(mesh, arap, moved))
        stretch.append(float(edge_stretch(vertices, posed, faces).max()))
        strain.append(float(edge_stretch(vertices, arap, faces).max()))
        volumes.append(abs(mesh_volume(steady.solve(points), faces) / mesh_volume(vertices, faces) - 1))
    label = f"deformation: pulled handles, {name}"
    by = f"{ARAP}, 200 iterations"
    mean, other = float(np.mean(ours)), float(np.mean(theirs))
    bench.record(f"{label}, spike", mean, asked=0.3 * other, baseline=other, baseline_name=by, unit="edges")
    mean, other = float(np.mean(stretch)), float(np.mean(strain))
    bench.record(f"{label}, longest stretch", mean, asked=0.75 * other, baseline=other, baseline_name=by)
    bench.record(f"{label}, volume step on", max(volumes), asked=0.005, unit="relative")


def test_cold_pull(bench: Recorder, shared_data: Path) -> None:
    """How far a cold pull is from where it ends after twenty iterations from the rest pose."""
    mesh = read_character(shared_data, "horse_cyberware_2500")
    vertices, faces = mesh
    deformer, handles = Deformer(vertices, faces), farthest(vertices, 12)
    rest = deformer.pose_of(vertices)
    ours, theirs = [], []
    for seed in (101, 102, 103):
        asked = FrameConstraints(pulled(vertices, handles, seed))
        points = {v: np.asarray(p) for v, p in asked.points.items()}
        exact = deformer.solve_pose(asked, start=rest, tolerance=1e-10, most=2000).vertices
        near = deformer.solve_pose(asked, start=rest, iterations=20).vertices
        full, few = (Arap(mesh, handles, count).solve(points, vertices) for count in (2000, 20))
        ours.append(np.linalg.norm(near - exact, axis=1).mean() / deformer.mesh.diagonal)
        theirs.append(np.linalg.norm(few - full, axis=1).mean() / deformer.mesh.diagonal)
    mine, other = float(np.mean(ours)), float(np.mean(theirs))
    name = "deformation: cold pull, mean error after 20 iterations"
    bench.record(name, mine, asked=0.1 * other, baseline=other, baseline_name=ARAP, unit="diagonals")


@pytest.mark.parametrize("size", SIZES)
def test_speed(bench: Recorder, shared_data: Path, size: str) -> None:
    """Eight iterations, a new handle, a dragged frame."""
    mesh = horse(shared_data, size)
    vertices, faces = mesh
    deformer = Deformer(vertices, faces)
    handles = farthest(vertices, 16)
    asked = FrameConstraints(pulled(vertices, handles, 31))
    points = {v: np.asarray(p) for v, p in asked.points.items()}
    rest = deformer.pose_of(vertices)
    arap = Arap(mesh, handles, 8)
    mine, theirs = interleaved(
        lambda: deformer.solve_pose(asked, start=rest, iterations=8), lambda: arap.solve(points, vertices)
    )
    bench.record(
        f"deformation: 8 iterations, {size}, times less CPU",
        theirs / mine,
        asked=2.5 if size == "2.5k" else 2.0,
        better="higher",
        baseline=1.0,
        baseline_name=f"{ARAP} ({1e3 * theirs:.1f} ms; ours {1e3 * mine:.1f} ms)",
    )
    fresh = iter(np.setdiff1d(np.arange(len(vertices)), handles))

    def add() -> None:
        more = {**asked.points, int(next(fresh)): [0.0, 0.0, 0.0]}
        deformer.system.small(build_rows(deformer.mesh, FrameConstraints(more)))

    mine, again, theirs = interleaved(add, lambda: Deformer(vertices, faces), lambda: Arap(mesh, handles, 8))
    bench.record(
        f"deformation: adding a handle, {size}, times less CPU than refactoring",
        again / mine,
        asked=30,
        better="higher",
        baseline=theirs / mine,
        baseline_name=f"{ARAP}'s precomputation over our adding ({1e3 * mine:.2f} ms)",
    )
    track = [vertices[handles[0]] + np.array([0.2, 0, 0]) * deformer.mesh.diagonal * t / 40 for t in range(1, 41)]
    drag = deformer.session(FrameConstraints({v: vertices[v] for v in handles}))
    pose, lag = vertices, 0.0
    spent = [0.0, 0.0]
    still = {v: vertices[v] for v in handles}
    for step, place in enumerate(track):
        begin = time.process_time()
        drag.move({handles[0]: place})
        middle = time.process_time()
        pose = arap.solve({**still, handles[0]: place}, pose)
        spent[0] += middle - begin
        spent[1] += time.process_time() - middle
        if step % 10 == 9:
            done = deformer.solve_pose(drag.asked, start=drag.pose, tolerance=1e-9, most=500).vertices
            lag = max(lag, float(np.linalg.norm(drag.vertices - done, axis=1).max()) / deformer.mesh.diagonal)
    by = f"{ARAP}, 8 iterations, warm"
    value = 1e3 * spent[0] / len(track)
    other = 1e3 * spent[1] / len(track)
    limit = 8 if size == "2.5k" else 35
    bench.record(f"deformation: dragged frame, {size}", value, asked=limit, unit="ms", baseline=other, baseline_name=by)
    bench.record(f"deformation: dragged frame, {size}, times less CPU", other / value, asked=2.5, better="higher")
    bench.record(f"deformation: drag lag, {size}", lag, asked=3e-4, unit="diagonals")


@pytest.mark.parametrize("size", SIZES)
def test_sequence(bench: Recorder, shared_data: Path, size: str) -> None:
    """Long sequences of 16 points to the tolerance, against ARAP warm with 8 iterations a frame; three motions."""
    mesh = horse(shared_data, size)
    vertices, faces = mesh
    handles = farthest(vertices, 16)
    count = 240 if size == "2.5k" else 120
    ratios, jumps, errors = [], [], []
    Deformer(vertices, faces).solve_sequence([FrameConstraints({v: vertices[v] for v in handles})] * 3)
    for seed in (301, 302, 303):
        places = moving(vertices, handles, 240, seed)[:count]
        frames = [FrameConstraints(dict(zip(handles, place, strict=True))) for place in places]
        deformer = Deformer(vertices, faces)
        arap, pose = Arap(mesh, handles, 8), vertices
        begin = time.process_time()
        posed = deformer.solve_sequence(frames)
        middle = time.process_time()
        for frame in frames:
            pose = arap.solve({v: np.asarray(p) for v, p in frame.points.items()}, pose)
        ratios.append((time.process_time() - middle) / (middle - begin))
        exact = deformer.solve_sequence(frames, tolerance=1e-9, max_iterations=300)
        jumps.append(second_difference(posed) / second_difference(exact))
        errors.append(float(np.linalg.norm(posed - exact, axis=2).max()) / deformer.mesh.diagonal)
    each = "three motions: {} with errors up to {}".format
    name = f"deformation: {count} frames x 16 points, {size}"
    bench.record(
        f"{name}, times less CPU, median",
        float(np.median(ratios)),
        asked=2.5,
        better="higher",
        baseline=1.0,
        baseline_name=f"{ARAP}, warm, 8 iterations a frame",
        note=each(np.round(ratios, 2).tolist(), [f"{error:.1e}" for error in errors]),
    )
    note = each(np.round(jumps, 3).tolist(), [f"{error:.1e}" for error in errors])
    bench.record(
        f"{name}, second difference over the converged one's, median", float(np.median(jumps)), asked=1.2, note=note
    )
    bench.record(f"{name}, the same, worst", max(jumps), asked=1.2, note=note)


def test_one_point_and_fifteen_rays(bench: Recorder, shared_data: Path) -> None:
    """A posed horse seen from two diagonals away, started at rest."""
    from imitation.geometry import Camera, axis_rotation

    vertices, faces = horse(shared_data, "2.5k")
    deformer = Deformer(vertices, faces)
    diagonal = deformer.mesh.diagonal
    handles, more = farthest(vertices, 16), farthest(vertices, 24)
    errors, biases, known = [], [], []
    for seed, yaw in ((51, 0.0), (52, 20.0), (53, 35.0)):
        random = np.random.default_rng(seed)
        middle = vertices.mean(axis=0)
        # This large, sixteen known points leave the error that the prototypes' scenes had (.002 to .003).
        axes = random.normal(size=(3, 3)) * 0.01
        wave = vertices + np.sin(6 * (vertices - middle) / diagonal) @ axes * diagonal
        turned = (wave - middle) @ axis_rotation([0, 1, 0], np.radians(yaw)).T + middle
        truth = deformer.solve({v: turned[v] for v in more})
        R = np.diag([1.0, -1.0, -1.0])
        camera = Camera([[1200, 0, 480], [0, 1200, 270], [0, 0, 1]], R, -R @ (middle + np.array([0, 0, 2]) * diagonal))
        rays = {v: camera.project(truth[v]) for v in handles[1:]}
        posed = deformer.solve({handles[0]: truth[handles[0]]}, rays, camera, start=vertices)
        errors.append(float(np.linalg.norm(posed - truth, axis=1).mean()) / diagonal)
        biases.append(abs(float((camera.depth(posed) - camera.depth(truth)).mean())) / diagonal)
        full = deformer.solve({v: truth[v] for v in handles})
        known.append(float(np.linalg.norm(full - truth, axis=1).mean()) / diagonal)
    base, by = max(known), "the same handles as 16 points"
    name = "deformation: 1 point and 15 rays, mean error"
    bench.record(name, max(errors), asked=0.03, unit="diagonals", baseline=base, baseline_name=by)
    bench.record("deformation: 1 point and 15 rays, depth bias", max(biases), asked=0.02, unit="diagonals")
