"""Procedural noise, compiled: deterministic, and faded out where it would be finer than a pixel."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, inline="always")  # type: ignore[untyped-decorator]
def hashed(x: int, y: int, z: int) -> float:
    """A number in [0, 1) for an integer place."""
    h = (x * 374761393 + y * 668265263 + z * 2147483647) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 2246822519) & 0xFFFFFFFF
    return ((h ^ (h >> 13)) & 0xFFFFFF) / 16777216.0


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def noise(x: float, y: float, z: float) -> float:
    """Smooth value noise in [0, 1], one lump a unit."""
    fx, fy, fz = np.floor(x), np.floor(y), np.floor(z)
    i, j, k = int(fx), int(fy), int(fz)
    u, v, w = x - fx, y - fy, z - fz
    u, v, w = u * u * (3 - 2 * u), v * v * (3 - 2 * v), w * w * (3 - 2 * w)
    a = hashed(i, j, k) * (1 - u) + hashed(i + 1, j, k) * u
    b = hashed(i, j + 1, k) * (1 - u) + hashed(i + 1, j + 1, k) * u
    c = hashed(i, j, k + 1) * (1 - u) + hashed(i + 1, j, k + 1) * u
    d = hashed(i, j + 1, k + 1) * (1 - u) + hashed(i + 1, j + 1, k + 1) * u
    total: float = (a * (1 - v) + b * v) * (1 - w) + (c * (1 - v) + d * v) * w
    return total


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def layers(x: float, y: float, z: float, size: float, octaves: int, footprint: float) -> float:
    """Noise of ``octaves`` layers about 0 (roughly -0.5 to 0.5), the coarsest with lumps of ``size`` metres.

    A layer whose lumps are smaller than about two pixels (``footprint``: one pixel, metres) fades out.
    """
    total, strength, lump = 0.0, 0.5, size
    for i in range(octaves):
        keep = min(1.0, max(0.0, lump / (footprint + 1e-9) - 1.0))
        if keep <= 0:
            break
        s = 1.0 / lump
        total += keep * strength * (2 * noise(x * s + 17.3 * i, y * s - 9.1 * i, z * s + 5.7 * i) - 1)
        strength *= 0.62
        lump *= 0.47
    return total


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def cells(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Distance to the nearest and second nearest scattered point, one a unit cube, and a number of the nearest."""
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    first, second, name = 9.0, 9.0, 0.0
    for di in range(-1, 2):
        for dj in range(-1, 2):
            for dk in range(-1, 2):
                a, b, c = i + di, j + dj, k + dk
                dx = a + hashed(a, b, c) - x
                dy = b + hashed(a + 91, b, c) - y
                dz = c + hashed(a, b + 57, c) - z
                d = dx * dx + dy * dy + dz * dz
                if d < first:
                    second, first, name = first, d, hashed(a + 13, b + 29, c + 71)
                elif d < second:
                    second = d
    return np.sqrt(first), np.sqrt(second), name


@njit(cache=True, nogil=True, inline="always")  # type: ignore[untyped-decorator]
def step(low: float, high: float, x: float) -> float:
    """From 0 at ``low`` to 1 at ``high``, smoothly."""
    u = min(1.0, max(0.0, (x - low) / (high - low)))
    return u * u * (3 - 2 * u)
