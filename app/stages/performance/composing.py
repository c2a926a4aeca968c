"""Stages of the performance: the best paths, every clip in its place, in-betweens at cuts."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from app.model.document import Document
from app.model.performance import HardCut, Motion
from app.stages.context import Context
from app.stages.performance.database import NO_SEQUENCES, graph
from app.stages.performance.footage import FootageSource, needs_of, open_footage, source_of
from app.stages.performance.results import Assembled, Blended
from app.stages.stage import Stage
from imitation.errors import InputError
from imitation.progress import part

NO_KEYS = "Choose at least one key motion first."
OFFERED = 4
"""So many next best paths are found beside the best, to be a click away."""


def paths(document: Document) -> Stage:
    """The best path and the next best, as performances that are not placed yet, best first."""
    choice = document.performance
    keys = tuple((key.motion, key.repeats) for key in choice.keys)
    order = tuple(sequence.id for sequence in document.sequences)
    offered = max(OFFERED, choice.alternative)
    inputs = (order, keys, choice.forbidden, choice.length, choice.loop, offered)
    blocked = NO_SEQUENCES if not document.sequences else NO_KEYS if not choice.keys else None
    label = "Searching the best path"
    return Stage("paths", label, _paths, inputs, (graph(document),), blocked=blocked, stored=False, weight=0.02)


def assembled(document: Document) -> Stage:
    """The chosen path with every clip placed where the one before it ends, and how well that hides the joints."""
    choice = document.performance
    sources = tuple(source_of(document, sequence) for sequence in document.sequences)
    fronts = tuple(sequence.front for sequence in document.sequences)
    inputs = (choice.alternative, choice.align, choice.features, choice.height, fronts, sources)
    needs = (graph(document), paths(document))
    return Stage("performance", "Placing the clips", _assembled, inputs, needs, weight=2.0)


def blended(document: Document) -> Stage:
    """In-betweens at the cuts of the performance."""
    choice = document.performance
    sources = tuple(source_of(document, sequence) for sequence in document.sequences)
    needs = [needs_of(document, sequence) for sequence in document.sequences]
    order = tuple(sequence.id for sequence in document.sequences)
    counts = tuple(len(each) for each in needs)
    wanted = choice.blend and choice.align
    inputs = (order, sources, counts, wanted, choice.blend_seconds, choice.hard_cuts)
    stages = (graph(document), assembled(document), *itertools.chain.from_iterable(needs))
    return Stage("blends", "Blending the cuts", _blended, inputs, stages, version=4, weight=10.0)


def node_of(graph: Any, order: Sequence[str], motion: Motion) -> int:
    """Give the node of the motion that a frame belongs to."""
    if motion.sequence not in order:
        raise InputError("A key motion belongs to a sequence that is not there: choose another one.")
    number = order.index(motion.sequence)
    for k, node in enumerate(graph.nodes):
        if node.sequence != number:
            continue
        clusters = graph.analyses[number].structure.clusters
        span = clusters[node.cluster] if node.cluster >= 0 else node
        if span.first <= motion.frame <= span.last:
            return k
    raise InputError(f"Frame {motion.frame} belongs to no motion of its sequence: choose another one.")


def _paths(context: Context, inputs: tuple[Any, ...], made: Any) -> list[Any]:
    from tvmedit import compose

    order, keys, forbidden, length, loop, offered = inputs
    nodes = [node_of(made, order, motion) for motion, _ in keys]
    barred = {node_of(made, order, motion) for motion in forbidden}
    times = {place: count for place, (_, count) in enumerate(keys) if count > 1}
    context.progress(0.0)
    best = compose(
        made,
        nodes,
        length=length,
        alternatives=0 if length is not None else offered,
        repeats=times,
        loop=loop,
        forbidden=barred,
        align=False,
    )
    return [attrs.evolve(best, alternatives=()), *best.alternatives]


def _assembled(context: Context, inputs: tuple[Any, ...], made: Any, found: list[Any]) -> Assembled:
    from tvmedit import align_performance, seam_scores

    alternative, align, *known = inputs
    performance = found[min(alternative, len(found) - 1)]
    context.progress(0.0)
    if align:
        # Joints of an earlier path are met again in most edits.
        joints = context.media.memory.setdefault(("joints", repr(known)), {})
        performance = align_performance(made, performance, known=joints)
    context.progress(0.5)
    return Assembled(performance, tuple(seam_scores(made, performance)))


def _blended(context: Context, inputs: tuple[Any, ...], made: Any, placed: Assembled, *results: Any) -> Blended:
    from tvmedit.cuts.blending import LONGER, blend_window

    order, sources, counts, wanted, seconds, hard_cuts = inputs
    performance = placed.performance
    if not wanted or not performance.aligned:
        return Blended(())
    footages = _Meshes(context, sources, counts, results)
    cuts = [cut for cut in performance.cuts if cut.kind == "cut" and not _hard(cut, made, order, hard_cuts)]
    blends = []
    for number, cut in enumerate(cuts):
        context.progress(number / len(cuts))
        sequences = (made.nodes[cut.source].sequence, made.nodes[cut.target].sequence)
        # Which of the two is blended over is found out on the way; a neighbouring cut may bound either.
        window = tuple(blend_window(made, performance, cut, share * seconds) for share in (1.0, LONGER))
        move = _relative(performance, cut.position)
        key = ("blend", repr(sources), sequences, cut.leave, cut.enter, window, tuple(move.round(12)))
        kept = context.media.memory.get(key)
        if kept is None:
            report = part(context.progress, number / len(cuts), (number + 1) / len(cuts))
            kept = _blend_at_origin(made, performance, cut, move, footages, seconds, report)
            context.media.memory[key] = kept
        blends.append(_stood(kept, cut, performance))
        context.emit(blends[-1])
    return Blended(tuple(blends))


class _Meshes:
    """``mesh_of`` of the engine: (sequence, frame) to vertices, faces, colours."""

    def __init__(
        self, context: Context, sources: Sequence[FootageSource], counts: Sequence[int], results: tuple[Any, ...]
    ) -> None:
        starts = np.cumsum([0, *counts])
        self._open = [
            open_footage(context.media, source, results[starts[k] : starts[k] + counts[k]])
            for k, source in enumerate(sources)
        ]

    def __call__(self, sequence: int, frame: int) -> tuple[Any, Any, Any]:
        from app.formats.tvm import painted

        mesh = painted(self._open[sequence][frame])
        return mesh.vertices, mesh.faces, mesh.colours


def _hard(cut: Any, made: Any, order: Sequence[str], hard_cuts: Sequence[HardCut]) -> bool:
    leave = Motion(order[made.nodes[cut.source].sequence], cut.leave)
    enter = Motion(order[made.nodes[cut.target].sequence], cut.enter)
    return HardCut(leave, enter) in hard_cuts


def _relative(performance: Any, position: int) -> Any:
    """Move (3,) of the clip that is entered, seen from where the clip that is left stands."""
    before, after = performance.transforms[position - 1], performance.transforms[position]
    c, s = np.cos(-before[0]), np.sin(-before[0])
    x, y = after[1:] - before[1:]
    return np.array([after[0] - before[0], c * x - s * y, s * x + c * y])


def _blend_at_origin(
    made: Any, performance: Any, cut: Any, move: Any, footages: _Meshes, seconds: float, report: Any
) -> Any:
    """Blend with the clip that is left where it was filmed, so that the result serves wherever the cut is played."""
    from tvmedit import blend_cut

    transforms = np.zeros_like(performance.transforms)
    transforms[cut.position :] = move
    local = attrs.evolve(performance, transforms=transforms)
    return blend_cut(made, local, cut, footages, seconds=seconds, progress=report)


def _stood(blend: Any, cut: Any, performance: Any) -> Any:
    """The blend where the clip that is left stands in this performance, at this cut's position."""
    shift = cut.position - blend.cut.position
    shapes = {
        position + shift: attrs.evolve(shape, vertices=performance.place(cut.position - 1, shape.vertices))
        for position, shape in blend.shapes.items()
    }
    residuals = {position + shift: value for position, value in blend.residuals.items()}
    return attrs.evolve(blend, cut=cut, shapes=shapes, residuals=residuals)
