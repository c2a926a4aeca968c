"""A performance of a wanted length, exactly where one exists (the paper's future work: length control)."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import NoSolution
from tvmedit.graph.database import Node
from tvmedit.graph.dwell import least_dwell
from tvmedit.graph.search import least_bottleneck

Array = NDArray[np.float64]
State = tuple[int, int, int]
"""Node, frame entered, keys played."""
MOST_CUTS = 16
"""Without a bound a long performance would collect cuts to avoid one dear edge."""


@attrs.frozen
class Stop:
    """One motion of a performance: node, frame entered, frames played."""

    node: int
    entry: int
    count: int


@attrs.frozen
class Plan:
    """Stops in order, their bottleneck and their length in frames."""

    stops: tuple[Stop, ...]
    cost: float
    length: int


@attrs.define(eq=False)
class LengthSearch:
    """Sets of reachable lengths, one big integer a state: bit L is set if L frames can be reached.

    A state is a node, the frame at which it is entered and how many keys have been played; playing a motion shifts
    the set, repeats of it are shifts by multiples, and cuts make layers.
    """

    nodes: Sequence[Node]
    weights: Array
    transitions: NDArray[np.int64]
    keys: Sequence[int]
    repeats: Sequence[int]
    forbidden: Collection[int]
    longest: int
    loop: bool = False

    def plan(self, wanted: int) -> Plan:
        """Plan exactly the wanted length by the least bottleneck, then the fewest cuts; or the nearest length."""
        weights = np.unique(self.weights[np.isfinite(self.weights)])
        least = self._least_bottleneck()
        levels = [least, *(float(weight) for weight in weights if weight > least)]
        if self._found(levels[0], wanted) is not None:
            return self._plan(levels[0], wanted)
        lengths = 0
        for reached, _ in self._reach(levels[-1]):
            lengths |= reached
        nearest = _nearest_bit(lengths, wanted)
        if nearest is None:
            raise NoSolution(
                f"No performance of {self.longest} frames or fewer plays these key motions in {MOST_CUTS} cuts: "
                "ask for a longer one, or leave out a key motion."
            )
        low, high = 0, len(levels) - 1
        while low < high:
            middle = (low + high) // 2
            if self._found(levels[middle], nearest) is not None:
                high = middle
            else:
                low = middle + 1
        return self._plan(levels[low], nearest)

    def _least_bottleneck(self) -> float:
        """No performance of these keys has a smaller bottleneck, whatever its length."""
        ends = list(itertools.pairwise([*self.keys, self.keys[0]] if self.loop else self.keys))
        barred = set(self.forbidden)
        costs = [least_bottleneck(self.weights, a, b, barred) for a, b in ends if a != b]
        return max(costs, default=0.0)

    def _found(self, bottleneck: float, length: int) -> list[dict[State, int]] | None:
        """Layers of the fewest cuts that reach a length, or None."""
        fewest: list[dict[State, int]] | None = None
        for reached, layers in self._reach(bottleneck, length):
            if reached >> length & 1 and (fewest is None or len(layers) < len(fewest)):
                fewest = layers
        return fewest

    def _plan(self, bottleneck: float, length: int) -> Plan:
        layers = self._found(bottleneck, length)
        assert layers is not None
        return self._walk_back(layers, length, bottleneck)

    def _reach(self, bottleneck: float, longest: int | None = None) -> list[tuple[int, list[dict[State, int]]]]:
        """Reachable lengths after 0, 1, ... cuts, and every layer's sets; one list of layers an entry of a loop."""
        most = self.longest if longest is None else longest
        mask = (1 << (most + 1)) - 1
        after = self._edges(bottleneck)
        first = self.keys[0]
        entries = [self.nodes[first].first]
        if self.loop:
            entries = sorted({int(self.transitions[i, j, 1]) for i in after for j in after[i] if j == first})
        results = []
        for entry in entries:
            layer = {(first, entry, 1): 1}
            layers: list[dict[State, int]] = []
            for _ in range(MOST_CUTS + 1):
                layers.append(layer)
                done = 0
                following: dict[State, int] = {}
                for (node, at, played), lengths in layer.items():
                    base = self._repeated(node, played, lengths, mask)
                    if not base:
                        continue
                    motion = self.nodes[node]
                    if played == len(self.keys):
                        done |= self._finished(node, at, base, entry, after) & mask
                    for other in after.get(node, ()):
                        leave, enter = (int(frame) for frame in self.transitions[node, other])
                        extra = (leave - at + 1) % len(motion) if motion.cyclic else 0
                        count = played + (played < len(self.keys) and other == self.keys[played])
                        if self.loop and played == len(self.keys) and other == first and enter == entry:
                            continue
                        state = (other, enter, count)
                        following[state] = following.get(state, 0) | (base << extra & mask)
                results.append((done, list(layers)))
                if longest is not None and done >> longest & 1:
                    break
                layer = {state: lengths for state, lengths in following.items() if lengths}
                if not layer:
                    break
        return results

    def _edges(self, bottleneck: float) -> dict[int, list[int]]:
        barred = set(self.forbidden)
        usable = self.weights <= bottleneck
        return {
            i: [int(j) for j in np.flatnonzero(usable[i]) if int(j) not in barred]
            for i in range(len(self.nodes))
            if i not in barred
        }

    def _repeated(self, node: int, played: int, lengths: int, mask: int) -> int:
        """Lengths after a node's least number of whole turns, or any larger one."""
        motion, times = self.nodes[node], 1
        if played and node == self.keys[played - 1]:
            times = self.repeats[played - 1]
        size = len(motion)
        turned = lengths << (size * times) & mask
        if motion.cyclic:
            # All multiples by doubling: once, twice, four times the texton more.
            shift = size
            while turned and shift < mask.bit_length():
                turned |= turned << shift & mask
                shift *= 2
        return turned

    def _finished(self, node: int, at: int, base: int, entry: int, after: dict[int, list[int]]) -> int:
        """Lengths at which the performance may end here: at the texton's last frame, or by the edge that closes it."""
        motion = self.nodes[node]
        if not self.loop:
            return base << ((motion.last - at + 1) % len(motion) if motion.cyclic else 0)
        first = self.keys[0]
        if first in after.get(node, ()) and int(self.transitions[node, first, 1]) == entry:
            leave = int(self.transitions[node, first, 0])
            return base << ((leave - at + 1) % len(motion) if motion.cyclic else 0)
        return 0

    def _walk_back(self, layers: list[dict[State, int]], length: int, bottleneck: float) -> Plan:
        """Retrace one way to a length, the fewest repeats and lowest nodes first."""
        after = self._edges(bottleneck)
        entry = next(iter(layers[0]))[1]
        last = len(layers) - 1
        stops: list[Stop] = []
        for state in sorted(layers[last]):
            if state[2] != len(self.keys):
                continue
            ends = self._turns(state, layers[last][state], length, self._end_extra(state, entry, after))
            if ends is not None:
                stops.append(Stop(state[0], state[1], ends))
                remaining, current = length - ends, state
                break
        for step in range(last - 1, -1, -1):
            remaining, current = self._step_back(layers[step], current, remaining, after, stops)
        stops.reverse()
        steps = [float(self.weights[a.node, b.node]) for a, b in itertools.pairwise(stops)]
        if self.loop:
            steps.append(float(self.weights[stops[-1].node, stops[0].node]))
        return Plan(tuple(stops), max(steps, default=0.0), length)

    def _end_extra(self, state: State, entry: int, after: dict[int, list[int]]) -> int | None:
        moved = self._finished(state[0], state[1], 1, entry, after)
        return moved.bit_length() - 1 if moved else None

    def _turns(self, state: State, before: int, length: int, extra: int | None) -> int | None:
        """Frames played in a state such that what came before is reachable; the fewest."""
        if extra is None:
            return None
        node, _, played = state
        motion = self.nodes[node]
        times = self.repeats[played - 1] if played and node == self.keys[played - 1] else 1
        count = len(motion) * times + extra
        while count <= length:
            if before >> (length - count) & 1:
                return count
            if not motion.cyclic:
                return None
            count += len(motion)
        return None

    def _step_back(
        self,
        layer: dict[State, int],
        current: State,
        remaining: int,
        after: dict[int, list[int]],
        stops: list[Stop],
    ) -> tuple[int, State]:
        for state in sorted(layer):
            node, at, played = state
            if current[0] not in after.get(node, ()) or int(self.transitions[node, current[0], 1]) != current[1]:
                continue
            if played + (played < len(self.keys) and current[0] == self.keys[played]) != current[2]:
                continue
            motion = self.nodes[node]
            leave = int(self.transitions[node, current[0], 0])
            extra = least_dwell(motion, at, leave) - len(motion) if motion.cyclic else 0
            count = self._turns(state, layer[state], remaining, extra)
            if count is not None:
                stops.append(Stop(node, at, count))
                return remaining - count, state
        raise AssertionError("a reachable length has a way back")


def _nearest_bit(lengths: int, wanted: int) -> int | None:
    """Set bit nearest to the wanted one; of two equally near the lower."""
    if not lengths:
        return None
    below = lengths & ((1 << (wanted + 1)) - 1)
    lower = below.bit_length() - 1 if below else None
    above = lengths >> wanted
    upper = wanted + (above & -above).bit_length() - 1 if above else None
    if lower is None or (upper is not None and upper - wanted < wanted - lower):
        return upper
    return lower
