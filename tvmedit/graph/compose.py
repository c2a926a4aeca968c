"""``compose``: key motions to a performance (paper B, section 7)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import attrs

from imitation.errors import InputError
from tvmedit.graph.lengths import LengthSearch
from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.performance import Performance
from tvmedit.graph.playing import play, stops_of
from tvmedit.graph.search import check_node
from tvmedit.graph.ways import best_ways

Repeats = Mapping[int, int] | Sequence[int] | None


def compose(
    graph: MotionGraph,
    key_motions: Sequence[int],
    *,
    length: int | None = None,
    seconds: float | None = None,
    alternatives: int = 0,
    repeats: Repeats = None,
    loop: bool = False,
    forbidden: Iterable[int] = (),
    align: bool = True,
) -> Performance:
    """Compose a performance from key motions in order.

    Parameters
    ----------
    graph : MotionGraph
    key_motions : sequence of int
        Nodes in order; equal neighbours are one key played that many times.
    length : int, optional
        Wanted length in frames: exact where one can be reached, else the nearest, with the reason in ``note``.
    seconds : float, optional
        The same in seconds.
    alternatives : int
        How many next best performances to give besides (other paths, ordered by bottleneck, then edges).
    repeats : mapping or sequence, optional
        How often each key motion is played at least, by its place in ``key_motions``.
    loop : bool
        The end leads back to the start.
    forbidden : iterable of int
        Motions that must not be played.
    align : bool
        Place every clip where the one before it ends (see ``tvmedit.align``).

    Returns
    -------
    Performance

    Raises
    ------
    InputError
        Motions that do not exist, a forbidden key motion, a motion that cannot be repeated.
    Unreachable
        A key motion that no path reaches: which one, the smallest mu that reaches it, the edges this brings back.
    """
    keys, times = _keys(graph, key_motions, repeats)
    barred = {check_node(node, len(graph.nodes)) for node in forbidden}
    for key in keys:
        if key in barred:
            raise InputError(f"Motion {key} is forbidden and a key motion: choose one.")
    if alternatives < 0:
        raise InputError(f"The number of alternatives is {alternatives}: give 0 or more.")
    wanted = _wanted(graph, length, seconds)
    if wanted is None:
        ways = best_ways(graph, keys, barred, 1 + alternatives, loop=loop)
        made = [play(graph, stops_of(graph, way, times, loop=loop), way[1], loop=loop) for way in ways]
    else:
        made = [_of_length(graph, keys, times, barred, wanted, loop)]
    if align:
        from tvmedit.cuts.placement import align_performance

        made[0] = align_performance(graph, made[0])
    return attrs.evolve(made[0], alternatives=tuple(made[1:]))


def _keys(graph: MotionGraph, key_motions: Sequence[int], repeats: Repeats) -> tuple[list[int], list[int]]:
    """Key motions without equal neighbours, and how often each is played."""
    given = [check_node(key, len(graph.nodes)) for key in key_motions]
    if not given:
        raise InputError("There is no key motion: choose at least one.")
    each = [1] * len(given)
    pairs = repeats.items() if isinstance(repeats, Mapping) else enumerate(repeats or ())
    for place, count in pairs:
        if not 0 <= place < len(given) or int(count) < 1:
            raise InputError(f"Key motion number {place} cannot be played {count} times: there are {len(given)} keys.")
        each[place] = int(count)
    keys: list[int] = []
    times: list[int] = []
    for key, count in zip(given, each, strict=True):
        if keys and keys[-1] == key:
            times[-1] += count
        else:
            keys.append(key)
            times.append(count)
    for key, count in zip(keys, times, strict=True):
        if count > 1 and not graph.nodes[key].cyclic:
            raise InputError(f"Motion {key} does not repeat: it can be played once, not {count} times in a row.")
    return keys, times


def _wanted(graph: MotionGraph, length: int | None, seconds: float | None) -> int | None:
    if length is None and seconds is None:
        return None
    if length is not None and seconds is not None:
        raise InputError("The length is given in frames and in seconds: give one.")
    frames = int(length) if length is not None else round(float(seconds or 0.0) * graph.fps)
    if not 1 <= frames <= 1_000_000:
        raise InputError(f"The wanted length is {frames} frames: give 1 to 1,000,000.")
    return frames


def _of_length(
    graph: MotionGraph, keys: list[int], times: list[int], barred: set[int], wanted: int, loop: bool
) -> Performance:
    """Performance of the wanted length, or of the nearest there is."""
    least = best_ways(graph, keys, barred, 1, loop=loop)[0]
    # Whatever the nearest length is, it is no further away than the shortest by the best way.
    shortest = sum(stop.count for stop in stops_of(graph, least, times, loop=loop))
    longest = max(wanted + max(len(node) for node in graph.nodes), shortest)
    search = LengthSearch(graph.nodes, graph.weights, graph.transitions, keys, times, barred, longest, loop)
    plan = search.plan(wanted)
    note = ""
    if plan.length != wanted:
        kind = "shorter" if plan.length > wanted else "longer"
        note = (
            f"{wanted} frames cannot be reached: every motion plays whole rounds between its cuts, and the nearest "
            f"length is {plan.length}; nothing {kind} comes as near."
        )
    positions, following = [], 0
    for k, stop in enumerate(plan.stops):
        if following < len(keys) and stop.node == keys[following]:
            positions.append(k)
            following += 1
    return play(graph, plan.stops, positions, loop=loop, note=note)
