"""The hierarchical structure of a sequence: clusters of textons, and why they were cut there."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

Span = tuple[int, int]
"""First and last frame, both included."""


@attrs.frozen
class Cluster:
    """Frames of one motion.

    Attributes
    ----------
    first, last : int
        Frames, both included.
    cyclic : bool
        Whether the motion repeats; one that does not has one texton, played once.
    textons : tuple of (first, last)
        Frames of each whole period, both included, in order and one after another.
    period : float
        Median length of a texton in frames.
    kind : int
        Clusters of one kind show the same motion.
    reason : str
        One sentence: why this is a cluster of its own.
    """

    first: int
    last: int
    cyclic: bool
    textons: tuple[Span, ...]
    period: float
    kind: int = 0
    reason: str = ""

    def __len__(self) -> int:
        return self.last - self.first + 1


@attrs.frozen(eq=False)
class Structure:
    """Clusters of a whole sequence in order, without gaps.

    Attributes
    ----------
    clusters : tuple of Cluster
    method : "optimal" or "paper"
    threshold : float
        "optimal": lambda, the price of a frame of new motion; "paper": beta of eq. 8.
    curve : (n,) float64
        Atom distance to the first atom of the frame's texton (Fig. 4).
    novelty : (n,) float64
        What speaks for a new cluster: "paper": the least distance to the cluster so far (eq. 7), NaN where it is not
        tested; "optimal": the distance to the frame one period before, NaN where nothing repeats.
    reason : str
        One sentence on the whole.
    """

    clusters: tuple[Cluster, ...]
    method: str
    threshold: float
    curve: NDArray[np.float64]
    novelty: NDArray[np.float64]
    reason: str

    @property
    def boundaries(self) -> tuple[int, ...]:
        """First frame of every cluster but the first."""
        return tuple(cluster.first for cluster in self.clusters[1:])

    @property
    def textons(self) -> tuple[Span, ...]:
        """All textons in order."""
        return tuple(texton for cluster in self.clusters for texton in cluster.textons)


def texton_curve(atoms: NDArray[np.floating], clusters: tuple[Cluster, ...]) -> NDArray[np.float64]:
    """Distance of each atom to the first of its texton (before the first texton: to its cluster's start)."""
    curve = np.zeros(len(atoms))
    for cluster in clusters:
        starts = [first for first, _ in cluster.textons]
        if cluster.cyclic and cluster.textons:
            starts.append(cluster.textons[-1][1] + 1)
        anchor = np.full(len(cluster), cluster.first)
        for start in starts:
            anchor[max(0, start - cluster.first) :] = start
        frames = np.arange(cluster.first, cluster.last + 1)
        curve[frames] = atoms[frames, np.minimum(anchor, len(atoms) - 1)]
    return curve
