"""Where one motion can be left for another, and how far the body jumps there (eq. 10)."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.analysis import Analysis
from tvmedit.features import frame_distances, turned
from tvmedit.graph.database import Node

Array = NDArray[np.float64]
TAPS = 5
"""Window of a transition's atoms in frames: short, as what follows the cut matters, not what comes around again."""


@attrs.frozen(eq=False)
class Transitions:
    """Node distances (k, k), the frames (k, k, 2) left and entered, and each node's motion intensity (k,)."""

    distances: Array
    frames: NDArray[np.int64]
    intensities: Array


def find_transitions(analyses: Sequence[Analysis], nodes: Sequence[Node], *, printed: bool) -> Transitions:
    """Compare all nodes.

    As printed (eq. 10): the two frames that look most alike. Otherwise the successor rule: leave after frame a and
    enter at b where the atom at b looks most like the one at a + 1, both turned to face one way, so that the motion
    neither stalls nor turns round. A node that does not repeat is left after its last frame and entered at its first.
    """
    ahead = 0 if printed else 1
    half = 0 if printed else TAPS // 2
    taps = np.ones(1) if printed else np.hanning(TAPS + 2)[1:-1]
    taps = taps / taps.sum()
    count = len(nodes)
    distances = np.full((count, count), np.inf)
    frames = np.full((count, count, 2), -1, np.int64)
    intensities = np.zeros(count)
    stacks = [_Stack(analyses[node.sequence], node, half, printed) for node in nodes]
    for i, node in enumerate(nodes):
        own = _slide(stacks[i].squares(stacks[i]), taps)
        # Eq. 11, in the distance that the node distance is made of.
        steps = own[np.arange(len(node) - 1), np.arange(1, len(node))] if len(node) > 1 else np.zeros(1)
        intensities[i] = float(steps.mean())
        for j, other in enumerate(nodes):
            if i == j:
                continue
            square = _slide(stacks[i].squares(stacks[j]), taps)
            leave = np.arange(len(node)) if node.cyclic else np.array([len(node) - 1])
            if not printed and node.cyclic and len(node) > 1 and node.last + 1 >= len(analyses[node.sequence]):
                # What would come after its last frame was not filmed.
                leave = leave[:-1]
            enter = np.arange(len(other)) if other.cyclic else np.array([0])
            block = square[np.ix_(leave + ahead, enter)]
            best = int(np.argmin(block))
            a, b = leave[best // len(enter)], enter[best % len(enter)]
            distances[i, j] = block.flat[best]
            frames[i, j] = node.first + a, other.first + b
    return Transitions(distances, frames, _floored(intensities))


def _floored(intensities: Array) -> Array:
    """A node of one frame, or without motion, would divide by zero: no less than 5 % of the median."""
    positive = intensities[intensities > 0]
    floor = 0.05 * float(np.median(positive)) if len(positive) else 1.0
    return np.maximum(intensities, floor)


class _Stack:
    """Feature rows of a node's frames, the one after its last, and half a window more at either end."""

    def __init__(self, analysis: Analysis, node: Node, half: int, printed: bool) -> None:
        self.node = node
        wanted = np.clip(np.arange(node.first - half, node.last + 2 + half), 0, len(analysis) - 1)
        features = analysis.features
        self.part = attrs.evolve(features, histograms=features.histograms[wanted])
        self.rows: Array | None = None
        if features.method == "robust" and not printed:
            self.rows = turned(self.part, analysis.headings[wanted]).astype(np.float64)
            self.energy = (self.rows**2).sum(axis=1)

    def squares(self, other: _Stack) -> Array:
        """Distances of all rows: squared where windows are averaged in squares, plain as printed."""
        if self.rows is None or other.rows is None:
            return frame_distances(self.part, other.part).astype(np.float64)
        square = self.energy[:, None] + other.energy - 2.0 * self.rows @ other.rows.T
        return np.asarray(np.maximum(square, 0.0))


def _slide(values: Array, taps: Array) -> Array:
    """Sum along diagonals under the window; square roots where a window is averaged."""
    size = len(taps)
    rows, columns = values.shape[0] - size + 1, values.shape[1] - size + 1
    total = np.zeros((rows, columns))
    for shift, weight in enumerate(taps):
        total += weight * values[shift : shift + rows, shift : shift + columns]
    return total if size == 1 else np.sqrt(total)
