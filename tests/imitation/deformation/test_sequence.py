"""Sequences and drags: no flicker, every frame streamed, handles come and go without a new factor."""

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.errors import Cancelled
from tests.imitation.deformation.shapes import ball, farthest, moving

BALL = ball()


def frames_of(count: int, seed: int, amount: float = 0.04) -> list[FrameConstraints]:
    """Twelve handles that swing."""
    vertices, _ = BALL
    handles = farthest(vertices, 12)
    places = moving(vertices, handles, count, seed, amount)
    return [FrameConstraints(dict(zip(handles, place, strict=True))) for place in places]


def second_difference(poses: np.ndarray) -> float:
    """Largest second difference over time of any vertex."""
    return float(np.linalg.norm(np.diff(poses, 2, axis=0), axis=2).max())


def test_a_sequence_does_not_flicker() -> None:
    """Frames lie within 2e-4 diagonals of full convergence, and move as smoothly."""
    vertices, faces = BALL
    deformer, frames = Deformer(vertices, faces), frames_of(40, 3)
    posed = deformer.solve_sequence(frames)
    exact = deformer.solve_sequence(frames, tolerance=1e-10, max_iterations=1000)
    assert np.abs(posed - exact).max() <= 2e-4 * deformer.mesh.diagonal
    assert second_difference(posed) <= 1.05 * second_difference(exact)


def test_noise_does_not_throw_a_sequence_off() -> None:
    """Handles that jump by three thousandths of the diagonal every frame still converge in every frame."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    random = np.random.default_rng(0)
    noisy = [
        FrameConstraints({v: p + random.normal(size=3) * 0.003 * deformer.mesh.diagonal for v, p in f.points.items()})
        for f in frames_of(12, 4)
    ]
    assert all(pose.converged for pose in deformer.solve_poses(noisy))


def test_frames_with_other_handles_are_allowed_and_empty_ones_keep_the_pose() -> None:
    """Handles may come and go; a frame without any repeats the frame before."""
    vertices, faces = BALL
    deformer, frames = Deformer(vertices, faces), frames_of(6, 5)
    some = dict(list(frames[2].points.items())[:7])
    posed = deformer.solve_sequence([frames[0], frames[1], FrameConstraints(some), FrameConstraints(), frames[4]])
    np.testing.assert_array_equal(posed[3], posed[2])
    for vertex, place in frames[4].points.items():
        np.testing.assert_allclose(posed[4][vertex], place, atol=1e-9)


def test_frames_are_streamed_and_cancelled() -> None:
    """Each frame is handed over when solved, and a cancel ends the run there."""
    vertices, faces = BALL
    seen: list[int] = []

    def stop(fraction: float) -> None:
        if fraction >= 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        Deformer(vertices, faces).solve_sequence(
            frames_of(4, 6), progress=stop, on_frame=lambda frame, _: seen.append(frame)
        )
    assert seen == [0, 1]


def test_a_drag_follows_and_comes_back() -> None:
    """A handle dragged and brought back leaves no trace; handles are added and removed on the way."""
    vertices, faces = BALL
    deformer = Deformer(vertices, faces)
    handles = farthest(vertices, 8)
    drag = deformer.session(FrameConstraints({v: vertices[v] for v in handles}))
    for amount in [*np.linspace(0, 0.4, 10), *np.linspace(0.4, 0, 10)]:
        drag.move({handles[0]: vertices[handles[0]] * (1 + amount)})
        np.testing.assert_allclose(drag.vertices[handles[0]], vertices[handles[0]] * (1 + amount), atol=1e-12)
    assert np.abs(drag.refine() - vertices).max() <= 1e-3
    extra = farthest(vertices, 9)[-1]
    drag.hold(extra)
    drag.move({handles[0]: vertices[handles[0]] * 1.2})
    np.testing.assert_allclose(drag.vertices[extra], drag.asked.points[extra], atol=1e-12)
    drag.release(extra)
    assert extra not in drag.asked.points
