"""Walks: planted feet stand still in every bit, nothing sinks into the ground, nothing tears."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import InputError
from resources.world import Stairs, make_body, walk
from tests.support.scenes import walker

WALKS = [
    (kind, terrain, other)
    for kind in ("quadruped", "biped")
    for terrain in ("flat", "stairs")
    for other in (False, True)
]


@pytest.mark.parametrize(("kind", "terrain", "other"), WALKS)
def test_planted_feet_do_not_slide(kind: str, terrain: str, other: bool) -> None:
    """In a contact the sole's vertex is at the contact's place in every frame, to the last bits."""
    walked = walker(kind, terrain, other=other)
    assert walked.contacts
    for name, spans in walked.contacts.items():
        for first, last, place in spans:
            inside = walked.key_points[name][first : last + 1]
            np.testing.assert_allclose(inside, np.broadcast_to(place, inside.shape), atol=1e-15, rtol=0)


@pytest.mark.parametrize(("kind", "terrain", "other"), WALKS)
def test_contacts_are_all_the_frames_in_which_a_sole_stands(kind: str, terrain: str, other: bool) -> None:
    """Between contacts a sole moves in every frame; each sole has a contact in every cycle."""
    walked = walker(kind, terrain, other=other)
    for name in walked.contacts:
        planted = walked.planted(name)
        moves = np.linalg.norm(np.diff(walked.key_points[name], axis=0), axis=1)
        both = planted[1:] & planted[:-1]
        assert moves[both].max() < 1e-15
        assert moves[~both].min() > 1e-7
        assert 0.3 < planted.mean() < 0.85


@pytest.mark.parametrize(("kind", "terrain", "other"), WALKS)
def test_nothing_sinks_into_the_ground(kind: str, terrain: str, other: bool) -> None:
    """No vertex is under the ground in any frame (a shoe's tip dips 5 mm as it rolls), and planted soles are on it."""
    walked = walker(kind, terrain, other=other)
    above = walked.vertices[..., 2] - walked.terrain.height(walked.vertices[..., 0])
    assert above.min() > (-1e-3 if kind == "quadruped" else -6e-3)
    for spans in walked.contacts.values():
        for _, _, place in spans:
            assert abs(place[2] - walked.terrain.height(place[0])) < 2e-3


@pytest.mark.parametrize(("kind", "terrain", "other"), WALKS)
def test_bones_hang_together_and_the_skin_does_not_tear(kind: str, terrain: str, other: bool) -> None:
    """Both bones of a joint carry it to the same place, and edges keep about their length."""
    walked = walker(kind, terrain, other=other)
    body = walked.body
    names = list(body.skeleton.bones)
    for i, bone in enumerate(body.skeleton.bones.values()):
        if bone.parent is None:
            continue
        j = names.index(bone.parent)
        ends = [walked.rotations[:, k] @ bone.head + walked.translations[:, k] for k in (i, j)]
        np.testing.assert_allclose(*ends, atol=1e-12, err_msg=bone.name)
    identity = walked.rotations @ np.swapaxes(walked.rotations, -1, -2)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), atol=1e-12)
    edges = np.concatenate([body.faces[:, [0, 1]], body.faces[:, [1, 2]]])
    rest = np.linalg.norm(body.vertices[edges[:, 0]] - body.vertices[edges[:, 1]], axis=1)
    posed = np.linalg.norm(walked.vertices[::8, edges[:, 0]] - walked.vertices[::8, edges[:, 1]], axis=2)
    assert np.quantile(posed / rest, 0.995) < 1.6


@pytest.mark.parametrize("kind", ["quadruped", "biped"])
def test_other_bodies_step_into_the_same_footsteps(kind: str) -> None:
    """A body of other proportions plants its soles where the subject does, in the same frames."""
    first, second = walker(kind, "stairs"), walker(kind, "stairs", other=True)
    for name, spans in first.contacts.items():
        assert [s[:2] for s in spans] == [s[:2] for s in second.contacts[name]]
        for (_, _, a), (_, _, b) in zip(spans, second.contacts[name], strict=True):
            assert np.linalg.norm(a - b) < 0.04


def test_the_subject_climbs_the_stairs() -> None:
    """In 81 frames the hound goes up at least two steps, and its feet land on the treads' middles."""
    walked = walker("quadruped", "stairs")
    assert walked.centre[-1, 2] - walked.centre[0, 2] > 2 * walked.terrain.rise
    places = np.array([place for spans in walked.contacts.values() for *_, place in spans])
    assert np.abs(places[:, 0] - walked.terrain.middle(places[:, 0])).max() < 0.08
    assert len(np.unique(walked.terrain.step(places[:, 0]))) >= 4


def test_key_points_are_the_key_vertices() -> None:
    """The tracks are exactly those of the mesh."""
    walked = walker("biped", "flat")
    for name, track in walked.key_points.items():
        np.testing.assert_array_equal(track, walked.vertices[:, walked.body.key_vertices[name]])


def test_motion_is_smooth() -> None:
    """No joint jumps: the second difference stays below a few centimetres a frame and frame."""
    for kind in ("quadruped", "biped"):
        walked = walker(kind, "stairs")
        jolt = np.linalg.norm(np.diff(walked.vertices, 2, axis=0), axis=-1)
        assert jolt.max() < 0.1
        assert np.sqrt((jolt**2).mean()) < 0.012


def test_seeds_vary_the_walk_and_repeat_it() -> None:
    """The same seed gives the same bits, another one another walk."""
    body = make_body("quadruped")
    a, b, c = (walk(body, 12, "stairs", seed=seed).vertices for seed in (1, 1, 2))
    np.testing.assert_array_equal(a, b)
    assert np.abs(a - c).max() > 0.005


def test_bad_walks_are_refused() -> None:
    """No frames, and ground that is not known, are said in a sentence."""
    body = make_body("quadruped")
    with pytest.raises(InputError, match="at least one frame"):
        walk(body, 0)
    with pytest.raises(InputError, match="not over 'ice'"):
        walk(body, 5, "ice")


def test_stairs_rise_step_by_step() -> None:
    """Height and step agree, and the slope runs through the middles of the treads."""
    stairs = Stairs()
    middles = stairs.start + (np.arange(stairs.count - 2) + 1.5) * stairs.tread
    np.testing.assert_allclose(stairs.height(middles), stairs.rise * (np.arange(stairs.count - 2) + 2))
    np.testing.assert_allclose(stairs.middle(middles + 0.1), middles)
    assert np.abs(stairs.slope_height(middles) - stairs.height(middles)).max() < 0.03
    assert (Stairs(count=0).height(middles) == 0).all()
