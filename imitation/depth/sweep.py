# mypy: disable-error-code="untyped-decorator"
"""Plane sweep: how badly each plane of a pencil explains each pixel, measured in several other frames.

Cost of a pixel and a plane in one view (TAD): truncated differences of intensity, less its local mean so that a
drifting exposure does no harm, and of the gradient, averaged over 3 x 3 pixels. Of all views that see the place, the
mean of the best ones counts: a view in which the place is hidden must not speak.
"""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.spans import TILE, every_plane
from imitation.progress import Progress, silent

INTENSITY, GRADIENT = 0.35, 0.65  # shares of the two differences in the cost
INTENSITY_CUT, GRADIENT_CUT = 20.0, 12.0  # grey levels from which a difference is as bad as can be
SHARE = 0.75  # of the views that see a place: the best are averaged
NEUTRAL = 128  # cost where nothing can be said: no view sees the place, or the subject hides it
UNLIKELY = 255  # cost of a plane that is not tried
FLOOR = 0.3  # what the geometric prior leaves at least of a likelihood
ENOUGH = 5  # of the 9 pixels round a place must be seen
MOST_VIEWS = 8
BAND = 16  # rows

_ONE = 4096  # one pixel seen, in a sum that counts pixels in its upper four bits


@attrs.frozen(eq=False)
class Geometry:
    """Where a view sees the reference's pixels: ``a = A (x, y, 1)``, ``(u, v) ~ a + w b`` for inverse depth w.

    Attributes
    ----------
    A : float32 (n, 3, 3). b : float32 (n, 3).
    back_b : b of the way back, from each view to the reference.
    """

    A: NDArray[np.float32]
    b: NDArray[np.float32]
    back_b: NDArray[np.float32]


