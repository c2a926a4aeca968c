"""The motion graph for the eye: where its nodes stand, how much there is, and the path that another mu would give."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.performing import MotionName, above, motions
from app.model.document import Document
from app.model.performance import KeyMotion, Motion
from app.stages.performance.composing import node_of
from imitation.errors import InputError

Array = NDArray[np.float64]
NEAR, SPREAD, FARTHEST, APART = 2.0, 2.4, 7.0, 2.1
"""Node diameters: between the nearest motions, what the median cost adds, the most wanted, the least allowed."""
WIDE = np.array([1.2, 0.85])
"""The picture is wider than high."""
CROWD = 60
"""Above so many nodes each sequence stands in a group of its own."""


@attrs.frozen(eq=False)
class Tried:
    """What a graph of another size would give.

    Attributes
    ----------
    mu : float
    kept : (k, k) bool
        Transitions that are left.
    path : nodes from the first key motion to the last, empty where there is none. keys : positions of the keys in it.
    cost : the largest weight on the path.
    frames : its length.
    reason : one sentence on why there is no path; empty where there is one.
    """

    mu: float
    kept: NDArray[np.bool_]
    path: tuple[int, ...] = ()
    keys: tuple[int, ...] = ()
    cost: float = 0.0
    frames: int = 0
    reason: str = ""


@attrs.frozen
class Gap:
    """Two key motions with nothing between them.

    Attributes
    ----------
    start, goal : nodes. start_name, goal_name : their names.
    mu : a mu that connects them, None where none does. brings : names of the transitions that it brings back.
    """

    start: int
    goal: int
    start_name: str
    goal_name: str
    mu: float | None
    brings: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What is wrong, and what would help."""
        missing = f"No path from {self.start_name} to {self.goal_name}."
        if self.mu is None:
            return f"{missing} No mu connects them: allow a forbidden motion, or pick another key motion."
        return f"{missing} Smallest mu that connects them: {self.mu:.4g}."


@attrs.frozen
class Extent:
    """How large a graph is: motions, textons of all sequences, transitions kept, strongly connected parts."""

    nodes: int
    textons: int
    transitions: int
    parts: int


def tried(document: Document, graph: Any, mu: float) -> Tried:
    """Prune a graph anew and search the best path, any length; nothing of it is kept."""
    from tvmedit import Unreachable, compose

    made = graph.pruned(mu)
    kept = np.isfinite(made.weights)
    choice = document.performance
    if not choice.keys:
        return Tried(mu, kept)
    order = [sequence.id for sequence in document.sequences]
    try:
        nodes = [node_of(made, order, key.motion) for key in choice.keys]
        barred = {node_of(made, order, motion) for motion in choice.forbidden}
        times = {place: key.repeats for place, key in enumerate(choice.keys) if key.repeats > 1}
        best = compose(made, nodes, repeats=times, loop=choice.loop, forbidden=barred, align=False)
    except Unreachable as error:
        return Tried(mu, kept, reason=gap_of(error, motions(document, graph)).sentence)
    except InputError as error:
        return Tried(mu, kept, reason=str(error))
    return Tried(mu, kept, tuple(best.path), tuple(best.keys), float(best.cost), len(best))


def found(graph: Any, path: Any) -> Tried:
    """A path that was found already, to be shown like one that is tried."""
    kept = np.isfinite(graph.weights)
    return Tried(float(graph.mu), kept, tuple(path.path), tuple(path.keys), float(path.cost), len(path))


def gap_of(error: Any, named: list[MotionName]) -> Gap:
    """Say with names what an ``Unreachable`` says with numbers."""
    edges = tuple(f"{named[a].name} to {named[b].name}" for a, b in error.edges)
    mu = None if error.mu is None else above(error.mu)
    return Gap(error.start, error.goal, named[error.start].name, named[error.goal].name, mu, edges)


def trouble(document: Document, named: list[MotionName], error: BaseException | None) -> tuple[Gap | None, str]:
    """Say why there is no path, from what its search raised: between which motions, and one sentence."""
    choice = document.performance
    sentence = why_not(choice.keys, named, choice.forbidden) if named else ""
    if sentence or error is None:
        return None, sentence
    if not hasattr(error, "goal"):
        return None, str(error)
    gap = gap_of(error, named)
    return gap, gap.sentence


def why_not(keys: tuple[KeyMotion, ...], named: list[MotionName], forbidden: tuple[Motion, ...]) -> str:
    """Say with names why key motions cannot be composed whatever the graph; empty where nothing speaks against it."""
    nodes = [_motion_at(named, key.motion) for key in keys]
    barred = [each for motion in forbidden if (each := _motion_at(named, motion)) is not None]
    for place, (key, each) in enumerate(zip(keys, nodes, strict=True)):
        if each is None:
            return f"Key motion {place + 1} belongs to no motion any more: pick another one."
        if each in barred:
            return f"{each.name} is forbidden and a key motion: allow it, or remove it from the timeline."
        if not each.cyclic and (key.repeats > 1 or (place and nodes[place - 1] == each)):
            return f"{each.name} does not repeat, so it cannot be played twice in a row: put another motion between."
    return ""


