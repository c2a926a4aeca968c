"""From a way through the graph to the frames that are played."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from imitation.errors import InputError
from tvmedit.graph.dwell import dwell_frames, least_dwell
from tvmedit.graph.lengths import Stop
from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.performance import Cut, Performance
from tvmedit.graph.ways import Way


def stops_of(graph: MotionGraph, way: Way, times: Sequence[int], *, loop: bool) -> list[Stop]:
    """How long each motion of a way is played: every frame at least once, key motions as often as asked."""
    path, positions = way
    repeats = dict(zip(positions, times, strict=False))
    stops = []
    for k, node in enumerate(path):
        motion = graph.nodes[node]
        before = path[k - 1] if k or (loop and len(path) > 1) else None
        after = path[k + 1] if k + 1 < len(path) else path[0] if loop and len(path) > 1 else None
        entry = motion.first if before is None else int(graph.transitions[before, node, 1])
        leave = motion.last if after is None else int(graph.transitions[node, after, 0])
        count = least_dwell(motion, entry, leave) if motion.cyclic else len(motion)
        stops.append(Stop(node, entry, count + (repeats.get(k, 1) - 1) * len(motion)))
    return stops


def play(
    graph: MotionGraph, stops: Sequence[Stop], positions: Sequence[int], *, loop: bool, note: str = ""
) -> Performance:
    """Frames and cuts of stops in order."""
    frames: list[tuple[int, int]] = []
    nodes: list[int] = []
    cuts: list[Cut] = []
    for k, stop in enumerate(stops):
        motion = graph.nodes[stop.node]
        if k:
            before = stops[k - 1].node
            weight = float(graph.complete[before, stop.node])
            cuts.append(Cut(len(frames), "cut", before, stop.node, frames[-1][1], stop.entry, weight))
        played = dwell_frames(motion, stop.entry, stop.count)
        for step, frame in enumerate(played):
            if step and frame == motion.first and len(motion) > 0:
                cuts.append(Cut(len(frames), "wrap", stop.node, stop.node, motion.last, motion.first, 0.0))
            frames.append((motion.sequence, frame))
            nodes.append(stop.node)
    if loop:
        first, last = stops[0], stops[-1]
        alone = len(stops) == 1
        if alone and not graph.nodes[first.node].cyclic:
            raise InputError(f"Motion {first.node} does not repeat: a loop needs one that does, or a way back to it.")
        weight = 0.0 if alone else float(graph.complete[last.node, first.node])
        cuts.append(Cut(len(frames), "loop", last.node, first.node, frames[-1][1], first.entry, weight))
    path = tuple(stop.node for stop in stops)
    steps = [cut.weight for cut in cuts]
    return Performance(
        path=path,
        keys=tuple(positions),
        cost=max(steps, default=0.0),
        frames=np.array(frames, np.int64).reshape(-1, 2),
        nodes=np.array(nodes, np.int64),
        transforms=np.zeros((len(frames), 3)),
        cuts=tuple(cuts),
        loop=loop,
        note=note,
    )
