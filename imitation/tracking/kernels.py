"""Compiled pieces that both tracking modes share: windows at sub-pixel places, local motion, dense flow at a point."""

# mypy: disable-error-code="no-untyped-def,assignment"
from __future__ import annotations

from math import floor

import numpy as np
from numba import njit

# Reassociation lets sums run in vector registers; NaN and infinity keep their meaning.
FAST = {"reassoc", "contract", "nsz", "arcp"}
HALF_TO_FLOAT = np.arange(65536, dtype=np.uint16).view(np.float16).astype(np.float32)
HALF_TO_FLOAT[~np.isfinite(HALF_TO_FLOAT)] = 0


@njit(cache=True, nogil=True, inline="always")
def clamp(value, low, high):
    """Bound a value."""
    return low if value < low else (high if value > high else value)


@njit(cache=True, nogil=True, fastmath=FAST)
def read_colours(image, x, y, half, out):
    """Copy the window of (2 half + 1)^2 pixels around (x, y), bilinear, into out (s, 3 s); edges are repeated.

    The channels stay side by side, so that every loop over a row runs in vector registers.
    """
    height, width = image.shape[0], image.shape[1]
    x = clamp(x, -half, width - 1.0 + half)
    y = clamp(y, -half, height - 1.0 + half)
    x0, y0 = floor(x), floor(y)
    fx, fy = np.float32(x - x0), np.float32(y - y0)
    a, b = (1 - fx) * (1 - fy), fx * (1 - fy)
    c, d = (1 - fx) * fy, fx * fy
    size = 2 * half + 1
    if x0 - half >= 0 and y0 - half >= 0 and x0 + half + 1 < width and y0 + half + 1 < height:
        flat = image.reshape(height, 3 * width)
        left, right = 3 * (x0 - half), 3 * (x0 + half + 2)
        for j in range(size):
            upper, lower, row = flat[y0 - half + j, left:right], flat[y0 - half + j + 1, left:right], out[j]
            for i in range(3 * size):
                row[i] = a * upper[i] + b * upper[i + 3] + c * lower[i] + d * lower[i + 3]
        return
    for j in range(size):
        upper = image[clamp(y0 - half + j, 0, height - 1)]
        lower = image[clamp(y0 - half + j + 1, 0, height - 1)]
        for i in range(size):
            k, n = clamp(x0 - half + i, 0, width - 1), clamp(x0 - half + i + 1, 0, width - 1)
            for channel in range(3):
                out[j, 3 * i + channel] = (
                    a * upper[k, channel] + b * upper[n, channel] + c * lower[k, channel] + d * lower[n, channel]
                )


@njit(cache=True, nogil=True, fastmath=FAST)
def read_region(image, cx, cy, reach, out):
    """Copy the whole pixels within ``reach`` of (cx, cy) into out (side, 3 side); edges are repeated."""
    height, width = image.shape[0], image.shape[1]
    side = 2 * reach + 1
    if cx >= reach and cy >= reach and cx + reach < width and cy + reach < height:
        flat = image.reshape(height, 3 * width)
        for j in range(side):
            row, into = flat[cy - reach + j, 3 * (cx - reach) : 3 * (cx + reach + 1)], out[j]
            for i in range(3 * side):
                into[i] = row[i]
        return
    for j in range(side):
        source = image[clamp(cy - reach + j, 0, height - 1)]
        for i in range(side):
            k = clamp(cx - reach + i, 0, width - 1)
            for channel in range(3):
                out[j, 3 * i + channel] = source[k, channel]


@njit(cache=True, nogil=True, fastmath=FAST)
def read_grey(image, x, y, half, out):
    """Copy the grey window of (2 half + 1)^2 pixels around (x, y), bilinear, into out (s, s); edges are repeated."""
    height, width = image.shape
    x = clamp(x, -half, width - 1.0 + half)
    y = clamp(y, -half, height - 1.0 + half)
    x0, y0 = floor(x), floor(y)
    fx, fy = np.float32(x - x0), np.float32(y - y0)
    a, b = (1 - fx) * (1 - fy), fx * (1 - fy)
    c, d = (1 - fx) * fy, fx * fy
    size = 2 * half + 1
    if x0 - half >= 0 and y0 - half >= 0 and x0 + half + 1 < width and y0 + half + 1 < height:
        for j in range(size):
            upper = image[y0 - half + j, x0 - half : x0 + half + 2]
            lower = image[y0 - half + j + 1, x0 - half : x0 + half + 2]
            for i in range(size):
                out[j, i] = a * upper[i] + b * upper[i + 1] + c * lower[i] + d * lower[i + 1]
        return
    for j in range(size):
        upper = image[clamp(y0 - half + j, 0, height - 1)]
        lower = image[clamp(y0 - half + j + 1, 0, height - 1)]
        for i in range(size):
            k, n = clamp(x0 - half + i, 0, width - 1), clamp(x0 - half + i + 1, 0, width - 1)
            out[j, i] = a * upper[k] + b * upper[n] + c * lower[k] + d * lower[n]


