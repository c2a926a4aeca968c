"""The motion graph for the eye: its layout, another mu tried, what is out of reach in words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import attrs
import numpy as np
import pytest

from app.actions import performing
from app.actions.performing_cutouts import cutout
from app.actions.performing_graph import extent, gap_of, layout, tried, trouble, why_not
from app.actions.session import Session
from app.model.edits import performance as edits
from app.model.performance import KeyMotion
from tests.app.captured import write_capture
from tvmedit import Unreachable


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """A take of several motions with its graph."""
    folder: Path = tmp_path_factory.mktemp("graph")
    session = Session.new(folder / "graph")
    performing.add_sequence(session, write_capture(folder / "take.npz"), name="take")
    session.result(session.stages.graph)
    yield session
    session.close()


def random_weights(count: int, seed: int) -> np.ndarray:
    """Costs (count, count) that are distances in space."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    weights = np.linalg.norm(points[:, None] - points, axis=2)
    np.fill_diagonal(weights, np.inf)
    return weights


@pytest.mark.parametrize("count", [2, 3, 9, 40, 90])
def test_a_layout_shows_every_node(count: int) -> None:
    """Always the same for the same graph, and no node covers another."""
    weights, groups = random_weights(count, count), np.arange(count) % 3
    places = layout(weights, groups)
    assert np.array_equal(places, layout(weights, groups))
    gaps = np.linalg.norm(places[:, None] - places, axis=2) + 10 * np.eye(count)
    assert gaps.min() > 1.5
    assert np.abs(places.mean(axis=0)).max() < 1e-9


def test_a_layout_is_no_worse_than_the_start() -> None:
    """What follows cheaply stands nearer than what does not: ranks of costs and distances go together."""
    weights = random_weights(20, 5)
    places = layout(weights, np.zeros(20, int))
    gaps = np.linalg.norm(places[:, None] - places, axis=2)
    pairs = np.triu_indices(20, 1)
    ranks = [np.argsort(np.argsort(values[pairs])) for values in (weights, gaps)]
    assert np.corrcoef(*ranks)[0, 1] > 0.6


def test_layouts_of_graphs_that_are_hardly_there() -> None:
    """No node, one node, nodes without a transition."""
    assert layout(np.zeros((0, 0)), np.zeros(0, int)).shape == (0, 2)
    assert layout(np.full((1, 1), np.inf), np.zeros(1, int)).tolist() == [[0.0, 0.0]]
    alone = layout(np.full((4, 4), np.inf), np.zeros(4, int))
    assert np.isfinite(alone).all()


def test_what_is_tried_is_what_the_stage_gives(session: Session) -> None:
    """Path, cost and length of the same mu, and nothing of it in the document."""
    graph = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    before = session.document
    keys = [KeyMotion(named[0].motion), KeyMotion(named[1].motion, 2)]
    document = edits.set_mu(edits.set_keys(before, keys).document, 0.7).document
    found = tried(document, graph, 0.7)
    from app.stages.project import Stages

    best = session.result(Stages(document).paths)[0]
    assert found.path == tuple(best.path)
    assert (found.cost, found.frames) == (best.cost, len(best))
    assert session.document is before
    assert tried(before, graph, 0.7).path == ()


def test_out_of_reach_in_words(session: Session) -> None:
    """Names, the smallest mu and what it brings back; a mu that is offered connects."""
    graph = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    apart = attrs.evolve(graph, weights=np.full_like(graph.weights, np.inf))
    gap = gap_of(apart.explain(0, 1), named)
    assert named[0].name in gap.sentence
    assert named[1].name in gap.sentence
    assert f"{gap.mu:.4g}" in gap.sentence
    assert gap.brings
    assert np.isfinite(graph.pruned(gap.mu).weights[0]).any()
    never = gap_of(Unreachable(0, 1), named)
    assert never.mu is None
    assert "No mu" in never.sentence
    document = edits.set_keys(session.document, [KeyMotion(named[0].motion)]).document
    assert trouble(document, named, Unreachable(0, 1, 1.2, ((0, 1),)))[0] is not None
    assert trouble(document, named, None) == (None, "")


def test_keys_that_cannot_be_composed_are_named(session: Session) -> None:
    """A forbidden key motion, one that does not repeat, one whose frames are gone."""
    graph = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    once = [attrs.evolve(named[0], cyclic=False), *named[1:]]
    key = KeyMotion(named[0].motion)
    assert why_not((key,), named, ()) == ""
    assert "forbidden" in why_not((key,), named, (named[0].motion,))
    assert "does not repeat" in why_not((key, key), once, ())
    assert "does not repeat" in why_not((attrs.evolve(key, repeats=2),), once, ())
    assert "pick another" in why_not((KeyMotion(attrs.evolve(named[0].motion, frame=10_000)),), named, ())


def test_the_extent_counts(session: Session) -> None:
    """Nodes, transitions and connected parts."""
    graph = session.result(session.stages.graph)
    found = extent(graph)
    assert found.nodes == len(graph.nodes)
    assert found.transitions == int(np.isfinite(graph.weights).sum())
    assert found.parts == 1
    assert extent(attrs.evolve(graph, weights=np.full_like(graph.weights, np.inf))).parts == found.nodes


def test_a_cutout_fills_its_picture(session: Session) -> None:
    """The performer from head to foot, nothing behind."""
    picture = cutout(session, session.document.sequences[0].id, 10, size=96)
    assert picture.shape == (96, 96, 4)
    rows = np.flatnonzero(picture[..., 3].max(axis=1) > 128)
    assert rows[0] <= 10
    assert rows[-1] >= 85
    assert picture[0, 0, 3] == 0
    assert (picture[..., 3] > 128).mean() < 0.5
