"""The compiled soft cylinder histogram of one mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled, compiled_lanes

Array = NDArray[np.float64]

HEIGHT_BINS, RADIUS_BINS, AZIMUTH_BINS = 10, 6, 24
HEIGHT_STEP, RADIUS_STEP = 0.13, 0.10
"""Bin sizes of the robust histogram in body heights; the last radius bin is open."""

TURN = float(AZIMUTH_BINS)
ONE, ROW, LAYER = np.uint64(1), np.uint64(AZIMUTH_BINS + 2), np.uint64((AZIMUTH_BINS + 2) * (RADIUS_BINS + 1))
"""Steps to the next azimuth, radius and height in the padded bins below."""
_AT_ONCE = 512
"""So many vertices are placed before they are counted: they stay in the first-level cache."""


def _arc_tangent() -> Array:
    """Coefficients (9,) of atan(q) / q in powers of q squared, highest first, in azimuth bins, for q from 0 to 1.

    Fitted at Chebyshev points; within 1.2e-8 radians, far below what the float32 of a histogram keeps.
    """
    squares = (np.cos(np.pi * (np.arange(2000) + 0.5) / 2000) + 1.0) / 2.0
    q = np.sqrt(squares)
    values = np.arctan(q) / q * (AZIMUTH_BINS / (2.0 * np.pi))
    fitted = np.polynomial.chebyshev.Chebyshev.fit(squares, values, 8, domain=[0, 1])
    return np.ascontiguousarray(fitted.convert(kind=np.polynomial.Polynomial).coef[::-1])


ARC_TANGENT = _arc_tangent()


def cylinder_histogram(
    vertices: Array, weights: Array, centre_x: float, centre_y: float, floor: float, height: float
) -> NDArray[np.float32]:
    """Soft histogram over height, radius and azimuth around a vertical axis.

    Each vertex shares its weight trilinearly among the eight bins whose centres surround it.

    Parameters
    ----------
    vertices : (v, 3) float64
        z up.
    weights : (v,) float64
        Not negative, of positive sum.
    centre_x, centre_y, floor, height : float
        The axis, z of the ground, and the body height that lengths are divided by.

    Returns
    -------
    (10, 6, 24) float32
        Square roots of shares: their squares sum to 1.
    """
    return _counted(vertices, weights, (centre_x, centre_y, floor), height, ARC_TANGENT)


@compiled_lanes
def _place(
    vertices: Array, first: int, many: int, origin: tuple[float, float, float], height: float, arc: Array, places: Array
) -> None:  # pragma: no cover - compiled
    """Places (3, many) of vertices from ``first`` on, in bins: height, radius, azimuth from -pi on, not negative."""
    per_height, per_radius = 1.0 / (height * HEIGHT_STEP), 1.0 / (height * RADIUS_STEP)
    for i in range(many):
        x, y = vertices[first + i, 0] - origin[0], vertices[first + i, 1] - origin[1]
        places[0, i] = (vertices[first + i, 2] - origin[2]) * per_height - 0.5
        places[1, i] = np.sqrt(x * x + y * y) * per_radius - 0.5
        # The library's arc tangent of two numbers took most of the time: it goes one by one, this goes side by side.
        across, along = abs(x), abs(y)
        longer = across if across > along else along
        shorter = along if across > along else across
        q = shorter / (longer + 1e-300)
        s = q * q
        a = arc[0] * s + arc[1]
        a = ((((a * s + arc[2]) * s + arc[3]) * s + arc[4]) * s + arc[5]) * s + arc[6]
        a = ((a * s + arc[7]) * s + arc[8]) * q
        a = TURN / 4 - a if along > across else a
        a = TURN / 2 - a if x < 0.0 else a
        a = TURN - a if y < 0.0 else a
        places[2, i] = a + 0.5


@compiled
def _counted(
    vertices: Array, weights: Array, origin: tuple[float, float, float], height: float, arc: Array
) -> NDArray[np.float32]:  # pragma: no cover - compiled
    # Padded by a column on either side of the azimuth, a row and a layer: neighbours need no test for the end.
    row = AZIMUTH_BINS + 2
    layer = (RADIUS_BINS + 1) * row
    bins = np.zeros((HEIGHT_BINS + 1) * layer)
    places = np.empty((3, _AT_ONCE))
    for first in range(0, len(vertices), _AT_ONCE):
        many = min(_AT_ONCE, len(vertices) - first)
        _place(vertices, first, many, origin, height, arc, places)
        for i in range(many):
            z = min(max(places[0, i], 0.0), HEIGHT_BINS - 1.0)
            r = min(max(places[1, i], 0.0), RADIUS_BINS - 1.0)
            a = places[2, i]
            z0, r0, a0 = np.int32(z), np.int32(r), np.int32(a)
            zf, rf, af = z - z0, r - r0, a - a0
            # Unsigned: a negative number would have to be looked for at the end of the array.
            at = np.uint64(z0 * layer + r0 * row + a0)
            high = weights[first + i] * zf
            low = weights[first + i] - high
            high_far, low_far = high * rf, low * rf
            second = (low - low_far) * af
            bins[at] += low - low_far - second
            bins[at + ONE] += second
            second = low_far * af
            bins[at + ROW] += low_far - second
            bins[at + ROW + ONE] += second
            second = (high - high_far) * af
            bins[at + LAYER] += high - high_far - second
            bins[at + LAYER + ONE] += second
            second = high_far * af
            bins[at + LAYER + ROW] += high_far - second
            bins[at + LAYER + ROW + ONE] += second
    wide = bins.reshape(HEIGHT_BINS + 1, RADIUS_BINS + 1, AZIMUTH_BINS + 2)
    shares = wide[:HEIGHT_BINS, :RADIUS_BINS, 1 : AZIMUTH_BINS + 1].copy()
    # The turn closes: what lies before the first bin belongs to the last one, and the other way round.
    shares[:, :, AZIMUTH_BINS - 1] += wide[:HEIGHT_BINS, :RADIUS_BINS, 0]
    shares[:, :, 0] += wide[:HEIGHT_BINS, :RADIUS_BINS, AZIMUTH_BINS + 1]
    rooted: NDArray[np.float32] = np.sqrt(shares / shares.sum()).astype(np.float32)
    return rooted