@njit(cache=True, nogil=True, fastmath=FAST)
def _step_at_level(first, second, x, y, gx, gy, half, rounds):
    """Refine the place (gx, gy) in ``second`` of the window at (x, y) in ``first`` (Lucas-Kanade, one level)."""
    size = 2 * half + 1
    wide = np.empty((size + 2, size + 2), np.float32)
    read_grey(first, x, y, half + 1, wide)
    dx, dy = np.empty((size, size), np.float32), np.empty((size, size), np.float32)
    xx = xy = yy = np.float32(0)
    for j in range(size):
        for i in range(size):
            # Scharr's derivative: as near to rotation-invariant as three pixels allow.
            u = (
                3 * (wide[j, i + 2] - wide[j, i] + wide[j + 2, i + 2] - wide[j + 2, i])
                + 10 * (wide[j + 1, i + 2] - wide[j + 1, i])
            ) / 32
            v = (
                3 * (wide[j + 2, i] - wide[j, i] + wide[j + 2, i + 2] - wide[j, i + 2])
                + 10 * (wide[j + 2, i + 1] - wide[j, i + 1])
            ) / 32
            dx[j, i], dy[j, i] = u, v
            xx += u * u
            xy += u * v
            yy += v * v
    determinant = xx * yy - xy * xy
    weakest = (xx + yy - np.sqrt((xx - yy) ** 2 + 4 * xy * xy)) / (2 * size * size)
    if weakest < 0.05 or determinant <= 0:
        return gx, gy
    now = np.empty((size, size), np.float32)
    last_x = last_y = 0.0
    for attempt in range(rounds):
        read_grey(second, gx, gy, half, now)
        bx = by = np.float32(0)
        for j in range(size):
            for i in range(size):
                miss = wide[j + 1, i + 1] - now[j, i]
                bx += miss * dx[j, i]
                by += miss * dy[j, i]
        sx, sy = (yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant
        gx, gy = gx + sx, gy + sy
        if sx * sx + sy * sy < 1e-4:
            break
        if attempt > 0 and abs(sx + last_x) < 0.01 and abs(sy + last_y) < 0.01:
            gx, gy = gx - sx / 2, gy - sy / 2
            break
        last_x, last_y = sx, sy
    return gx, gy


@njit(cache=True, nogil=True)
def local_motion(first, second, x, y, half, rounds):
    """Place in the second grey pyramid of the point (x, y) of the first: pyramidal Lucas-Kanade."""
    levels = len(first)
    gx, gy = x / (1 << (levels - 1)), y / (1 << (levels - 1))
    for back in range(levels):
        level = levels - 1 - back
        image = first[level]
        height, width = image.shape
        sx, sy = x / (1 << level), y / (1 << level)
        tx, ty = _step_at_level(image, second[level], sx, sy, gx, gy, half, rounds)
        if -half <= tx <= width - 1 + half and -half <= ty <= height - 1 + half:
            gx, gy = tx, ty
        if level:
            gx, gy = 2 * gx, 2 * gy
    return gx, gy


@njit(cache=True, nogil=True)
def flow_at(bits, table, scale, x, y, mask):
    """Flow (u, v), picture pixels, at (x, y) of the picture; mean over the mask in 7 x 7 where one is given."""
    height, width = bits.shape[0], bits.shape[1]
    if mask.shape[0] > 0:
        column, row = floor(x + 0.5), floor(y + 0.5)
        su = sv = 0.0
        found = 0
        for j in range(max(row - 3, 0), min(row + 4, mask.shape[0])):
            for i in range(max(column - 3, 0), min(column + 4, mask.shape[1])):
                if mask[j, i]:
                    b, a = min(j // scale, height - 1), min(i // scale, width - 1)
                    su += table[bits[b, a, 0]]
                    sv += table[bits[b, a, 1]]
                    found += 1
        if found > 0:
            return su / found, sv / found
    fx = clamp((x + 0.5) / scale - 0.5, 0.0, width - 1.0)
    fy = clamp((y + 0.5) / scale - 0.5, 0.0, height - 1.0)
    x0, y0 = int(fx), int(fy)
    x1, y1 = min(x0 + 1, width - 1), min(y0 + 1, height - 1)
    fx, fy = fx - x0, fy - y0
    a, b, c, d = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
    u = (
        a * table[bits[y0, x0, 0]]
        + b * table[bits[y0, x1, 0]]
        + c * table[bits[y1, x0, 0]]
        + d * table[bits[y1, x1, 0]]
    )
    v = (
        a * table[bits[y0, x0, 1]]
        + b * table[bits[y0, x1, 1]]
        + c * table[bits[y1, x0, 1]]
        + d * table[bits[y1, x1, 1]]
    )
    return u, v


@njit(cache=True, nogil=True)
def outside_mask(mask, x, y):
    """How far (x, y) lies outside the mask, as a ramp: 0 up to 3 px, 1 from 8 px on; 0 where no mask is given."""
    if mask.shape[0] == 0:
        return 0.0
    column, row = floor(x + 0.5), floor(y + 0.5)
    nearest = 1e9
    for j in range(max(row - 8, 0), min(row + 9, mask.shape[0])):
        for i in range(max(column - 8, 0), min(column + 9, mask.shape[1])):
            if mask[j, i]:
                nearest = min(nearest, (i - x) ** 2 + (j - y) ** 2)
    return clamp((np.sqrt(nearest) - 3.0) / 5.0, 0.0, 1.0)
