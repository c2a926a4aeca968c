"""Ways through all key motions: combinations of the best paths between neighbours, best first."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Collection, Sequence

from tvmedit.graph.alternatives import best_paths
from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.search import best_path, path_key
from tvmedit.graph.unreachable import Unreachable

Way = tuple[list[int], list[int]]
"""Nodes in order, and where among them the key motions stand."""


def best_ways(graph: MotionGraph, keys: Sequence[int], barred: Collection[int], count: int, *, loop: bool) -> list[Way]:
    """Find the best ways: least bottleneck, then fewest edges, then least sum of weights.

    Raises
    ------
    Unreachable
        With the smallest mu that would help.
    """
    ends = list(itertools.pairwise(keys))
    if loop and keys[0] != keys[-1]:
        ends.append((keys[-1], keys[0]))
    if not ends:
        return [([keys[0]], [0])]
    legs = [_leg(graph, start, goal, barred, count) for start, goal in ends]
    costs = [[path_key(graph.weights, path)[:3] for path in leg] for leg in legs]

    def total(choice: tuple[int, ...]) -> tuple[float, int, float]:
        picked = [costs[leg][k] for leg, k in enumerate(choice)]
        return max(cost[0] for cost in picked), sum(cost[1] for cost in picked), sum(cost[2] for cost in picked)

    first = (0,) * len(legs)
    queue, seen = [(total(first), first)], {first}
    ways: list[Way] = []
    while queue and len(ways) < count:
        _, choice = heapq.heappop(queue)
        ways.append(_joined([legs[leg][k] for leg, k in enumerate(choice)], len(keys), loop=loop))
        for leg in range(len(legs)):
            following = (*choice[:leg], choice[leg] + 1, *choice[leg + 1 :])
            if following[leg] < len(legs[leg]) and following not in seen:
                seen.add(following)
                heapq.heappush(queue, (total(following), following))
    return ways


def _leg(graph: MotionGraph, start: int, goal: int, barred: Collection[int], count: int) -> list[list[int]]:
    try:
        if graph.method == "paper" and count == 1:
            return [best_path(graph.weights, start, goal, forbidden=barred, method="paper")]
        return best_paths(graph.weights, start, goal, count, forbidden=barred)
    except Unreachable:
        raise graph.explain(start, goal, barred) from None


def _joined(legs: list[list[int]], keys: int, *, loop: bool) -> Way:
    """One path from its legs; a loop does not name its first node twice."""
    path, positions = [legs[0][0]], [0]
    for leg in legs:
        path.extend(leg[1:])
        positions.append(len(path) - 1)
    if loop:
        path.pop()
    return path, [position for position in positions if position < len(path)][:keys]
