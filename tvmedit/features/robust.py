"""The robust features: a soft cylinder histogram around each frame's own vertical axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.features.cylinder import AZIMUTH_BINS, HEIGHT_BINS, RADIUS_BINS, cylinder_histogram
from tvmedit.features.feature import Features
from tvmedit.features.frames import Array, Faces
from tvmedit.features.measure import ground_centroid, mesh_areas

BUFFERED = 2_000_000
"""So many vertices are held back until the ground and the body height are known (about 48 MB)."""


class CylinderHistograms:
    """Collects the robust features frame by frame in bounded memory.

    The ground is the 5 % quantile of the frames' lowest points (their 0.5 % quantile of z), so that a jump counts as
    one; the body height is the median of the frames' upper ends (99.5 % quantile) over the ground. Both are read from
    the first frames, as many as fit ``BUFFERED`` vertices, unless they are given.

    Attributes, grown frame by frame
    --------------------------------
    centres : (x, y) of the surface's centroid
    lows : lowest point, edges : mean edge length, areas: the surface
    """

    def __init__(self, *, floor: float | None = None, height: float | None = None) -> None:
        if height is not None and not height > 0:
            raise InputError(f"The body height is {height}: give a positive length.")
        self.floor, self.height = floor, height
        self.centres: list[tuple[float, float]] = []
        self.lows: list[float] = []
        self.highs: list[float] = []
        self.edges: list[float] = []
        self._held: list[tuple[Array, Array]] = []
        self._vertices_held = 0
        self._histograms: list[NDArray[np.float32]] = []
        self._known = floor is not None and height is not None

    def add(self, vertices: Array, faces: Faces | None) -> tuple[Array, Array | None]:
        """Take the next frame; gives its vertex weights (v,) and the running sum of ``mesh_areas`` (m,)."""
        frame = len(self.centres)
        running: Array | None = None
        if faces is None:
            weights, edge = np.ones(len(vertices)), 0.0
        else:
            weights, running, edge = mesh_areas(vertices, faces)
        x, y, total = ground_centroid(vertices, weights)
        if not total > 0:
            raise InputError(f"Frame {frame} has a surface without any area: leave it out or capture it again.")
        self.centres.append((x, y))
        low, high = _ends(vertices[:, 2])
        self.lows.append(low)
        self.highs.append(high)
        self.edges.append(float(edge))
        if self._known:
            self._count(vertices, weights, frame)
        else:
            self._held.append((vertices, weights))
            self._vertices_held += len(vertices)
            if self._vertices_held > BUFFERED:
                self._settle()
        return weights, running

    def features(self) -> Features:
        """Give the features of all frames taken."""
        if not self._known:
            self._settle()
        assert self.floor is not None
        assert self.height is not None
        parts = (HEIGHT_BINS, RADIUS_BINS, AZIMUTH_BINS)
        return Features("robust", np.array(self._histograms), parts, np.array([0.0, 0.0, self.floor]), self.height)

    def _settle(self) -> None:
        """Fix ground and body height from the frames held, and count those."""
        if self.floor is None:
            self.floor = float(np.quantile(self.lows, 0.05))
        if self.height is None:
            height = float(np.median(np.array(self.highs) - self.floor))
            self.height = height if height > 0 else 1.0
        self._known = True
        first = len(self.centres) - len(self._held)
        for offset, (vertices, weights) in enumerate(self._held):
            self._count(vertices, weights, first + offset)
        self._held.clear()

    def _count(self, vertices: Array, weights: Array, frame: int) -> None:
        assert self.floor is not None
        assert self.height is not None
        x, y = self.centres[frame]
        self._histograms.append(cylinder_histogram(vertices, weights, x, y, self.floor, self.height))


def _ends(z: Array) -> tuple[float, float]:
    """The 0.5 % and 99.5 % quantiles of z, without a full sort."""
    n = len(z)
    low, high = int(0.005 * (n - 1)), int(np.ceil(0.995 * (n - 1)))
    part = np.partition(z, (low, high))
    return float(part[low]), float(part[high])
