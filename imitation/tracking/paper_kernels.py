"""Compiled pieces of the printed mode: window differences, Algorithm 1, one step of the dynamic programming."""

# mypy: disable-error-code="no-untyped-def,assignment"
from __future__ import annotations

from math import floor

import numpy as np
from numba import njit

from imitation.tracking.kernels import FAST, clamp, read_region

MOST = 20  # candidates a frame (paper A, Appendix)


@njit(cache=True, nogil=True, fastmath=FAST)
def _difference(region, row, column, template):
    size, across = template.shape
    total = np.float32(0)
    for j in range(size):
        now, wanted = region[row + j], template[j]
        for i in range(across):
            miss = now[column + i] - wanted[i]
            total += miss * miss
    return total


@njit(cache=True, nogil=True, fastmath=FAST)
def _window_difference(first, second):
    total = np.float32(0)
    for i in range(first.shape[0]):
        miss = first[i] - second[i]
        total += miss * miss
    return total


@njit(cache=True, nogil=True)
def blend_templates(left, right, weight):
    """Template whose squared difference is eq. 13 up to a constant, and that constant (not yet divided by |W|)."""
    mixed = np.empty_like(left)
    rest = 0.0
    for j in range(left.shape[0]):
        for i in range(left.shape[1]):
            a, b = left[j, i], right[j, i]
            mixed[j, i] = weight * a + (1 - weight) * b
            rest += weight * (1 - weight) * (a - b) * (a - b)
    return mixed, rest


@njit(cache=True, nogil=True)
def prune(image, x, y, radius, spacing, left, right, weight, places, windows, costs):
    """Algorithm 1: up to 20 whole pixels of the disc around (x, y) with small e (eq. 13), ``spacing`` apart.

    Fills places (20, 2) in pixels of this level, windows (20, s * 3 s) and costs (20,) = e; returns how many.
    """
    height, width = image.shape[0], image.shape[1]
    size, across = left.shape
    half = (size - 1) // 2
    cx = clamp(int(np.rint(x)), 0, width - 1)
    cy = clamp(int(np.rint(y)), 0, height - 1)
    reach = floor(radius)
    side = 2 * reach + 1
    region = np.empty((side + 2 * half, 3 * (side + 2 * half)), np.float32)
    read_region(image, cx, cy, reach + half, region)
    mixed, rest = blend_templates(left, right, weight)
    scores = np.full(side * side, np.inf, np.float32)
    for j in range(side):
        for i in range(side):
            inside = 0 <= cx - reach + i < width and 0 <= cy - reach + j < height
            if inside and (i - reach) ** 2 + (j - reach) ** 2 <= radius * radius:
                scores[j * side + i] = _difference(region, j, 3 * i, mixed)
    taken = np.zeros(side * side, np.bool_)
    count = 0
    for k in np.argsort(scores, kind="mergesort"):
        if scores[k] == np.inf or count == MOST:
            break
        if taken[k]:
            continue
        row, column = k // side, k % side
        places[count, 0], places[count, 1] = cx - reach + column, cy - reach + row
        costs[count] = (scores[k] + rest) / (size * size)
        for b in range(size):
            windows[count, b * across : (b + 1) * across] = region[row + b, 3 * column : 3 * column + across]
        count += 1
        near = int(spacing)
        for b in range(max(row - near, 0), min(row + near + 1, side)):
            for a in range(max(column - near, 0), min(column + near + 1, side)):
                if (a - column) ** 2 + (b - row) ** 2 < spacing * spacing:
                    taken[b * side + a] = True
    return count


@njit(cache=True, nogil=True)
def advance(
    old_places, old_windows, old_costs, old_count, places, windows, costs, count, area, appearance, motion, scale, come
):
    """One frame of the dynamic programming of eq. 14: costs[k] grows to the cheapest chain that ends in k."""
    for k in range(count):
        best, source = np.inf, 0
        for a in range(old_count):
            dx, dy = (places[k, 0] - old_places[a, 0]) * scale, (places[k, 1] - old_places[a, 1]) * scale
            cost = old_costs[a] + motion * (dx * dx + dy * dy)
            if cost >= best:
                continue
            cost += appearance * _window_difference(old_windows[a], windows[k]) / area
            if cost < best:
                best, source = cost, a
        costs[k] += best
        come[k] = source


@njit(cache=True, nogil=True)
def place_between_pixels(image, x, y, left, right, weight):
    """Vertex of the parabolas through e (eq. 13) at a whole pixel and its four neighbours."""
    size = left.shape[0]
    half = (size - 1) // 2
    region = np.empty((size + 2, 3 * (size + 2)), np.float32)
    read_region(image, int(x), int(y), half + 1, region)
    mixed, _ = blend_templates(left, right, weight)
    middle = _difference(region, 1, 3, mixed)
    a, b = _difference(region, 1, 0, mixed), _difference(region, 1, 6, mixed)
    c, d = _difference(region, 0, 3, mixed), _difference(region, 2, 3, mixed)
    sx = 0.0 if a + b - 2 * middle <= 0 else clamp(0.5 * (a - b) / (a + b - 2 * middle), -0.5, 0.5)
    sy = 0.0 if c + d - 2 * middle <= 0 else clamp(0.5 * (c - d) / (c + d - 2 * middle), -0.5, 0.5)
    return x + sx, y + sy
