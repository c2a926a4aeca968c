"""Best paths in a motion graph: exact, and Algorithm 1 as printed (paper B, section 7, eq. 15-17)."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Collection, Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.graph.unreachable import Unreachable

Weights = NDArray[np.float64]
Key = tuple[float, int, float, tuple[int, ...]]
"""What paths are ordered by: bottleneck, edges, sum of weights, nodes."""


def check_weights(weights: Any) -> Weights:
    """A square matrix without negative weights or NaN, as float64; the diagonal is no edge."""
    matrix = np.array(weights, dtype=np.float64)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or len(matrix) == 0:
        raise InputError(f"The weights have shape {matrix.shape}: give a square matrix of at least one node.")
    np.fill_diagonal(matrix, np.inf)
    if np.isnan(matrix).any() or (matrix < 0).any():
        raise InputError("The weights hold negative values or NaN: weights are costs, infinite where there is no edge.")
    return matrix


def check_node(node: int, count: int) -> int:
    """A node number that exists."""
    if not 0 <= int(node) < count:
        raise InputError(f"There is no motion {node}: the graph has motions 0 to {count - 1}.")
    return int(node)


def best_path(
    weights: Any,
    start: int,
    goal: int,
    *,
    forbidden: Iterable[int] = (),
    method: Literal["exact", "paper"] = "exact",
) -> list[int]:
    """Best path between two motions (eq. 15 and 16): least largest weight, then fewest edges.

    Parameters
    ----------
    weights : (k, k) float
        Cost of the edge from row to column, infinite where there is none.
    start, goal : int
    forbidden : iterable of int
        Motions that the path must not touch.
    method : "exact" or "paper"
        "exact": ties are decided by the least sum of weights, then by the lowest node numbers. "paper": Algorithm 1
        as printed, whose path can be longer than the shortest of least cost.

    Returns
    -------
    list of int
        Nodes from start to goal; [start] if they are the same.

    Raises
    ------
    Unreachable
        There is no path.
    """
    matrix = check_weights(weights)
    start, goal = check_node(start, len(matrix)), check_node(goal, len(matrix))
    barred = {check_node(node, len(matrix)) for node in forbidden}
    for node in (start, goal):
        if node in barred:
            raise InputError(f"Motion {node} is forbidden and a key motion: choose one.")
    if method == "paper":
        matrix[:, sorted(barred)] = np.inf
        return _algorithm_1(matrix, start, goal)
    if method != "exact":
        raise InputError(f'The method is {method!r}: say "exact" or "paper".')
    path = shortest_of_least_bottleneck(matrix, start, goal, barred)
    if path is None:
        raise Unreachable(start, goal)
    return path


def path_key(weights: Weights, path: Iterable[int]) -> Key:
    """What the path is ordered by."""
    nodes = tuple(path)
    steps = [float(weights[a, b]) for a, b in itertools.pairwise(nodes)]
    return (max(steps, default=0.0), len(steps), float(sum(steps)), nodes)


def least_bottleneck(weights: Weights, start: int, goal: int, barred: Collection[int]) -> float:
    """Least largest weight on any path; infinite where there is none (Dijkstra with the maximum for the sum)."""
    cost = np.full(len(weights), np.inf)
    settled = np.zeros(len(weights), bool)
    settled[list(barred)] = True
    cost[start] = 0.0
    queue = [(0.0, start)]
    while queue:
        reached, node = heapq.heappop(queue)
        if node == goal:
            return reached
        if settled[node]:
            continue
        settled[node] = True
        through = np.maximum(reached, weights[node])
        for after in np.flatnonzero(~settled & (through < cost)).tolist():
            cost[after] = through[after]
            heapq.heappush(queue, (float(through[after]), after))
    return float("inf")


def shortest_of_least_bottleneck(
    weights: Weights,
    start: int,
    goal: int,
    barred: Collection[int],
    *,
    floor: float = 0.0,
) -> list[int] | None:
    """Least bottleneck (what lies under ``floor`` counts as the floor), fewest edges, least sum, lowest nodes."""
    if start == goal:
        return [start]
    bottleneck = max(floor, least_bottleneck(weights, start, goal, barred))
    if not np.isfinite(bottleneck):
        return None
    usable = weights <= bottleneck
    usable[:, list(barred)] = False
    level = np.full(len(weights), -1)
    level[goal] = 0
    edge_of_search, depth = np.zeros(len(weights), bool), 0
    edge_of_search[goal] = True
    # Levels counted back from the goal, then the cheapest way down them, nearest level first.
    rest: dict[int, tuple[float, tuple[int, ...]]] = {goal: (0.0, (goal,))}
    while level[start] < 0:
        depth += 1
        found = usable[:, edge_of_search].any(axis=1) & (level < 0)
        found[list(barred)] = False
        if not found.any():
            return None
        level[found] = depth
        for node in np.flatnonzero(found).tolist():
            nexts = np.flatnonzero(usable[node] & edge_of_search).tolist()
            rest[node] = min((weights[node, after] + rest[after][0], (node, *rest[after][1])) for after in nexts)
        edge_of_search = found
    return list(rest[start][1])


def _algorithm_1(weights: Weights, start: int, goal: int) -> list[int]:
    """Algorithm 1 line by line; among equal d[u] the lowest node is taken first."""
    count = len(weights)
    cost, length, previous = np.full(count, np.inf), np.zeros(count, np.int64), np.full(count, -1)
    cost[start] = 0.0
    left = set(range(count))
    while left:
        node = min(left, key=lambda u: (cost[u], u))
        left.remove(node)
        for after in np.flatnonzero(np.isfinite(weights[node])).tolist():
            through = max(cost[node], weights[node, after])
            if through < cost[after]:
                cost[after], length[after], previous[after] = through, length[node] + 1, node
            elif through == cost[after] and np.isfinite(through) and length[node] + 1 < length[after]:
                length[after], previous[after] = length[node] + 1, node
    if start != goal and previous[goal] < 0:
        raise Unreachable(start, goal)
    path = [goal]
    while path[-1] != start:
        path.append(int(previous[path[-1]]))
    return path[::-1]
