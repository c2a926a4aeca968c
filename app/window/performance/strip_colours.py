"""Colours of motions: those of one sequence begin with the sequence's own, the same motion has the same one."""

from __future__ import annotations

from typing import Any

from app.window import theme
from app.window.performance.state import PerformanceState


def kind_colour(state: PerformanceState, sequence_id: str, kind: int) -> str:
    """The colour of a kind of motion of a sequence; the row repeats after eight."""
    order = [sequence.id for sequence in state.document.sequences]
    first = order.index(sequence_id) if sequence_id in order else 0
    cycle = theme.active().tracks
    return cycle[(first + kind) % len(cycle)]


def structure_of(state: PerformanceState, sequence_id: str) -> Any:
    """The motions of a sequence if they have been found for the document as it is, else None."""
    project = state.project
    if project is None or sequence_id not in [sequence.id for sequence in state.document.sequences]:
        return None
    return project.result(project.session.stages.structure(sequence_id))
