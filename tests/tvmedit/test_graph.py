"""Database, transitions, pruning, composition and smooth output of a small performance."""

from __future__ import annotations

import itertools

import attrs
import numpy as np
import pytest

import tvmedit
from imitation import InputError
from resources.performer import Capture
from tvmedit.cuts import GroundMove, align_frames
from tvmedit.cuts.placement import joint_move
from tvmedit.features.measure import surface_samples
from tvmedit.graph.database import representative
from tvmedit.graph.pruning import prune_absolute, prune_printed


def test_eq_13_and_14_prune_against_the_mean_of_the_out_edges() -> None:
    """An edge of mu times the mean goes; of two nodes the only edge is its own mean."""
    weights = np.array([[np.inf, 1, 3], [2, np.inf, 2], [1, 5, np.inf]])
    kept = prune_printed(weights, 1.0)
    assert np.isfinite(kept).tolist() == [[False, True, False], [False, False, False], [True, False, False]]
    two = np.array([[np.inf, 1], [2, np.inf]])
    assert not np.isfinite(prune_printed(two, 1.0)).any()


@pytest.mark.parametrize("seed", range(8))
def test_absolute_pruning_keeps_all_reachable_by_the_least_bottleneck(seed: int) -> None:
    """Whatever the limit, every best path of the complete graph keeps its cost; nothing over the limit is unmarked."""
    weights = np.random.default_rng(seed).random((7, 7))
    np.fill_diagonal(weights, np.inf)
    kept, poor = prune_absolute(weights, 0.2)
    for a in range(7):
        for b in range(7):
            if a != b:
                full, thin = tvmedit.best_path(weights, a, b), tvmedit.best_path(kept, a, b)
                cost = max(weights[i, j] for i, j in itertools.pairwise(full))
                thin_cost = max(weights[i, j] for i, j in itertools.pairwise(thin))
                assert thin_cost == pytest.approx(max(cost, 0.0)) or thin_cost < 0.2
    assert (poor == (np.isfinite(kept) & (weights >= 0.2))).all()


def test_mu_prunes_live_and_monotonically(graph: tvmedit.MotionGraph) -> None:
    """More mu, more edges; the complete weights stay; back at the first mu, the same graph."""
    counts = [np.isfinite(graph.pruned(mu).weights).sum() for mu in (0.1, 0.9, 3.0)]
    assert counts == sorted(counts)
    assert np.array_equal(graph.pruned(0.1).pruned(0.9).weights, graph.weights)


def test_the_users_own_texton_is_taken(analysis: tvmedit.Analysis) -> None:
    """By its number in the cluster, or by its frames; one that is not there is an error."""
    cluster = analysis.structure.clusters[2]
    graph = tvmedit.motion_graph([analysis], textons={(0, 2): 1})
    assert (graph.nodes[2].first, graph.nodes[2].last) == cluster.textons[1]
    first, last = cluster.textons[0]
    assert len(tvmedit.motion_graph([analysis], textons=[(0, first, last)]).nodes) == 1
    with pytest.raises(InputError, match="no texton 99"):
        tvmedit.motion_graph([analysis], textons={(0, 0): 99})


def test_two_sequences_join_and_unlike_ones_are_refused(capture: Capture, analysis: tvmedit.Analysis) -> None:
    """Nodes of both; another rate or another unit is refused with what to do."""
    assert len(tvmedit.motion_graph([analysis, analysis]).nodes) == 6
    frames = [capture.mesh(k)[:2] for k in range(12)]
    with pytest.raises(InputError, match="frames a second"):
        tvmedit.motion_graph([analysis, tvmedit.analyse(frames, fps=30)])
    with pytest.raises(InputError, match="one unit"):
        tvmedit.motion_graph([analysis, tvmedit.analyse([(1000 * v, f) for v, f in frames], fps=15)])


def test_two_node_graphs_work_in_both_modes(analysis: tvmedit.Analysis) -> None:
    """As printed the only edge is pruned and the report says at which mu it comes back; by default it stays."""
    nodes = [(0, *analysis.structure.clusters[k].textons[0]) for k in (0, 1)]
    assert tvmedit.compose(tvmedit.motion_graph([analysis], textons=nodes), [0, 1], align=False).path == (0, 1)
    printed = tvmedit.motion_graph([analysis], textons=nodes, method="paper")
    with pytest.raises(tvmedit.Unreachable) as caught:
        tvmedit.compose(printed, [0, 1], align=False)
    assert caught.value.mu == pytest.approx(1.0)
    assert caught.value.edges == ((0, 1),)
    assert tvmedit.compose(printed.pruned(1.001), [0, 1], align=False).path == (0, 1)