def geometry(
    reference: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    views: list[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]],
) -> Geometry:
    """Maps between cameras (K, R, T) and the views."""

    def between(first: Any, second: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        (K1, R1, T1), (K2, R2, T2) = first, second
        turn = R2 @ R1.T
        return K2 @ turn @ np.linalg.inv(K1), K2 @ (T2 - turn @ T1)

    there = [between(reference, view) for view in views]
    back = [between(view, reference) for view in views]
    stacks = ([A for A, _ in there], [b for _, b in there], [b for _, b in back])
    return Geometry(*(np.ascontiguousarray(stack, np.float32) for stack in stacks))


def sweep(
    signal: NDArray[np.float32],
    hidden: NDArray[np.uint8],
    views: NDArray[np.float32],
    maps: Geometry,
    planes: NDArray[np.float32],
    prior: NDArray[np.float32] | None = None,
    sigma: float = 1.0,
    spans: NDArray[np.int16] | None = None,
    progress: Progress = silent,
) -> NDArray[np.uint8]:
    """Cost volume (h, w, d), 0 to 255.

    Parameters
    ----------
    signal : (h, w, 4) intensity less its local mean, its two gradients, 1 where masked; grey levels.
    hidden : (h, w) 1 where the subject hides the background: every plane costs the same there.
    views : (n, h, w, 4) the same of at most ``MOST_VIEWS`` other frames.
    maps : where the views see the pixels.
    planes : (d,) inverse depths of the planes, evenly spaced.
    prior : (n, h, w) inverse depth known in each view, 0 where none: a plane that would be seen where another depth is
        known loses likelihood with the round-trip error in pixels, scale ``sigma``, at most 1 - ``FLOOR`` of it.
    spans : which planes are tried in each tile, see ``likely_planes``; the others cost ``UNLIKELY``. None tries all.
    progress : gets fractions every few rows; may raise ``Cancelled``.
    """
    height, width = hidden.shape
    volume = np.empty((height, width, len(planes)), np.uint8)
    known = np.zeros((len(views), 1, 1), np.float32) if prior is None else prior
    network = np.array(_network(MOST_VIEWS), np.int64)
    tried = every_plane((width, height), len(planes)) if spans is None else spans
    row = np.zeros((width + 2, len(planes)), np.uint16)
    sums = np.zeros((3, len(views), width, len(planes)), np.uint16)
    for first, last in bands(height + 1):
        progress(first / (height + 1))
        _sweep(
            signal, hidden, views, maps.A, maps.b, maps.back_b, planes, known, prior is not None,
            np.float32(1 / (2 * sigma * sigma)), network, tried, volume, row, sums, first, last,
        )  # fmt: skip
    return volume


def bands(rows: int) -> list[tuple[int, int]]:
    """First row and row after the last of each band, between which a computation looks up whether to stop."""
    return [(first, min(first + BAND, rows)) for first in range(0, rows, BAND)]


def _network(count: int) -> list[tuple[int, int]]:
    """Pairs to compare and exchange that sort ``count`` values (Batcher's odd-even merge; count a power of two)."""
    pairs = []
    p = 1
    while p < count:
        k = p
        while k >= 1:
            for j in range(k % p, count - k, 2 * k):
                ends = range(j, j + min(k, count - j - k))
                pairs += [(i, i + k) for i in ends if i // (2 * p) == (i + k) // (2 * p)]
            k //= 2
        p *= 2
    return pairs


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz", "arcp"})
def _raw(
    signal: Any, view: Any, y: int, A: Any, b: Any, back_b: Any, planes: Any, known: Any, guided: bool, tight: Any,
    needed: Any, row: Any,
) -> None:  # fmt: skip
    """Cost of each pixel of a row and each needed plane in one view, plus ``_ONE`` where it is seen, else 0."""
    height, width = signal.shape[0], signal.shape[1]
    wide, high = np.float32(width - 1.001), np.float32(height - 1.001)
    half = np.float32(0.5)
    one, nothing = np.float32(1), np.float32(0)
    low = np.float32(INTENSITY_CUT)
    steep = np.float32(GRADIENT_CUT)
    weigh_i = np.float32(255 * INTENSITY / INTENSITY_CUT)
    weigh_g = np.float32(255 * GRADIENT / GRADIENT_CUT)
    for x in range(width):
        first, last = needed[x, 0], needed[x, 1]
        if signal[y, x, 3] > 0:
            row[x + 1, first:last] = 0
            continue
        fx, fy = np.float32(x), np.float32(y)
        a0 = A[0, 0] * fx + A[0, 1] * fy + A[0, 2]
        a1 = A[1, 0] * fx + A[1, 1] * fy + A[1, 2]
        a2 = A[2, 0] * fx + A[2, 1] * fy + A[2, 2]
        s0, s1, s2 = signal[y, x, 0], signal[y, x, 1], signal[y, x, 2]
        # How far the pixel seen from the view moves when the view's inverse depth changes.
        p0, p1 = back_b[0] - fx * back_b[2], back_b[1] - fy * back_b[2]
        speed = (p0 * p0 + p1 * p1) * tight
        # Slices, since an index that might be negative keeps loops from running several planes at once.
        some, out = planes[first:last], row[x + 1, first:last]
        for d in range(some.shape[0]):
            w = some[d]
            z = a2 + w * b[2]
            if z <= nothing:
                out[d] = 0
                continue
            over = one / z
            u, v = (a0 + w * b[0]) * over, (a1 + w * b[1]) * over
            if not (u >= nothing and v >= nothing and u < wide and v < high):
                out[d] = 0
                continue
            iu, iv = int(u), int(v)
            q, r = u - np.float32(iu), v - np.float32(iv)
            c11 = q * r
            c01, c10 = q - c11, r - c11
            c00 = one - q - c10
            if view[iv, iu, 3] + view[iv, iu + 1, 3] + view[iv + 1, iu, 3] + view[iv + 1, iu + 1, 3] > nothing:
                out[d] = 0
                continue
            i = c00 * view[iv, iu, 0] + c01 * view[iv, iu + 1, 0] + c10 * view[iv + 1, iu, 0]
            i += c11 * view[iv + 1, iu + 1, 0]
            g = c00 * view[iv, iu, 1] + c01 * view[iv, iu + 1, 1] + c10 * view[iv + 1, iu, 1]
            g += c11 * view[iv + 1, iu + 1, 1]
            h = c00 * view[iv, iu, 2] + c01 * view[iv, iu + 1, 2] + c10 * view[iv + 1, iu, 2]
            h += c11 * view[iv + 1, iu + 1, 2]
            cost = weigh_i * min(abs(i - s0), low) + weigh_g * min(abs(g - s1) + abs(h - s2), steep)
            if guided:
                there = known[int(v + half), int(u + half)]
                if there > nothing:
                    # z1 / z2 = 1 / z: the inverse depth of the plane in the view is w / z.
                    apart = there - w * over
                    back = over + apart * back_b[2]
                    e = speed * apart * apart / (back * back)
                    # exp(-e) where it is above the floor, by (1 - e / 8)^8.
                    keep = np.float32(FLOOR)
                    if e < np.float32(1.35):
                        keep = one - e * np.float32(0.125)
                        keep *= keep
                        keep *= keep
                        keep *= keep
                        keep = max(keep, np.float32(FLOOR))
                    cost = np.float32(255) - (np.float32(255) - cost) * keep
            out[d] = np.uint16(cost + half) + np.uint16(_ONE)


@njit(cache=True, nogil=True, error_model="numpy")
def _across(row: Any, needed: Any, out: Any) -> None:
    """Sum over three neighbouring pixels of a row, of the needed planes."""
    for x in range(out.shape[0]):
        first, last = needed[x, 0], needed[x, 1]
        left, middle, right = row[x, first:last], row[x + 1, first:last], row[x + 2, first:last]
        total = out[x, first:last]
        for d in range(total.shape[0]):
            total[d] = np.uint16(left[d] + middle[d]) + right[d]


@njit(cache=True, nogil=True, error_model="numpy")
def _mean(sums: Any, rows: Any, x: int, first: int, last: int, count: int, values: Any, seen: Any) -> None:
    """Mean cost (8, d) of a pixel's surroundings in each view, 4095 where too little is seen; how many views see it."""
    depth = last - first
    seen[:depth] = 0
    for n in range(values.shape[0]):
        out = values[n, :depth]
        if n >= count:
            out[:] = 4095
            continue
        above, here = sums[rows[0], n, x, first:last], sums[rows[1], n, x, first:last]
        below = sums[rows[2], n, x, first:last]
        for d in range(out.shape[0]):
            total = np.uint16(np.uint16(above[d] + here[d]) + below[d])
            number = np.float32(total >> 12)
            mean = np.float32(total & 4095) / max(number, np.float32(1)) + np.float32(0.5)
            good = number >= np.float32(ENOUGH)
            out[d] = np.int16(mean) if good else np.int16(4095)
            seen[d] += np.int16(1) if good else np.int16(0)


@njit(cache=True, nogil=True, error_model="numpy")
def _best_share(values: Any, seen: Any, network: Any, total: Any, out: Any) -> None:
    """Mean of the best ``SHARE`` of the views (values is sorted in place)."""
    depth = out.shape[0]
    for k in range(network.shape[0]):
        low, high = values[network[k, 0], :depth], values[network[k, 1], :depth]
        for d in range(depth):
            a, b = low[d], high[d]
            low[d] = min(a, b)
            high[d] = max(a, b)
    total[:depth] = 0
    for n in range(values.shape[0]):
        row = values[n, :depth]
        for d in range(depth):
            # The n-th best counts when n < SHARE * seen, rounded up.
            used = np.float32(n) < np.float32(SHARE) * np.float32(seen[d])
            total[d] += row[d] if used else np.int16(0)
    for d in range(depth):
        number = np.float32(np.int16(np.float32(SHARE) * np.float32(seen[d]) + np.float32(0.9999)))
        mean = np.float32(total[d]) / max(number, np.float32(1)) + np.float32(0.5)
        # A measured cost is never the neutral one, so that what no view sees can be told from it.
        cost = np.uint8(mean) if np.uint8(mean) != np.uint8(NEUTRAL) else np.uint8(NEUTRAL + 1)
        out[d] = cost if seen[d] > 0 else np.uint8(NEUTRAL)


@njit(cache=True, nogil=True, error_model="numpy")
def _needed(spans: Any, y: int, height: int, across: int, needed: Any) -> None:
    """Planes (w, 2) of a row that the rows above and below and pixels up to ``across`` aside ask for."""
    width = needed.shape[0]
    top, bottom = max(0, y - 1) // TILE, min(height - 1, y + 1) // TILE
    for x in range(width):
        left, right = max(0, x - across) // TILE, min(width - 1, x + across) // TILE
        first, last = spans[top, left, 0], spans[top, left, 1]
        for j in range(top, bottom + 1):
            for i in range(left, right + 1):
                first, last = min(first, spans[j, i, 0]), max(last, spans[j, i, 1])
        needed[x, 0], needed[x, 1] = first, last


@njit(cache=True, nogil=True, error_model="numpy")
def _sweep(
    signal: Any, hidden: Any, views: Any, A: Any, b: Any, back_b: Any, planes: Any, known: Any, guided: bool,
    tight: Any, network: Any, spans: Any, volume: Any, row: Any, sums: Any, begin: int, end: int,
) -> None:  # fmt: skip
    """Rows ``begin`` to ``end`` - 1, one after the last of the picture too; ``sums`` holds the three last rows."""
    height, width = hidden.shape
    count, depth = views.shape[0], planes.shape[0]
    values = np.empty((8, depth), np.int16)
    seen = np.empty(depth, np.int16)
    total = np.empty(depth, np.int16)
    # Planes of a row's pixels: of which costs are needed, and of which the sums across.
    costs, sides = np.empty((width, 2), np.int64), np.empty((width, 2), np.int64)
    rows = np.zeros(3, np.int64)
    for y in range(begin, end):
        into = y % 3
        if y < height:
            _needed(spans, y, height, 1, costs)
            _needed(spans, y, height, 0, sides)
            for n in range(count):
                _raw(signal, views[n], y, A[n], b[n], back_b[n], planes, known[n], guided, tight, costs, row)
                _across(row, sides, sums[into, n])
        else:
            sums[into] = 0
        if y == 0:
            continue
        for k in range(3):
            rows[k] = (y + k) % 3
        for x in range(width):
            if hidden[y - 1, x]:
                volume[y - 1, x, :] = NEUTRAL
                continue
            first, last = np.int64(spans[(y - 1) // TILE, x // TILE, 0]), np.int64(spans[(y - 1) // TILE, x // TILE, 1])
            volume[y - 1, x, :first], volume[y - 1, x, last:] = UNLIKELY, UNLIKELY
            _mean(sums, rows, x, first, last, count, values, seen)
            _best_share(values, seen, network, total, volume[y - 1, x, first:last])
