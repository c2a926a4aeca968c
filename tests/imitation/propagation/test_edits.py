"""What an edit means: each sentence of the rule is a test."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.deformation import Deformer, FrameConstraints
from imitation.errors import Cancelled, InputError
from imitation.motion.rays import depths_of, project_points
from imitation.motion.transfer import span_share
from imitation.propagation import Base, commit_edit, edited_pose, propagate
from imitation.propagation.edits import typical_modes
from tests.imitation.propagation.conftest import Walker

Edits = dict[int, dict[int, np.ndarray]]


def spread(walker: Walker, base: Base, edits: Edits, **options: object):
    """The edits over the base with the walker's own deformer."""
    return propagate(base, edits, deformer=walker.deformer, **options)


def test_a_moved_vertex_is_exactly_where_it_was_put(
    walker: Walker, base: Base, edits: Edits, free_vertices: list[int]
) -> None:
    """Handles of edits are hard: the committed position and the frame's vertex have the bits of the drag."""
    result = spread(walker, base, edits)
    for frame, vertex in ((8, free_vertices[0]), (16, free_vertices[1]), (24, free_vertices[1])):
        assert np.array_equal(edits[frame][vertex], walker.place(frame, vertex))
        assert np.array_equal(result.vertices[frame, vertex], walker.place(frame, vertex))


def test_re_deformation_puts_2d_key_points_on_their_rays_and_keeps_contacts(
    walker: Walker, base: Base, free_vertices: list[int]
) -> None:
    """Key points give way in depth and stay in the picture; planted ones and pinned ones stay in space."""
    frame, vertex = 16, free_vertices[0]
    camera = base.cameras[frame]
    away = base.vertices[frame, vertex] + 0.1 * walker.walk.body.diagonal * camera.R[2]
    planted = base.keys.planted[frame]
    free = int(np.flatnonzero(~planted)[0])
    pin = int(base.keys.vertices[free])
    committed = commit_edit(base, frame, {vertex: away}, deformer=walker.deformer, pinned=[pin])
    before = base.key_points[frame]
    after = np.stack([committed[int(key)] for key in base.keys.vertices])
    assert np.array_equal(after[planted], before[planted])
    assert np.array_equal(after[free], before[free])
    moved = np.abs(camera.depth(after) - camera.depth(before)) / walker.walk.body.diagonal
    assert moved.max() > 0.005
    assert np.abs(camera.project(after) - camera.project(before)).max() < 0.3


def test_every_key_point_has_a_boundary_value_in_every_edited_frame(walker: Walker, base: Base, edits: Edits) -> None:
    """Eq. 6: the committed place of every key point is met in every edited frame, and frame 0 keeps the base's."""
    result = spread(walker, base, edits)
    for frame, committed in edits.items():
        assert set(base.keys.vertices.tolist()) <= set(committed)
        for vertex, place in committed.items():
            assert np.array_equal(result.vertices[frame, vertex], place)
    assert np.array_equal(result.vertices[0], base.vertices[0])


@pytest.mark.slow
def test_a_new_control_vertex_does_not_alter_frames_edited_before_it(
    walker: Walker, base: Base, edits: Edits, free_vertices: list[int]
) -> None:
    """The second control vertex appears in frame 16; the pose of frame 8 keeps its bits, and it leads on to it."""
    alone = spread(walker, base, {8: edits[8]})
    both = spread(walker, base, edits)
    assert np.array_equal(alone.vertices[8], both.vertices[8])
    size = walker.walk.body.diagonal
    step = np.linalg.norm(both.vertices[9, free_vertices[1]] - both.vertices[8, free_vertices[1]]) / size
    true = np.linalg.norm(walker.place(9, free_vertices[1]) - walker.place(8, free_vertices[1])) / size
    assert step < true + 0.01