def test_a_performance_plays_every_frame_and_cuts_where_it_says(graph: tvmedit.MotionGraph) -> None:
    """Frames follow each other everywhere but at the joints, and each motion is whole."""
    performance = tvmedit.compose(graph, [0, 2, 1], repeats={1: 2}, align=False)
    joints = {cut.position: cut for cut in performance.cuts}
    frames = performance.frames[:, 1]
    for position in range(1, len(performance)):
        if position in joints:
            assert (frames[position - 1], frames[position]) == (joints[position].leave, joints[position].enter)
        else:
            assert frames[position] == frames[position - 1] + 1
    for number in set(performance.path):
        node = graph.nodes[number]
        assert set(frames[performance.nodes == number]) == set(range(node.first, node.last + 1))
    assert [performance.path[k] for k in performance.keys] == [0, 2, 1]


def test_lengths_loops_and_alternatives(graph: tvmedit.MotionGraph) -> None:
    """A length is met or explained, a loop closes, alternatives come in order."""
    performance = tvmedit.compose(graph, [0, 2], length=200, align=False)
    assert len(performance) == 200 or performance.note
    loop = tvmedit.compose(graph, [0, 2], loop=True, align=False)
    assert loop.cuts[-1].kind == "loop"
    assert loop.cuts[-1].enter == loop.frames[0, 1]
    several = tvmedit.compose(graph, [0, 2], alternatives=1, align=False)
    assert several.cost <= min((other.cost for other in several.alternatives), default=np.inf)


def test_bad_wishes_are_refused(graph: tvmedit.MotionGraph) -> None:
    """No keys, unknown keys, forbidden keys, no length."""
    for keys, options in (
        ([], {}),
        ([99], {}),
        ([0], {"forbidden": [0]}),
        ([0], {"length": 0}),
        ([0], {"repeats": {5: 2}}),
    ):
        with pytest.raises(InputError):
            tvmedit.compose(graph, keys, align=False, **options)


def test_alignment_recovers_a_known_move(capture: Capture) -> None:
    """Two meshes of one pose, moved: yaw within a degree, the pelvis within 15 mm."""
    true = GroundMove(0.7, 1.2, -0.5)
    windows = [[surface_samples(*capture.mesh(40 + k, copy=c)[:2], 600) for k in (-1, 0, 1)] for c in (1, 2)]
    found = align_frames(windows[0], [true.apply(points) for points in windows[1]], yaw=0.9)
    pelvis = capture.joints[40, 0]
    assert abs(np.degrees(found.yaw - true.yaw)) < 1
    assert np.linalg.norm(found.apply(pelvis) - true.apply(pelvis)) < 0.015
    undone = GroundMove(-found.yaw, 0, 0).after(GroundMove(0, -found.x, -found.y)).after(found)
    assert (undone.yaw, undone.x, undone.y) == pytest.approx((0, 0, 0), abs=1e-9)


def test_a_placed_walk_walks_on(capture: Capture, graph: tvmedit.MotionGraph) -> None:
    """Three rounds of the walk travel three times as far as one, and no joint jumps."""
    walk = max(range(len(graph.nodes)), key=lambda k: graph.intensities[k])
    performance = tvmedit.compose(graph, [walk], repeats=[3])
    joints = np.array([performance.place(i, capture.joints[f]) for i, (_, f) in enumerate(performance.frames)])
    steps = np.linalg.norm(np.diff(joints, axis=0), axis=2).mean(axis=1)
    at = [cut.position - 1 for cut in performance.cuts]
    assert len(at) == 2
    assert steps[at].max() < 1.2 * np.delete(steps, at).max()
    seams = tvmedit.seam_scores(graph, performance)
    assert max(seam.score for seam in seams) < 1.2
    assert all(seam.before > seam.after for seam in seams)


