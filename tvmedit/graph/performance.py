"""A composed performance: which frames are played, where it is cut, and where the performer stands."""

from __future__ import annotations

from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@attrs.frozen
class Cut:
    """A joint of the performance: two frames that did not follow each other.

    Attributes
    ----------
    position : int
        Index in the performance of the first frame after it.
    kind : "cut", "wrap" or "loop"
        Between two motions, between two rounds of one, or from the end back to the start.
    source, target : int
        Nodes.
    leave, enter : int
        Last frame before, in the source's sequence; first frame after, in the target's.
    weight : float
        The edge's weight (eq. 12); 0 for a wrap.
    residual : float
        Mean distance of the aligned surfaces at the joint, in the meshes' unit; NaN before alignment.
    """

    position: int
    kind: Literal["cut", "wrap", "loop"]
    source: int
    target: int
    leave: int
    enter: int
    weight: float
    residual: float = float("nan")


@attrs.frozen(eq=False)
class Performance:
    """Frames in the order in which they are played.

    Attributes
    ----------
    path : tuple of int
        Nodes visited.
    keys : tuple of int
        Positions in the path of the key motions.
    cost : float
        Largest weight on the path (eq. 15).
    frames : (m, 2) int64
        Sequence and frame of each frame played.
    nodes : (m,) int64
        Node of each frame played.
    transforms : (m, 3) float64
        Yaw (radians), x and y: a vertex v of a frame, z up, stands at Rz(yaw) v + (x, y, 0). Zero before alignment.
    cuts : tuple of Cut
        Cuts and wraps in order.
    loop : bool
    aligned : bool
    alternatives : tuple of Performance
        The next best, in order, not aligned.
    note : str
        Why it is not the length that was wanted; empty otherwise.
    """

    path: tuple[int, ...]
    keys: tuple[int, ...]
    cost: float
    frames: NDArray[np.int64]
    nodes: NDArray[np.int64]
    transforms: Array
    cuts: tuple[Cut, ...]
    loop: bool = False
    aligned: bool = False
    alternatives: tuple[Performance, ...] = ()
    note: str = ""

    def __len__(self) -> int:
        return len(self.frames)

    def place(self, position: int, vertices: Array) -> Array:
        """Vertices (v, 3), z up, of the frame at a position, moved to where the performer is then."""
        yaw, x, y = self.transforms[position]
        c, s = np.cos(yaw), np.sin(yaw)
        placed = np.array(vertices, np.float64)
        placed[:, 0] = c * vertices[:, 0] - s * vertices[:, 1] + x
        placed[:, 1] = s * vertices[:, 0] + c * vertices[:, 1] + y
        return placed
