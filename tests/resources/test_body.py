"""Bodies of the sample world: closed surfaces with skins that let planted feet stand still."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import InputError
from resources.world import OTHER, make_body
from resources.world.body import body_of
from resources.world.skeleton import make_skeleton, two_links
from resources.world.surface import body_distance

KINDS = ["quadruped", "biped"]


def euler_number(vertices: np.ndarray, faces: np.ndarray) -> tuple[int, bool]:
    """Euler number of a mesh, and whether every edge has exactly two faces that run along it in opposite ways."""
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    closed = {tuple(edge) for edge in directed} == {(b, a) for a, b in directed}
    closed &= len(np.unique(directed, axis=0)) == len(directed)
    return len(vertices) - len(directed) // 2 + len(faces), closed


@pytest.mark.parametrize("kind", KINDS)
def test_a_body_is_closed_and_without_handles(kind: str) -> None:
    """Every edge joins two faces, Euler number 2, outward, about 2,500 vertices."""
    body = make_body(kind)
    number, closed = euler_number(body.vertices, body.faces)
    assert closed
    assert number == 2
    assert abs(len(body.vertices) - 2500) < 100
    a, b, c = (body.vertices[body.faces[:, i]] for i in range(3))
    assert np.sum(a * np.cross(b, c)) / 6 > 0.01, "the faces look inward"
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-7, "a face has no area"


@pytest.mark.parametrize("kind", KINDS)
def test_a_body_lies_on_its_capsules(kind: str) -> None:
    """The vertices are on the surface that the capsules make, to half a millimetre nearly everywhere."""
    body = make_body(kind)
    off = np.abs(body_distance(body.vertices, body.skeleton))
    assert np.quantile(off, 0.98) < 5e-4
    assert body.vertices[:, 2].min() > -1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_skins_are_smooth_shares_of_at_most_four_bones(kind: str) -> None:
    """Weights are shares that sum to 1; soles belong to their foot alone."""
    body = make_body(kind)
    assert body.weights.min() >= 0
    np.testing.assert_allclose(body.weights.sum(axis=1), 1, atol=1e-12)
    assert (body.weights > 0).sum(axis=1).max() <= 4
    names = list(body.skeleton.bones)
    for leg in body.skeleton.legs:
        for sole, _ in leg.soles:
            assert body.weights[body.key_vertices[sole], names.index(leg.foot)] == 1
    edges = np.concatenate([body.faces[:, [0, 1]], body.faces[:, [1, 2]]])
    jump = np.abs(body.weights[edges[:, 0]] - body.weights[edges[:, 1]]).max(axis=1)
    assert np.quantile(jump, 0.95) < 0.45, "the skin tears at a joint"


@pytest.mark.parametrize("kind", KINDS)
def test_sixteen_key_points_on_sixteen_vertices(kind: str) -> None:
    """The key points are 16 different vertices near their places, left ones mirrored by right ones."""
    body = make_body(kind)
    assert len(set(body.key_vertices.values())) == 16
    for name, vertex in body.key_vertices.items():
        assert np.linalg.norm(body.vertices[vertex] - body.skeleton.keys[name]) < 0.05, name
        if name.startswith("left"):
            mirrored = body.skeleton.keys[name.replace("left", "right")] * [1, -1, 1]
            np.testing.assert_allclose(mirrored, body.skeleton.keys[name], atol=1e-12)


def test_other_proportions_change_what_they_say() -> None:
    """Legs 0.88 lower the hips, trunk 1.12 lengthens the body, head 1.3 enlarges the head."""
    plain, other = make_skeleton("quadruped"), make_skeleton("quadruped", OTHER)
    assert other.keys["left hind hip"][2] < plain.keys["left hind hip"][2]
    length = [s.keys["left front hip"][0] - s.keys["left hind hip"][0] for s in (plain, other)]
    assert length[1] / length[0] == pytest.approx(1.12)
    heads = [s.keys["nose"][0] - s.bones["head"].head[0] for s in (plain, other)]
    assert heads[1] / heads[0] == pytest.approx(1.3)


def test_the_same_call_makes_the_same_bits() -> None:
    """Two bodies made apart are equal in every bit."""
    first, second = (body_of(make_skeleton("quadruped"), 600) for _ in range(2))
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.faces, second.faces)
    np.testing.assert_array_equal(first.weights, second.weights)


def test_an_unknown_kind_is_refused() -> None:
    """The message names what there is."""
    with pytest.raises(InputError, match=r"quadruped and biped"):
        make_skeleton("hexapod")  # type: ignore[arg-type]


def test_two_links_keep_their_lengths() -> None:
    """The knee is at the links' lengths from hip and ankle, on the side of the pole, wherever the ankle is in reach."""
    rng = np.random.default_rng(5)
    hip, ankle = rng.normal(size=(50, 3)), rng.normal(size=(50, 3))
    far = np.linalg.norm(ankle - hip, axis=1)
    upper, lower = far * 0.7, far * 0.6
    pole = rng.normal(size=(50, 3))
    knee = two_links(hip, ankle, upper, lower, pole)
    np.testing.assert_allclose(np.linalg.norm(knee - hip, axis=1), upper)
    np.testing.assert_allclose(np.linalg.norm(knee - ankle, axis=1), lower)
    chord = (ankle - hip) / far[:, None]
    bend = (knee - hip) - np.sum((knee - hip) * chord, axis=1)[:, None] * chord
    assert (np.sum(bend * pole, axis=1) > 0).all()