def test_a_motion_that_ends_with_its_sequence_walks_on_too(
    capture: Capture, analysis: tvmedit.Analysis, graph: tvmedit.MotionGraph
) -> None:
    """Nothing follows its last frame: the body is carried on, not held, wherever in the walk the filming ends."""
    walk = analysis.structure.clusters[-1]
    period = round(walk.period)
    carried, held = [], []
    for last in range(walk.first + period, walk.last - 1):
        ended = attrs.evolve(
            analysis, headings=analysis.headings[: last + 1], centres=analysis.centres[: last + 1],
            samples=analysis.samples[: last + 1],
        )  # fmt: skip
        short = attrs.evolve(graph, analyses=(ended,))
        first = last + 1 - period
        move = joint_move(short, tvmedit.Cut(0, "wrap", len(graph.nodes) - 1, len(graph.nodes) - 1, last, first, 0.0))
        # What came next was filmed, though the analysis has not seen it.
        true = capture.joints[last + 1]
        carried.append(np.linalg.norm(move.apply(capture.joints[first]) - true, axis=1).mean())
        held.append(np.linalg.norm(capture.joints[last] - true, axis=1).mean())
    assert np.mean(carried) < 0.75 * np.mean(held)


def test_a_texton_that_something_follows_is_preferred(analysis: tvmedit.Analysis) -> None:
    """Of equal textons not the one that the sequence ends with; and a motion is not left after its last frame there."""
    count = 30
    atoms = np.zeros((count, count), np.float32)
    cluster = tvmedit.Cluster(0, count - 1, True, ((10, 19), (20, 29)), 10.0)
    atoms[20, 29], atoms[10, 20] = 0.1, 0.5
    assert representative(atoms, cluster, printed=False) == 0
    assert representative(atoms, attrs.evolve(cluster, textons=((20, 29),)), printed=False) == 0
    last = analysis.structure.clusters[-1].textons[-1]
    end = len(analysis) - 1
    nodes = [(0, end - (last[1] - last[0]), end), (0, *analysis.structure.clusters[0].textons[0])]
    graph = tvmedit.motion_graph([analysis], textons=nodes)
    if graph.nodes[0].cyclic:
        assert graph.transitions[0, 1, 0] < end


@pytest.mark.slow
def test_a_cut_is_blended_and_a_broken_one_refused(capture: Capture, graph: tvmedit.MotionGraph) -> None:
    """Frames in between lie between both clips with mixed colours; poses that cannot be joined are left as they are."""
    performance = tvmedit.compose(graph, [0, 1])
    cut = next(cut for cut in performance.cuts if cut.kind == "cut")
    blend = tvmedit.blend_cut(graph, performance, cut, lambda _, frame: capture.mesh(frame))
    assert len(blend.shapes) >= 3 or blend.reason
    for position, shape in blend.shapes.items():
        assert np.isfinite(shape.vertices).all()
        assert shape.colours is not None
        assert tvmedit.performance_shape(graph, performance, position, lambda _, f: capture.mesh(f), [blend]) is shape
    meshes = [capture.mesh(frame)[:2] for frame in (0, int(capture.boundaries[0]) - 15)]
    far = tvmedit.register(meshes[0], (meshes[1][0] + [0.9, 0, 0], meshes[1][1]), height=1.75, edge=0.024, iterations=8)
    assert far.reason


def test_a_cut_between_the_ends_of_two_sequences_is_refused(capture: Capture) -> None:
    """A motion played once to the end of its sequence, then one from the start of another: no blend."""
    frames = [capture.mesh(k)[:2] for k in range(24)]
    one, two = (tvmedit.analyse(part, fps=15) for part in (frames[:12], frames[12:]))
    graph = tvmedit.motion_graph([one, two], mu=1e6, textons=[(0, 0, 11), (1, 0, 11)])
    graph = attrs.evolve(graph, nodes=tuple(attrs.evolve(node, cyclic=False) for node in graph.nodes))
    ends = np.where(np.eye(2, dtype=bool)[..., None], -1, np.array([11, 0]))
    performance = tvmedit.compose(attrs.evolve(graph, transitions=ends), [0, 1])
    blend = tvmedit.blend_cut(graph, performance, performance.cuts[0], lambda s, f: frames[12 * s + f])
    assert blend.shapes == {}
    assert "share no frames" in blend.reason
    assert blend.step_after == blend.step_before > 0
