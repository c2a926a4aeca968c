"""The paper's comparisons."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from imitation.errors import InputError
from imitation.propagation import Base, commit_edit, compare, propagate
from imitation.propagation.key_poses import interpolate_poses
from tests.imitation.propagation.conftest import Walker

Edits = dict[int, dict[int, np.ndarray]]


def test_key_poses_turn_a_rigid_motion_along_its_arc(walker: Walker) -> None:
    """Between a pose and the same turned by 80 degrees lies the same turned by a share of it, to rounding."""
    turn = Rotation.from_rotvec([0.0, 0.0, np.radians(80)])
    centre = walker.rest.mean(axis=0)
    poses = {2: walker.rest, 10: turn.apply(walker.rest - centre) + centre + [1.0, 0.0, 0.5]}
    made = interpolate_poses(walker.rest, walker.faces, poses, 13)
    half = Rotation.from_rotvec([0.0, 0.0, np.radians(40)]).apply(walker.rest - centre)
    np.testing.assert_allclose(made[6] - made[6].mean(axis=0), half - half.mean(axis=0), atol=1e-8)
    np.testing.assert_allclose(made[6].mean(axis=0), (poses[2].mean(axis=0) + poses[10].mean(axis=0)) / 2, atol=0.02)
    for frame, pose in ((0, 2), (1, 2), (2, 2), (10, 10), (12, 10)):
        assert np.array_equal(made[frame], poses[pose])


def test_every_variant_meets_the_edited_poses_it_should(walker: Walker, base: Base, edits: Edits) -> None:
    """Key poses and naive tracks pass through the edited poses of the full result."""
    full = propagate(base, edits, deformer=walker.deformer)
    for variant in ("naive_tracks", "key_poses"):
        made = compare(base, edits, variant, deformer=walker.deformer)
        for frame in edits:
            assert np.array_equal(made[frame], full.vertices[frame])


@pytest.mark.slow
def test_two_passes_beat_key_poses_and_naive_tracks(walker: Walker, base: Base) -> None:
    """From the same edited frames, with all key points put right, ours is nearer to the truth (Fig. 5, 12)."""
    committed = {
        frame: commit_edit(
            base, frame, {v: walker.place(frame, v) for v in walker.pairs.values()}, deformer=walker.deformer
        )
        for frame in (10, 20, 30)
    }
    ours = walker.error(propagate(base, committed, deformer=walker.deformer).vertices)
    for variant in ("key_poses", "naive_tracks"):
        assert ours < 0.8 * walker.error(compare(base, committed, variant, deformer=walker.deformer))


@pytest.mark.slow
def test_first_pass_ignores_control_vertices_between_edited_frames(walker: Walker, base: Base, edits: Edits) -> None:
    """Fig. 9: without the second pass the control vertex is where it was put in its frame only."""
    full = propagate(base, edits, deformer=walker.deformer)
    first = compare(base, edits, "first_pass", deformer=walker.deformer)
    assert np.array_equal(first[16], full.vertices[16])
    assert not np.array_equal(first[15], full.vertices[15])


def test_anchors_alone_lose_the_body(walker: Walker, base: Base) -> None:
    """Fig. 14: with the feet alone the mesh is further from the truth than with all tracks."""
    made = compare(base, {}, "anchors_only", deformer=walker.deformer)
    assert walker.error(made) > 1.5 * walker.error(base.vertices)


@pytest.mark.parametrize(
    ("variant", "words"),
    [("sideways", "no comparison"), ("key_poses", "at least one edited frame"), ("naive_tracks", "at least one")],
)
def test_comparisons_say_what_they_need(walker: Walker, base: Base, variant: str, words: str) -> None:
    """An unknown variant or missing edits are one sentence."""
    with pytest.raises(InputError, match=words):
        compare(base, {}, variant, deformer=walker.deformer)  # type: ignore[arg-type]
