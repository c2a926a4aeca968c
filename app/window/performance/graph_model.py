"""What the canvas shows, from the graph, the path, the choices of the user and what is being tried."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from app.window.performance.graph_view import EdgeMark, GroupMark, NodeMark, Picture

if TYPE_CHECKING:
    from app.actions.performing_graph import Tried
    from app.window.performance.state import PerformanceState

CROWD, TANGLE = 60, 180
"""Above so many motions they stand in groups; above so many transitions only the chosen motion's are drawn fully."""
FAINT = 200
"""So many pruned transitions are shown at most while the graph's size is dragged."""
Places = Mapping[int, tuple[float, float]]


def picture_of(
    state: PerformanceState, places: Places, *, tried: Tried | None = None, typed: str = "", node: int = -1
) -> Picture:
    """All motions of visible sequences with the transitions between them; those that a filter leaves out are dim."""
    graph = state.graph
    if graph is None or not places:
        return Picture()
    kept = tried.kept if tried is not None else np.isfinite(graph.weights)
    path = _path(state, tried)
    nodes = _nodes(state, places, set(path), typed)
    shown = {mark.node for mark in nodes}
    edges = _edges(graph, kept, shown, path, loop=state.document.performance.loop, faint=_other_size(state, tried))
    crowded = len(nodes) > CROWD or sum(edge.kind == "kept" for edge in edges) > TANGLE
    return Picture(nodes, edges, _groups(state, nodes) if len(nodes) > CROWD else (), crowded)


def _other_size(state: PerformanceState, tried: Tried | None) -> bool:
    """Whether another size is tried, so that what is pruned is of interest."""
    return tried is not None and tried.mu != state.document.performance.mu


def _path(state: PerformanceState, tried: Tried | None) -> tuple[int, ...]:
    if tried is not None:
        return tried.path
    performance = state.performance
    if performance is None or not state.fresh:
        return ()
    # A path found before the sequences were cut anew may name motions that are gone.
    return tuple(performance.path) if max(performance.path) < len(state.motions) else ()


def _nodes(state: PerformanceState, places: Places, on_path: set[int], typed: str) -> tuple[NodeMark, ...]:
    document = state.document
    visible = {sequence.id for sequence in document.sequences if sequence.visible}
    badges: dict[int, list[int]] = {}
    for number, key in enumerate(document.performance.keys, start=1):
        badges.setdefault(state.motion_node(key.motion), []).append(number)
    forbidden = {state.motion_node(motion) for motion in document.performance.forbidden}
    words = typed.lower().split()
    marks = []
    for motion in state.motions:
        if motion.sequence not in visible or motion.node not in places:
            continue
        x, y = places[motion.node]
        marks.append(
            NodeMark(
                node=motion.node,
                x=x,
                y=y,
                name=motion.name,
                colour=state.colour(motion.sequence),
                sequence=motion.sequence,
                badges=tuple(badges.get(motion.node, ())),
                forbidden=motion.node in forbidden,
                on_path=motion.node in on_path,
                dim=not all(word in motion.name.lower() for word in words),
            )
        )
    return tuple(marks)


def _edges(
    graph: Any, kept: NDArray[np.bool_], shown: set[int], path: tuple[int, ...], *, loop: bool, faint: bool
) -> tuple[EdgeMark, ...]:
    steps = set(itertools.pairwise(path))
    if loop and len(path) > 1:
        steps.add((path[-1], path[0]))
    finite = np.isfinite(graph.complete)
    seen = np.zeros(len(kept), bool)
    seen[list(shown)] = True
    inside = seen[:, None] & seen
    marks = _marks(graph, kept & inside, steps, "kept")
    return marks + _marks(graph, ~kept & finite & inside, set(), "faint", FAINT) if faint else marks


def _marks(
    graph: Any, chosen: NDArray[np.bool_], steps: set[tuple[int, int]], kind: str, most: int | None = None
) -> tuple[EdgeMark, ...]:
    """Transitions by cost, the cheapest first; those of the path are told apart."""
    pairs = np.argwhere(chosen)
    costs = graph.complete[chosen]
    order = np.argsort(costs, kind="stable")[:most]
    dear = max(float(costs.max(initial=0.0)), 1e-9)
    rows = zip(pairs[order].tolist(), costs[order].tolist(), graph.poor[chosen][order].tolist(), strict=True)
    return tuple(
        EdgeMark(start, goal, cost, max(0.0, 1.0 - cost / dear), "path" if (start, goal) in steps else kind, poor)
        for (start, goal), cost, poor in rows
    )


def _groups(state: PerformanceState, nodes: tuple[NodeMark, ...]) -> tuple[GroupMark, ...]:
    marks = []
    for sequence in state.document.sequences:
        own = [(mark.x, mark.y) for mark in nodes if mark.sequence == sequence.id]
        if own:
            low, high = np.min(own, axis=0), np.max(own, axis=0)
            middle, half = (low + high) / 2, (high - low) / 2
            marks.append(GroupMark(sequence.name, state.colour(sequence.id), *middle.tolist(), *half.tolist()))
    return tuple(marks)


def told(state: PerformanceState, start: int, goal: int) -> str:
    """What a node, or a transition, is: for a tooltip."""
    graph = state.graph
    if graph is None or not max(start, goal) < len(state.motions):
        return ""
    motion = state.motions[start]
    if goal < 0:
        first, last = motion.texton
        kind = f"repeats every {motion.period:.0f} frames" if motion.cyclic else "is played once"
        return f"{motion.name}: {kind}; frames {first} to {last} are kept of {motion.first} to {motion.last}"
    leave, enter = graph.transitions[start, goal]
    cost = f"cost {graph.complete[start, goal]:.2f}"
    poor = "; the poses are far apart, but nothing nearer leads there" if graph.poor[start, goal] else ""
    return f"{motion.name} to {state.motions[goal].name}: {cost}, leaves at frame {leave}, enters at {enter}{poor}"