def extent(graph: Any) -> Extent:
    """Count what a graph holds."""
    from scipy.sparse.csgraph import connected_components

    kept = np.isfinite(graph.weights)
    parts, _ = connected_components(kept, directed=True, connection="strong")
    textons = sum(len(cluster.textons) for each in graph.analyses for cluster in each.structure.clusters)
    return Extent(len(graph.nodes), textons, int(kept.sum()), int(parts))


def layout(complete: Array, groups: NDArray[np.int64]) -> Array:
    """Places (k, 2) for the nodes of a graph, in node diameters, y down: what follows cheaply stands near.

    Stress majorisation from a fixed start, so the same graph always looks the same, whatever mu is.

    Parameters
    ----------
    complete : (k, k) float64
        Weights before pruning.
    groups : (k,) int64
        The sequence of each node; large graphs keep sequences together.
    """
    count = len(complete)
    if count < 2:
        return np.zeros((count, 2))
    wanted = _wanted(complete, groups)
    places = _majorised(wanted, _start(wanted), rounds=80 if count <= 2 * CROWD else 30)
    places = _apart(_evened(_lying(places)) * WIDE)
    return np.asarray(places - places.mean(axis=0))


def _wanted(complete: Array, groups: NDArray[np.int64]) -> Array:
    both = np.minimum(complete, complete.T)
    known = both[np.isfinite(both)]
    middle = float(np.median(known)) if len(known) else 1.0
    filled = np.where(np.isfinite(both), both, 2 * middle)
    wanted = NEAR + SPREAD * np.minimum(filled / max(middle, 1e-12), (FARTHEST - NEAR) / SPREAD)
    if len(complete) > CROWD:
        # Room for a whole group: its nodes cover an area that grows with their number.
        room = 1.2 * np.sqrt(len(complete))
        wanted = np.where(groups[:, None] == groups, 0.6 * wanted, wanted + room)
    np.fill_diagonal(wanted, 0.0)
    return np.asarray(wanted)


def _start(wanted: Array) -> Array:
    """Classical scaling; signs fixed so that it does not depend on the solver."""
    count = len(wanted)
    centred = np.eye(count) - 1.0 / count
    values, vectors = np.linalg.eigh(-0.5 * centred @ wanted**2 @ centred)
    top = vectors[:, -2:][:, ::-1]
    top = top * np.sign(top[np.abs(top).argmax(axis=0), np.arange(top.shape[1])])
    places = top * np.sqrt(np.maximum(values[-2:][::-1], 1e-3))
    # Nodes at one place would never part.
    turn = np.arange(count) * 2.399963
    return np.asarray(places + 1e-2 * np.column_stack([np.cos(turn), np.sin(turn)]))


def _majorised(wanted: Array, places: Array, *, rounds: int) -> Array:
    count = len(wanted)
    off = ~np.eye(count, dtype=bool)
    share = np.zeros_like(wanted)
    share[off] = wanted[off] ** -2
    inverse = np.linalg.pinv(np.diag(share.sum(axis=1)) - share)
    for _ in range(rounds):
        gaps = np.linalg.norm(places[:, None] - places, axis=2)
        ratio = np.zeros_like(wanted)
        ratio[off] = share[off] * wanted[off] / np.maximum(gaps[off], 1e-9)
        places = inverse @ (np.diag(ratio.sum(axis=1)) - ratio) @ places
    return places


def _lying(places: Array) -> Array:
    """Turned so that the long side lies along x, for a picture that is wider than high."""
    centred = places - places.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    axes = axes * np.sign(axes[np.arange(len(axes)), np.abs(axes).argmax(axis=1)])[:, None]
    turned = centred @ axes.T
    return turned if turned.shape[1] == 2 else np.column_stack([turned, np.zeros(len(turned))])


def _evened(places: Array) -> Array:
    """Nearer to an even spread along both sides, so that many nodes share the room there is."""
    count = len(places)
    share = 0.55 * min(1.0, max(0.0, (count - 8) / 40))
    ranks = np.argsort(np.argsort(places, axis=0), axis=0) / (count - 1)
    even = places.min(axis=0) + ranks * np.ptp(places, axis=0)
    return np.asarray((1 - share) * places + share * even)


def _apart(places: Array, rounds: int = 200) -> Array:
    """Push nodes that overlap apart; names need more room below than beside."""
    places = places.copy()
    stretch = np.array([1.0, 0.92])
    for _ in range(rounds):
        between = (places[:, None] - places) * stretch
        gaps = np.linalg.norm(between, axis=2)
        np.fill_diagonal(gaps, np.inf)
        short = np.clip(APART - gaps, 0.0, None)
        if not short.any():
            break
        places += 0.5 * (between / np.maximum(gaps, 1e-9)[..., None] * short[..., None]).sum(axis=1) / stretch * 0.6
    return places


def _motion_at(named: list[MotionName], motion: Motion) -> MotionName | None:
    return next(
        (each for each in named if each.sequence == motion.sequence and each.first <= motion.frame <= each.last), None
    )