@pytest.mark.slow
def test_second_pass_follows_the_motion_gradient_of_the_first(
    walker: Walker, base: Base, edits: Edits, free_vertices: list[int]
) -> None:
    """An unpaired control vertex's track is its track in pass 1 plus the correction between its two boundary values."""
    first = spread(walker, base, edits, two_pass=False)
    both = spread(walker, base, edits, smooth=False)
    plain = spread(walker, base, edits, two_pass=False, smooth=False)
    assert first.vertices.shape == both.vertices.shape
    frame, vertex = 12, free_vertices[0]
    keys = base.keys.vertices.tolist()
    nearest = int(np.argmin(((base.rest[keys] - base.rest[vertex]) ** 2).sum(axis=1)))
    from imitation.motion.transfer import swing_clock

    share = span_share(8, 16, smooth=False, clock=swing_clock(base.keys.planted[:, nearest]))[frame - 8]
    modes = typical_modes(base, walker.deformer, [])
    asked = {end: FrameConstraints(
        {v: edits[end][v] for v in keys}, softness=dict(zip(keys, base.softness[end].tolist(), strict=True)),
    ) for end in (8, 16)}  # fmt: skip
    ends = [
        walker.deformer.solve_pose(asked[end], start=base.vertices[end], modes=modes).vertices[vertex]
        for end in (8, 16)
    ]
    offset = (1 - share) * (edits[8][vertex] - ends[0]) + share * (edits[16][vertex] - ends[1])
    np.testing.assert_allclose(both.vertices[frame, vertex], plain.vertices[frame, vertex] + offset, atol=1e-9)


def test_a_control_vertex_that_follows_a_track_takes_its_motion(
    walker: Walker, base: Base, free_vertices: list[int]
) -> None:
    """Told to follow a track, a vertex moves as that key point does, from where the user put it."""
    name, vertex = base.keys.names[0], free_vertices[0]
    committed = {12: commit_edit(base, 12, {vertex: walker.place(12, vertex)}, deformer=walker.deformer)}
    result = spread(walker, base, committed, follow={vertex: name})
    track = base.lifted[:, base.keys.names.index(name)]
    expected = track[13:] - track[12] + walker.place(12, vertex)
    np.testing.assert_allclose(result.vertices[13:, vertex], expected, atol=1e-9)


@pytest.mark.slow
def test_a_committed_pose_is_kept_until_its_own_frame_is_edited(walker: Walker, base: Base, edits: Edits) -> None:
    """Edits elsewhere leave an edited frame's bits alone."""
    alone = spread(walker, base, {16: edits[16]})
    for others in ({8: edits[8]}, {24: edits[24]}, {8: edits[8], 24: edits[24]}):
        assert np.array_equal(spread(walker, base, {16: edits[16], **others}).vertices[16], alone.vertices[16])
    pose = edited_pose(base, 16, edits[16], deformer=walker.deformer)
    assert np.array_equal(pose, alone.vertices[16])


def test_an_edit_reaches_its_neighbours_and_no_further(walker: Walker, base: Base, edits: Edits) -> None:
    """Changing the edit in frame 16 leaves the frames outside 8..24 bit-identical; only the inside is recomputed."""
    before = spread(walker, base, edits)
    changed = edits | {16: commit_edit(base, 16, {}, pose=before.vertices[16], deformer=walker.deformer)}
    seen: list[int] = []
    after = spread(walker, base, changed, previous=before, on_frame=lambda frame, _: seen.append(frame), origin=16)
    assert np.array_equal(after.vertices[:9], before.vertices[:9])
    assert np.array_equal(after.vertices[24:], before.vertices[24:])
    assert sorted(seen) == list(range(9, 24))
    assert not np.array_equal(after.vertices[12], before.vertices[12])
    assert np.array_equal(after.vertices, spread(walker, base, changed).vertices)


def test_after_the_last_edit_the_correction_is_held(walker: Walker, base: Base, edits: Edits) -> None:
    """Eq. 5 keeps the offset to the end: the key points of the last frames are the base's, shifted."""
    result = spread(walker, base, {16: edits[16]})
    free = ~base.keys.planted[16:].any(axis=0)
    offset = result.key_points[17:, free] - base.lifted[17:, free]
    given = np.stack([edits[16][int(v)] for v in base.keys.vertices])[free] - base.lifted[16, free]
    assert np.abs(offset - given).max() / walker.walk.body.diagonal < 0.01


