"""How well a joint is hidden: what the eye sees jump there, against what the motion does anyway."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.performance import Performance

Array = NDArray[np.float64]


@attrs.frozen
class Seam:
    """Score of one joint.

    Attributes
    ----------
    position : int
        Index of the first frame after it.
    kind : str
        "cut", "wrap" or "loop".
    before : float
        Surface step at the joint as the clips were filmed, in the meshes' unit.
    after : float
        Surface step as the performance places them.
    usual : float
        Largest surface step within the motions played.
    turned : float
        How far the performer turns at the joint beyond what the motion would, radians, by the headings.
    """

    position: int
    kind: str
    before: float
    after: float
    usual: float
    turned: float

    @property
    def score(self) -> float:
        """Step at the joint over the largest step within the motions: 1 and less does not stand out."""
        return self.after / self.usual if self.usual > 0 else float("inf") if self.after > 0 else 0.0


def surface_step(first: NDArray[np.floating], second: NDArray[np.floating]) -> float:
    """Mean distance between two clouds of surface points to each other's nearest, both ways."""
    from scipy.spatial import cKDTree

    there = np.mean(cKDTree(second).query(first)[0])
    back = np.mean(cKDTree(first).query(second)[0])
    return float(0.5 * (there + back))


def seam_scores(graph: MotionGraph, performance: Performance) -> list[Seam]:
    """Score every joint of a performance, cuts and wraps alike, before and after placement."""
    usual = _largest_steps(graph, performance)
    seams = []
    for cut in performance.cuts:
        last = cut.position - 1
        first = cut.position % len(performance)
        earlier, later = _points(graph, performance, last), _points(graph, performance, first)
        filmed = surface_step(earlier, later)
        if cut.kind == "loop":
            # The loop's end need not stand where it began; what counts is the joint itself.
            placed = cut.residual if np.isfinite(cut.residual) else filmed
            seams.append(Seam(cut.position, cut.kind, filmed, placed, usual, 0.0))
            continue
        placed = surface_step(performance.place(last, earlier), performance.place(first, later))
        seams.append(Seam(cut.position, cut.kind, filmed, placed, usual, _turn(graph, performance, last, first)))
    return seams


def _points(graph: MotionGraph, performance: Performance, position: int) -> Array:
    sequence, frame = performance.frames[position]
    return np.asarray(graph.analyses[sequence].samples[frame], np.float64)


def _turn(graph: MotionGraph, performance: Performance, last: int, first: int) -> float:
    """Turn between the frame that would have come and the one that comes."""
    sequence, frame = performance.frames[last]
    headings = graph.analyses[sequence].headings
    expected = headings[min(frame + 1, len(headings) - 1)] + performance.transforms[last, 0]
    other, entered = performance.frames[first]
    actual = graph.analyses[other].headings[entered] + performance.transforms[first, 0]
    return float(abs(np.angle(np.exp(1j * (actual - expected)))))


def _largest_steps(graph: MotionGraph, performance: Performance) -> float:
    """Largest step from frame to frame within the motions that are played."""
    largest = 0.0
    for number in sorted(set(performance.path)):
        node = graph.nodes[number]
        samples = graph.analyses[node.sequence].samples
        frames = range(node.first, node.last)
        steps = [surface_step(samples[frame], samples[frame + 1]) for frame in frames]
        largest = max(largest, max(steps, default=0.0))
    return largest
