"""Stages of the motion database and its graph."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from app.model.document import Document
from app.model.performance import CapturedSequence
from app.stages.context import Context
from app.stages.performance.sequences import analysis
from app.stages.stage import Stage
from imitation.errors import InputError

NO_SEQUENCES = "Add a sequence of meshes first."


def database(document: Document) -> Stage:
    """Nodes, transitions and weights before pruning, without the analyses they are made of."""
    choice = document.performance
    needs = tuple(analysis(document, sequence) for sequence in document.sequences)
    chosen = tuple(sequence.representatives for sequence in document.sequences)
    inputs = (choice.graph, chosen)
    blocked = _why_not(document.sequences)
    return Stage("database", "Finding transitions", _database, inputs, needs, version=3, blocked=blocked, weight=1.0)


def graph(document: Document) -> Stage:
    """The motion graph at the user's mu: nothing is compared again when it changes."""
    needs = (database(document), *(analysis(document, sequence) for sequence in document.sequences))
    inputs = (document.performance.mu,)
    return Stage("graph", "Pruning the motion graph", _graph, inputs, needs, stored=False, weight=0.01)


def _database(context: Context, inputs: tuple[Any, ...], *analyses: Any) -> Any:
    from tvmedit import motion_graph

    method, chosen = inputs
    _check_sizes(analyses)
    textons: dict[tuple[int, int], int] = {}
    for number, frames in enumerate(chosen):
        for frame in frames:
            for k, cluster in enumerate(analyses[number].structure.clusters):
                for place, (first, last) in enumerate(cluster.textons):
                    # Of two choices for one cluster the later frame counts; a frame outside all textons none.
                    if first <= frame <= last:
                        textons[number, k] = place
    context.progress(0.0)
    made = motion_graph(analyses, method=method, textons=textons or None)
    context.progress(1.0)
    return attrs.evolve(made, analyses=())


def _graph(context: Context, inputs: tuple[float], made: Any, *analyses: Any) -> Any:
    (mu,) = inputs
    return attrs.evolve(made, analyses=tuple(analyses)).pruned(mu)


def _why_not(sequences: Sequence[CapturedSequence]) -> str | None:
    """What is missing before sequences can be one database."""
    if not sequences:
        return NO_SEQUENCES
    first = sequences[0]
    for other in sequences[1:]:
        if abs(other.fps - first.fps) > 1e-6 * first.fps:
            return (
                f"{other.name} is played at {other.fps:g} frames a second and {first.name} at {first.fps:g}: "
                f"set the rate of {other.name} to {first.fps:g}."
            )
    return None


def _check_sizes(analyses: Sequence[Any]) -> None:
    """A wrong unit makes a performer ten or a hundred times as tall; no posture makes one three times so."""
    spans = [float(np.ptp(each.samples[:, :, 2])) for each in analyses]
    for number, span in enumerate(spans[1:], start=2):
        ratio = span / max(spans[0], 1e-12)
        if not 1 / 3 < ratio < 3:
            raise InputError(
                f"Sequence {number} is {ratio:.3g} times as tall as sequence 1: say in which unit its files are, or "
                "leave it out."
            )
