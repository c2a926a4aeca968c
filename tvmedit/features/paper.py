"""Histograms of spherical coordinates as printed (paper B, section 3, eq. 1 and 4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled
from tvmedit.features.feature import Features

ANGLE_BIN = np.deg2rad(10.0)


@compiled
def spherical_bins(
    vertices: NDArray[np.float64],
    origin: NDArray[np.float64],
    radius_bin: float,
    angle_bin: float,
    theta_bins: int,
    phi_bins: int,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Counts over r, theta and phi (eq. 1) around an origin.

    Where the printed formulas divide by zero or lose a sign: theta = atan2(y, x), which is pi for y = 0, x < 0;
    phi = pi / 2 at r = 0.
    """
    n = len(vertices)
    far = np.empty(n, np.int64)
    most = 0
    theta = np.zeros(theta_bins, np.int64)
    phi = np.zeros(phi_bins, np.int64)
    for i in range(n):
        x, y, z = vertices[i, 0] - origin[0], vertices[i, 1] - origin[1], vertices[i, 2] - origin[2]
        r = np.sqrt(x * x + y * y + z * z)
        far[i] = min(int(r / radius_bin), 99_999)
        most = max(most, far[i])
        theta[min(int((np.arctan2(y, x) + np.pi) / angle_bin), theta_bins - 1)] += 1
        steep = np.arccos(min(max(z / r, -1.0), 1.0)) if r > 0.0 else np.pi / 2
        phi[min(int(steep / angle_bin), phi_bins - 1)] += 1
    radius = np.zeros(most + 1, np.int64)
    for i in range(n):
        radius[far[i]] += 1
    return radius, theta, phi


class SphericalHistograms:
    """Collects the printed features frame by frame.

    The origin is the mean vertex of the first frame, for the whole sequence. Each histogram is kept as shares (sums
    to 1): with counts, frames would differ by their number of vertices before anything else. The number of bins of r
    varies from frame to frame (J in eq. 3 and 4); shorter ones are padded with zeros.
    """

    def __init__(self, *, origin: NDArray[np.float64] | None, radius_bin: float | None, angle_bin: float) -> None:
        self.origin, self.radius_bin, self.angle_bin = origin, radius_bin, angle_bin
        self.theta_bins = max(1, int(np.ceil(2 * np.pi / angle_bin - 1e-9)))
        self.phi_bins = max(1, int(np.ceil(np.pi / angle_bin - 1e-9)))
        self.radii: list[NDArray[np.float32]] = []
        self.angles: list[NDArray[np.float32]] = []

    def add(self, vertices: NDArray[np.float64]) -> None:
        """Take the next frame's vertices (v, 3)."""
        if self.origin is None:
            self.origin = vertices.mean(axis=0)
        if self.radius_bin is None:
            # 5 cm on a person of 1.75 m, whatever the unit.
            extent = float(np.ptp(vertices, axis=0).max())
            self.radius_bin = extent / 35.0 if extent > 0 else 1.0
        radius, theta, phi = spherical_bins(
            vertices, self.origin, self.radius_bin, self.angle_bin, self.theta_bins, self.phi_bins
        )
        self.radii.append((radius / len(vertices)).astype(np.float32))
        self.angles.append((np.concatenate([theta, phi]) / len(vertices)).astype(np.float32))

    def features(self) -> Features:
        """Give the features of all frames taken."""
        most = max(len(radius) for radius in self.radii)
        padded = np.zeros((len(self.radii), most), np.float32)
        for row, radius in zip(padded, self.radii, strict=True):
            row[: len(radius)] = radius
        histograms = np.concatenate([padded, np.array(self.angles)], axis=1)
        assert self.origin is not None
        return Features(
            "paper", histograms, (most, self.theta_bins, self.phi_bins), np.asarray(self.origin, np.float64)
        )
