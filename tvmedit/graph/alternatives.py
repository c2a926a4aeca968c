"""The next best paths, in order."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterable
from typing import Any

import numpy as np

from imitation.errors import InputError
from tvmedit.graph.search import Key, Weights, check_node, check_weights, path_key, shortest_of_least_bottleneck
from tvmedit.graph.unreachable import Unreachable


def best_paths(weights: Any, start: int, goal: int, count: int, *, forbidden: Iterable[int] = ()) -> list[list[int]]:
    """Find the best paths without repeated nodes, best first.

    Parameters
    ----------
    weights : (k, k) float
    start, goal : int
    count : int
        How many; fewer are given where no more exist.
    forbidden : iterable of int

    Returns
    -------
    list of paths, ordered by bottleneck, edges, sum of weights, nodes

    Raises
    ------
    Unreachable
        There is none at all.

    Notes
    -----
    Lawler's partition: each path found splits what is left by the first edge in which it differs; the best of each
    part comes from the exact search with the prefix's nodes barred and its bottleneck as the floor.
    """
    matrix = check_weights(weights)
    start, goal = check_node(start, len(matrix)), check_node(goal, len(matrix))
    if count < 1:
        raise InputError(f"The number of paths is {count}: ask for one or more.")
    barred = {check_node(node, len(matrix)) for node in forbidden}
    if barred & {start, goal}:
        raise InputError("A forbidden motion cannot be a key motion: choose one.")
    first = shortest_of_least_bottleneck(matrix, start, goal, barred)
    if first is None:
        raise Unreachable(start, goal)
    # Each candidate carries how much of it is fixed and which edges are barred where it is left.
    queue: list[tuple[Key, int, frozenset[int]]] = [(path_key(matrix, first), 0, frozenset())]
    found: list[list[int]] = []
    while queue and len(found) < count:
        key, fixed, banned = heapq.heappop(queue)
        path = list(key[3])
        found.append(path)
        for spur in range(fixed, len(path) - 1):
            excluded = (banned if spur == fixed else frozenset[int]()) | {path[spur + 1]}
            candidate = _deviate(matrix, path[: spur + 1], goal, excluded, barred)
            if candidate is not None:
                heapq.heappush(queue, (path_key(matrix, candidate), spur, excluded))
    return found


def _deviate(
    weights: Weights, prefix: list[int], goal: int, excluded: frozenset[int], barred: Collection[int]
) -> list[int] | None:
    """Best path that starts with the prefix and does not go on to the excluded nodes."""
    matrix = weights.copy()
    matrix[prefix[-1], sorted(excluded)] = np.inf
    floor = path_key(weights, prefix)[0]
    rest = shortest_of_least_bottleneck(matrix, prefix[-1], goal, {*barred, *prefix[:-1]}, floor=floor)
    return None if rest is None else prefix[:-1] + rest
