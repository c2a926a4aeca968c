"""``motion_graph``: the database of several sequences, joined by transitions (paper B, section 6)."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.analysis import Analysis
from tvmedit.graph.database import Node, Textons, database
from tvmedit.graph.pruning import JUMP_SECONDS, printed_limits, prune_absolute, prune_printed
from tvmedit.graph.search import least_bottleneck, shortest_of_least_bottleneck
from tvmedit.graph.transitions import find_transitions
from tvmedit.graph.unreachable import Unreachable

Array = NDArray[np.float64]
GraphMethod = Literal["robust", "paper"]


@attrs.frozen(eq=False)
class MotionGraph:
    """Motions and the transitions between them.

    Attributes
    ----------
    nodes : tuple of Node
    weights : (k, k) float64
        Cost of the cut from row to column in frame steps of the motions (eq. 12; "robust": of the average motion); inf
        where pruned.
    transitions : (k, k, 2) int64
        Last frame played of the row's sequence and first frame played of the column's; -1 on the diagonal.
    complete : (k, k) float64
        The weights before pruning.
    distances : (k, k) float64
        Node distances (eq. 10).
    intensities : (k,) float64
        Motion intensities (eq. 11).
    poor : (k, k) bool
        Edges over the limit, kept because a motion would be out of reach without them.
    mu : float
    method : "robust" or "paper"
    limit : float
        "robust": edges of mu times this weight and more are pruned.
    analyses : tuple of Analysis
    fps : float
    """

    nodes: tuple[Node, ...]
    weights: Array
    transitions: NDArray[np.int64]
    complete: Array
    distances: Array
    intensities: Array
    poor: NDArray[np.bool_]
    mu: float
    method: GraphMethod
    limit: float
    analyses: tuple[Analysis, ...]
    fps: float

    def pruned(self, mu: float) -> MotionGraph:
        """Give the same graph with another mu: nothing is compared again."""
        weights, poor = _prune(self.complete, mu, self.method, self.limit)
        return attrs.evolve(self, weights=weights, poor=poor, mu=float(mu))

    def explain(self, start: int, goal: int, forbidden: Iterable[int] = ()) -> Unreachable:
        """Say why a motion is out of reach: the smallest mu that would reach it, and the edges it brings back."""
        barred = set(forbidden)
        if self.method == "paper":
            limits = np.maximum(printed_limits(self.complete), 1e-300)[:, None]
        else:
            limits = np.full((1, 1), max(self.limit, 1e-300))
        shares = self.complete / limits
        needed = least_bottleneck(shares, start, goal, barred)
        if not np.isfinite(needed):
            return Unreachable(start, goal)
        path = shortest_of_least_bottleneck(shares, start, goal, barred) or []
        steps = itertools.pairwise(path)
        brought = tuple((a, b) for a, b in steps if not np.isfinite(self.weights[a, b]))
        return Unreachable(start, goal, needed, brought)


def motion_graph(
    analyses: Sequence[Analysis],
    *,
    mu: float = 0.9,
    method: GraphMethod = "robust",
    textons: Textons | None = None,
    limit: float | None = None,
) -> MotionGraph:
    """Build the motion graph of one or more sequences (paper B, sections 5 and 6).

    Parameters
    ----------
    analyses : sequence of Analysis
        Of one performer: same frame rate, same unit.
    mu : float
        Size of the graph: more keeps more edges.
    method : "robust" or "paper"
        "paper": eq. 9 to 14, edges pruned against the mean of their node's. "robust": transitions by the successor
        rule with headings aligned, edges pruned at mu times ``limit``, but never so that a motion is out of reach.
    textons : mapping or sequence, optional
        {(sequence, cluster): number of the texton}: the user's own representatives; or the nodes themselves as
        (sequence, first, last).
    limit : float, optional
        "robust": weight at mu = 1, in frame steps of the motions; default: as far as the average one
        moves in 0.1 s.

    Returns
    -------
    MotionGraph

    Raises
    ------
    InputError
        No sequence, different frame rates, or units that cannot belong to one performer.
    """
    sequences = (analyses,) if isinstance(analyses, Analysis) else tuple(analyses)
    if not sequences:
        raise InputError("There is no sequence: give at least one analysis.")
    if method not in ("robust", "paper"):
        raise InputError(f'The method is {method!r}: say "robust" or "paper".')
    _check_alike(sequences)
    _check_mu(mu)
    fps = sequences[0].fps
    nodes = database(sequences, printed=method == "paper", textons=textons)
    if not nodes:
        raise InputError("The database is empty: choose at least one texton.")
    found = find_transitions(sequences, nodes, printed=method == "paper")
    complete = found.distances / _scale(found.intensities, method)
    np.fill_diagonal(complete, np.inf)
    edge = max(1.0, JUMP_SECONDS * fps) if limit is None else float(limit)
    weights, poor = _prune(complete, mu, method, edge)
    return MotionGraph(
        nodes=nodes,
        weights=weights,
        transitions=found.frames,
        complete=complete,
        distances=found.distances,
        intensities=found.intensities,
        poor=poor,
        mu=float(mu),
        method=method,
        limit=edge,
        analyses=sequences,
        fps=fps,
    )


def _prune(complete: Array, mu: float, method: GraphMethod, limit: float) -> tuple[Array, NDArray[np.bool_]]:
    _check_mu(mu)
    if method == "paper":
        return prune_printed(complete, mu), np.zeros(complete.shape, bool)
    return prune_absolute(complete, mu * limit)


def _scale(intensities: Array, method: GraphMethod) -> Array:
    """What node distances are measured in: eq. 12 takes the intensity of the motion that is left.

    Out of a wild motion into a calm one any jump would then be cheap, and a path that takes it jumps in the end;
    "robust" takes the mean of all motions, so that weights are in proportion to what the body jumps.
    """
    if method == "paper":
        return intensities[:, None]
    return np.full((1, 1), intensities.mean())


def _check_mu(mu: float) -> None:
    if not mu >= 0 or np.isnan(mu):
        raise InputError(f"mu is {mu}: give a number of 0 or more.")


def _check_alike(sequences: tuple[Analysis, ...]) -> None:
    first = sequences[0]
    for number, other in enumerate(sequences[1:], start=1):
        if abs(other.fps - first.fps) > 1e-6 * first.fps:
            raise InputError(
                f"Sequence {number} runs at {other.fps:g} frames a second and sequence 0 at {first.fps:g}: "
                "resample one of them first."
            )
        if not 1 / 1.5 < other.height / first.height < 1.5:
            raise InputError(
                f"The performer of sequence {number} is {other.height / first.height:.3g} times as tall as that of "
                "sequence 0: convert both to one unit."
            )
        if other.features.method != first.features.method:
            raise InputError(f"Sequence {number} was analysed by another method than sequence 0: use one for both.")