def test_an_end_frame_lets_the_correction_fade(walker: Walker, base: Base, edits: Edits) -> None:
    """From the end frame on the base solution's bits stand."""
    result = spread(walker, base, {8: edits[8]}, end=20)
    assert np.array_equal(result.vertices[20:], base.vertices[20:])
    assert not np.array_equal(result.vertices[19], base.vertices[19])


@pytest.mark.slow
def test_a_reach_narrows_an_edit(walker: Walker, base: Base, edits: Edits) -> None:
    """Outside the in and out frames nothing changes, inside it does."""
    result = spread(walker, base, edits, reach={16: (12, 20)})
    without = spread(walker, base, {frame: edits[frame] for frame in (8, 24)}, reach={8: (None, 12), 24: (20, None)})
    assert np.array_equal(result.vertices[12], base.vertices[12])
    assert np.array_equal(result.vertices[:9], without.vertices[:9])
    assert np.array_equal(result.vertices[25:], without.vertices[25:])
    assert not np.array_equal(result.vertices[14], base.vertices[14])


@pytest.mark.slow
def test_order_does_not_matter_and_deletion_is_as_if_never_made(walker: Walker, base: Base, edits: Edits) -> None:
    """The result is a function of the set of edits: other orders and a detour over more edits give the same bits."""
    straight = spread(walker, base, edits)
    backwards = spread(walker, base, dict(reversed(edits.items())))
    assert np.array_equal(straight.vertices, backwards.vertices)
    few = spread(walker, base, {8: edits[8]})
    more = spread(walker, base, {8: edits[8], 24: edits[24]}, previous=few)
    deleted = spread(walker, base, {8: edits[8]}, previous=more)
    assert np.array_equal(deleted.vertices, few.vertices)
    assert np.array_equal(spread(walker, base, {}, previous=more).vertices, base.vertices)


def test_corrections_do_not_drag_planted_feet(walker: Walker, base: Base, edits: Edits) -> None:
    """A foot that is planted over several frames stands as still after the edits as before."""
    aside = np.array([0.0, 0.05, 0.0])
    result = spread(walker, base, {16: {vertex: place + aside for vertex, place in edits[16].items()}})
    still = base.keys.planted[1:] & base.keys.planted[:-1]
    # A foot that never leaves the ground between two edited frames has to be moved in one of them.
    still &= ~base.keys.planted[:17].all(axis=0)
    assert still.sum() > 10
    travel = np.linalg.norm(np.diff(result.key_points, axis=0), axis=2)[still] / walker.walk.body.diagonal
    assert travel.mean() < 2e-4


def test_linear_corrections_jump_in_velocity_and_cubic_ones_do_not(walker: Walker, base: Base) -> None:
    """The default correction has no kink at the edited frame."""
    free = int(np.flatnonzero(~base.keys.planted.any(axis=0))[0])
    shift = np.array([0.0, 0.0, 0.1 * walker.walk.body.diagonal])
    committed = {16: {int(v): base.lifted[16, k] + shift for k, v in enumerate(base.keys.vertices)}}
    kinks = {}
    for smooth in (False, True):
        result = spread(walker, base, committed, smooth=smooth, end=30)
        kinks[smooth] = np.abs(np.diff(result.key_points[:, free] - base.key_points[:, free], 2, axis=0))[15].max()
    assert kinks[True] < 0.4 * kinks[False]


def test_frames_stream_outward_from_the_edited_one(walker: Walker, base: Base, edits: Edits) -> None:
    """on_frame gets the edited frame first, then t + 1, t - 1, t + 2, ..."""
    seen: list[int] = []
    spread(walker, base, {16: edits[16]}, end=22, on_frame=lambda frame, _: seen.append(frame))
    assert seen[:7] == [16, 17, 15, 18, 14, 19, 13]
    assert sorted(seen) == list(range(1, 22))


