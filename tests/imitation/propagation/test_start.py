"""The pose in frame 0 is part of placing: the whole solution begins with it, and the rule of edits holds with it."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation.deformation import Deformer
from imitation.errors import InputError
from imitation.propagation import Base, commit_edit, imitate, placed_frame, propagate, solve_base, start_pose
from tests.imitation.propagation.conftest import Walker

OTHER = 14


def onto(vertices: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Vertices moved rigidly onto others."""
    middle = vertices.mean(axis=0), target.mean(axis=0)
    u, _, v = np.linalg.svd((target - middle[1]).T @ (vertices - middle[0]))
    turn = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v
    return (vertices - middle[0]) @ turn.T + middle[1]


@attrs.frozen(eq=False)
class Placed:
    """A character whose file has it in mid-stride, and the drags that give it the subject's pose in frame 0."""

    walker: Walker
    rest: np.ndarray
    deformer: Deformer
    moves: dict[int, np.ndarray]

    @property
    def arguments(self) -> tuple:
        return self.rest, *self.walker.arguments[1:]

    def frame(self) -> Base:
        planted = [name for name, spans in self.walker.walk.contacts.items() if any(not s[0] for s in spans)]
        return placed_frame(self.rest, self.walker.faces, self.walker.cameras[0], self.walker.pairs, planted)

    def start(self, moves: dict[int, np.ndarray] | None = None) -> Base:
        frame = self.frame()
        committed = commit_edit(frame, 0, self.moves if moves is None else moves, deformer=self.deformer)
        return start_pose(frame, committed, deformer=self.deformer)

    def base(self, moves: dict[int, np.ndarray] | None = None) -> Base:
        return solve_base(*self.arguments, start=self.start(moves).vertices[0], deformer=self.deformer)


@pytest.fixture(scope="module")
def placed(walker: Walker) -> Placed:
    """The walker, stored as it stands half a stride later."""
    rest = onto(walker.walk.vertices[OTHER], walker.rest)
    moves = {vertex: walker.place(0, vertex) for vertex in walker.pairs.values()}
    return Placed(walker, rest, Deformer(rest, walker.faces), moves)


@pytest.fixture(scope="module")
def plain(placed: Placed) -> Base:
    """The solution from the pose of the file."""
    return solve_base(*placed.arguments, deformer=placed.deformer)


@pytest.fixture(scope="module")
def posed(placed: Placed) -> Base:
    """The solution from the pose of frame 0."""
    return placed.base()


def test_a_pose_in_frame_0_enters_the_solution(placed: Placed, plain: Base, posed: Base) -> None:
    """Lengths and offsets come from it: less than 0.6 of the error that the same edit leaves as a shift alone."""
    committed = {0: commit_edit(plain, 0, placed.moves, deformer=placed.deformer)}
    shifted = propagate(plain, committed, deformer=placed.deformer)
    error = placed.walker.error
    assert error(shifted.vertices) < 0.8 * error(plain.vertices)
    assert error(posed.vertices) < 0.6 * error(shifted.vertices)


def test_frame_0_is_the_pose_to_the_bit(placed: Placed, posed: Base) -> None:
    """Dragged vertices are where they were put, and the mesh between them is the one that was accepted."""
    for vertex, place in placed.moves.items():
        assert np.array_equal(posed.vertices[0, vertex], place)
    assert np.array_equal(posed.vertices[0], placed.start().vertices[0])


def test_no_pose_is_as_if_never_made(placed: Placed, plain: Base) -> None:
    """Without committed places the start is the placed character and the solution has the bits of none."""
    assert np.array_equal(start_pose(placed.frame(), {}).vertices[0], placed.rest)
    again = solve_base(*placed.arguments, start=placed.rest, deformer=placed.deformer)
    assert np.array_equal(again.vertices, plain.vertices)


def test_the_scripting_surface_poses_frame_0_first(placed: Placed, posed: Base, free_vertices: list[int]) -> None:
    """`imitate` takes the edit of frame 0 into the solution; a control vertex in it moves on from where it was put."""
    whole = imitate(*placed.arguments, edits={0: placed.moves}, deformer=placed.deformer)
    assert np.array_equal(whole.vertices, posed.vertices)
    assert whole.report.edited_frames == 1
    vertex = free_vertices[0]
    true = placed.walker.walk.vertices[:, vertex]
    free = imitate(
        *placed.arguments, edits={0: {**placed.moves, vertex: true[0]}}, deformer=placed.deformer, method="joint"
    )
    assert np.array_equal(free.vertices[0, vertex], true[0])
    assert np.linalg.norm(free.vertices[1, vertex] - free.vertices[0, vertex]) < 0.03 * placed.walker.walk.body.diagonal
    assert placed.walker.error(free.vertices) < 1.1 * placed.walker.error(posed.vertices)


def test_a_reach_makes_it_an_edit_as_any_other(placed: Placed, plain: Base) -> None:
    """With its own end the edit of frame 0 changes nothing outside, to the bit."""
    limited = imitate(*placed.arguments, edits={0: placed.moves}, reach={0: (0, 12)}, deformer=placed.deformer)
    faded = imitate(*placed.arguments, edits={0: placed.moves}, end=12, deformer=placed.deformer)
    for result in (limited, faded):
        assert np.array_equal(result.vertices[12:], plain.vertices[12:])
        assert not np.array_equal(result.vertices[6], plain.vertices[6])


def test_another_frame_keeps_its_committed_pose(placed: Placed, plain: Base, posed: Base) -> None:
    """An edit made before frame 0 was posed stands: its places to the bit, the surface between them nearly."""
    moves = {vertex: placed.walker.place(16, vertex) for vertex in list(placed.moves)[:4]}
    committed = {16: commit_edit(plain, 16, moves, deformer=placed.deformer)}
    before = propagate(plain, committed, deformer=placed.deformer)
    after = propagate(posed, committed, deformer=placed.deformer)
    for vertex, place in committed[16].items():
        assert np.array_equal(after.vertices[16, vertex], place)
    moved = np.linalg.norm(after.vertices[16] - before.vertices[16], axis=1).mean()
    assert moved < 2e-3 * placed.walker.walk.body.diagonal


def test_a_bad_start_is_refused(placed: Placed) -> None:
    """A pose of another mesh, and a place that is not finite, are one sentence."""
    with pytest.raises(InputError, match="pose in frame 0"):
        solve_base(*placed.arguments, start=placed.rest[:-1], deformer=placed.deformer)
    with pytest.raises(InputError, match="three finite numbers"):
        start_pose(placed.frame(), {0: (0, np.nan, 0)})
    with pytest.raises(InputError, match="vertex 1000000"):
        placed_frame(placed.rest, placed.walker.faces, placed.walker.cameras[0], {"nose": 10**6})
