"""What must not change: rest poses, rigid motions, vertex order, bits."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from imitation.deformation import Deformer, FrameConstraints
from imitation.geometry import axis_rotation
from tests.imitation.deformation.shapes import bad_meshes, ball, farthest, read_character

BALL = ball()


def rigid_error(deformer: Deformer, vertices: np.ndarray, count: int, degrees: float) -> float:
    """Largest distance, in diagonals, from the rigidly moved mesh when its handles are moved rigidly."""
    diagonal = deformer.mesh.diagonal
    turn = axis_rotation([0.3, 0.8, 0.5], np.radians(degrees))
    middle = vertices.mean(axis=0)
    moved = (vertices - middle) @ turn.T + middle + np.array([0.3, -0.2, 0.5]) * diagonal
    used = np.arange(len(vertices))
    handles = farthest(vertices[used], count)
    posed = deformer.solve({vertex: moved[vertex] for vertex in handles}, iterations=10)
    return float(np.abs(posed - moved).max() / diagonal)


@pytest.mark.parametrize("kind", sorted(bad_meshes(*BALL)))
def test_bad_meshes_keep_rest_and_rigid_motions(kind: str) -> None:
    """Every broken mesh follows its handles rigidly, with nothing left behind."""
    vertices, faces = bad_meshes(*BALL)[kind]
    deformer = Deformer(vertices, faces)
    worst = max(rigid_error(deformer, vertices, count, angle) for count in (4, 8, 20) for angle in (0, 90, 130, 170))
    assert worst <= 1e-9


@settings(deadline=None, max_examples=15)
@given(st.floats(0.01, 3.1), st.integers(0, 1000), st.sampled_from([0.0, 300.0, 3000.0]))
def test_rigid_motion_of_points_is_exact(angle: float, seed: int, weight: float) -> None:
    """Any rigid motion of any five handles moves the whole mesh rigidly."""
    vertices, faces = ball(2)
    random = np.random.default_rng(seed)
    turn = axis_rotation(random.normal(size=3), angle)
    moved = vertices @ turn.T + random.normal(size=3)
    handles = random.choice(len(vertices), 5, replace=False)
    posed = Deformer(vertices, faces, stretch_weight=weight).solve({int(i): moved[i] for i in handles}, iterations=10)
    assert np.abs(posed - moved).max() <= 1e-8


def test_order_of_the_callers_vertices_does_not_matter() -> None:
    """A shuffled mesh gives the same pose, shuffled."""
    vertices, faces = BALL
    handles = farthest(vertices, 8)
    points = {vertex: vertices[vertex] * 1.1 for vertex in handles}
    shuffle = np.random.default_rng(1).permutation(len(vertices))
    place = np.argsort(shuffle)
    plain = Deformer(vertices, faces).solve(points)
    mixed = Deformer(vertices[shuffle], place[faces]).solve({int(place[v]): p for v, p in points.items()})
    assert np.abs(mixed - plain[shuffle]).max() <= 1e-5


def test_same_input_gives_the_same_bits_whatever_was_solved_before() -> None:
    """Neither an earlier solve nor the order of the handles changes a bit."""
    vertices, faces = BALL
    handles = farthest(vertices, 8)
    points = {vertex: vertices[vertex] * 1.1 for vertex in handles}
    used = Deformer(vertices, faces)
    used.solve({handles[0]: vertices[handles[0]] + 1, handles[3]: vertices[handles[3]]})
    used.solve_sequence([FrameConstraints({v: p * 1.2 for v, p in points.items()})] * 3)
    again = used.solve(dict(reversed(points.items())))
    np.testing.assert_array_equal(again, Deformer(vertices, faces).solve(points))


THREADS = """
import hashlib
from imitation.deformation import Deformer, FrameConstraints
from tests.imitation.deformation.shapes import ball, farthest, moving
vertices, faces = ball(5)
handles = farthest(vertices, 12)
frames = [FrameConstraints(dict(zip(handles, place))) for place in moving(vertices, handles, 3, 1)]
deformer = Deformer(vertices, faces, keep_volume=True)
print(hashlib.sha1(deformer.solve_sequence(frames).tobytes()).hexdigest())
print(hashlib.sha1(deformer.solve(frames[2].points, start=vertices * 1.1).tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_number_of_threads_does_not_change_a_bit() -> None:
    """Ten thousand vertices, one thread or two: the same bytes."""
    outputs = {
        subprocess.run(
            [sys.executable, "-c", THREADS],
            env={**os.environ, "OPENBLAS_NUM_THREADS": count, "OMP_NUM_THREADS": count, "PYTHONPATH": "."},
            check=True,
            capture_output=True,
        ).stdout
        for count in ("1", "2")
    }
    assert len(outputs) == 1


@pytest.mark.slow
@pytest.mark.realdata
def test_characters_keep_rest_and_rigid_motions(shared_data: Path) -> None:
    """Every shared character follows its handles rigidly to 1e-9 of the diagonal."""
    for path in sorted((shared_data / "characters").glob("*.ply")):
        vertices, faces = read_character(shared_data, path.stem)
        deformer = Deformer(vertices, faces)
        worst = max(rigid_error(deformer, vertices, count, angle) for count in (4, 20) for angle in (0, 90, 170))
        assert worst <= 1e-9, path.stem


def test_several_threads_may_use_one_deformer() -> None:
    """What is kept for later is shared and changes no bit, whoever computed it and in whatever order."""
    vertices, faces = BALL
    jobs = []
    for seed in range(12):
        handles = farthest(vertices, 6 + seed % 5)
        random = np.random.default_rng(seed)
        jobs.append({vertex: vertices[vertex] + 0.05 * random.normal(size=3) for vertex in handles})
    alone = [Deformer(vertices, faces).solve(points) for points in jobs]
    shared = Deformer(vertices, faces)
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(shared.solve, jobs + jobs[::-1]))
    assert all(np.array_equal(a, b) for a, b in zip(alone + alone[::-1], together, strict=True))