def test_frames_between_two_edits_come_from_both_sides(walker: Walker, base: Base, edits: Edits) -> None:
    """Every frame comes once; up to the middle outward from the origin, beyond it from the other edit inward."""
    seen: list[int] = []
    two = {8: edits[8], 16: edits[16]}
    whole = spread(walker, base, two, origin=8, on_frame=lambda frame, _: seen.append(frame))
    assert seen[:2] == [8, 16]
    assert sorted(seen) == list(range(1, 31))
    between = [frame for frame in seen[2:] if 8 < frame < 16]
    assert between == [9, 10, 11, 15, 14, 13, 12]
    for origin in (16, 30):
        assert np.array_equal(spread(walker, base, two, origin=origin).vertices, whole.vertices)


def test_a_cancel_is_heard_before_the_first_frame(walker: Walker, base: Base, edits: Edits) -> None:
    """Also while slow directions are looked for, which takes as long as many frames."""
    calls, limit = 0, 40

    def stop(fraction: float) -> None:
        nonlocal calls
        calls += 1
        if calls == limit:
            raise Cancelled

    with pytest.raises(Cancelled):
        propagate(base, edits, deformer=Deformer(base.rest, base.faces), progress=stop)
    assert calls == limit, "nothing may go on after a cancel"


def test_streamed_frames_are_the_result(walker: Walker, base: Base, edits: Edits) -> None:
    """What was streamed is what is returned."""
    seen: dict[int, np.ndarray] = {}
    result = spread(walker, base, edits, on_frame=lambda frame, vertices: seen.update({frame: vertices.copy()}))
    for frame, vertices in seen.items():
        assert np.array_equal(vertices, result.vertices[frame])


def test_dragged_vertices_bring_the_clip_nearer_to_the_truth(
    walker: Walker, base: Base, free_vertices: list[int]
) -> None:
    """Four free vertices dragged to their true places in three frames improve all frames, not only those."""
    committed = {
        frame: commit_edit(base, frame, {v: walker.place(frame, v) for v in free_vertices}, deformer=walker.deformer)
        for frame in (8, 16, 24)
    }
    result = spread(walker, base, committed)
    others = [frame for frame in range(1, 31) if frame not in committed]
    assert walker.error(result.vertices, others) < 0.95 * walker.error(base.vertices, others)


def test_edited_pose_stays_in_the_picture(walker: Walker, base: Base, edits: Edits) -> None:
    """Key points that gave way did so along their rays: the picture of all frames hardly changes."""
    result = spread(walker, base, edits)
    shift = project_points(base.cameras, result.key_points) - project_points(base.cameras, base.key_points)
    assert np.abs(shift).max() < 4.0
    assert np.isfinite(depths_of(base.cameras, result.key_points)).all()


@pytest.mark.parametrize(
    ("edit", "options", "words"),
    [
        ({40: {0: (0, 0, 0)}}, {}, "frame 40 is outside the clip"),
        ({4: {10**6: (0, 0, 0)}}, {}, "moves vertex 1000000"),
        ({4: {0: (0, np.nan, 0)}}, {}, "three finite numbers"),
        ({4: {0: (0, 0, 0)}}, {"reach": {4: (1, 99)}}, "ends in frame 99"),
        ({4: {0: (0, 0, 0)}}, {"end": 90}, "outside the clip"),
        ({4: {0: (0, 0, 0)}}, {"follow": {0: "nose of a stranger"}}, "no paired track"),
    ],
)
def test_bad_edits_are_named(walker: Walker, base: Base, edit: Edits, options: dict, words: str) -> None:
    """Each bad edit is one sentence that names it."""
    with pytest.raises(InputError, match=words):
        spread(walker, base, edit, **options)


def test_cancel_is_heard_at_once(walker: Walker, base: Base, edits: Edits) -> None:
    """A progress callback that cancels stops the work after the frame at hand."""
    calls = 0

    def stop(fraction: float) -> None:
        nonlocal calls
        calls += 1
        if fraction > 0.3:
            raise Cancelled

    with pytest.raises(Cancelled):
        spread(walker, base, edits, progress=stop)
    assert calls < 20
