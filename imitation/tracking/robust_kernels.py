"""Compiled pieces of the robust mode: window correlation, search for look-alikes, cheapest chain of candidates."""

# mypy: disable-error-code="no-untyped-def,assignment"
from __future__ import annotations

import numpy as np
from numba import njit

from imitation.tracking.kernels import FAST, clamp, flow_at, outside_mask, read_colours

FLATNESS = 100.0  # added to norms, so that windows without texture match nothing


@njit(cache=True, nogil=True)
def make_template(image, x, y, half):
    """Window (3, s, s) around (x, y) with the mean of each channel taken off, and its norm."""
    size = 2 * half + 1
    template = np.empty((3, size, size), np.float32)
    read_colours(image, x, y, half, template)
    energy = 0.0
    for channel in range(3):
        template[channel] -= template[channel].mean()
        energy += (template[channel] ** 2).sum()
    return template, np.sqrt(energy)


@njit(cache=True, nogil=True, fastmath=FAST)
def correlate(window, template, norm):
    """Zero-mean normalised correlation of a raw window (3, s, s) with a template; 0 for flat windows."""
    size = window.shape[1]
    area = size * size
    product, energy = np.float32(0), np.float32(0)
    for channel in range(3):
        total, square = np.float32(0), np.float32(0)
        for j in range(size):
            for i in range(size):
                value = window[channel, j, i] - np.float32(128)
                total += value
                square += value * value
                product += value * template[channel, j, i]
        energy += square - total * total / area
    return product / ((np.sqrt(max(energy, np.float32(0))) + FLATNESS) * (norm + FLATNESS))


@njit(cache=True, nogil=True)
def describe(image, places, count, left, left_norm, right, right_norm, weight, half, mask, out):
    """Correlation of each place with both templates and its data cost: out[:, 0..2] = (cost, left, right)."""
    window = np.empty((3, 2 * half + 1, 2 * half + 1), np.float32)
    for k in range(count):
        x, y = places[k, 0], places[k, 1]
        read_colours(image, x, y, half, window)
        a = correlate(window, left, left_norm) if weight > 0 else 0.0
        b = correlate(window, right, right_norm) if weight < 1 else 0.0
        miss = weight * (1 - a) + (1 - weight) * (1 - b)
        out[k, 0] = 6 * min(miss, 0.7) + 10 * outside_mask(mask, x, y)
        out[k, 1], out[k, 2] = a, b


@njit(cache=True, nogil=True)
def flows_at(bits, table, scale, places, count, mask, out):
    """Dense flow at each place into out (k, 2)."""
    for k in range(count):
        out[k, 0], out[k, 1] = flow_at(bits, table, scale, places[k, 0], places[k, 1], mask)


@njit(cache=True, nogil=True, fastmath=FAST)
def _coarse_scores(image, cx, cy, radius, template, norm, half):
    """Correlation at whole pixels of a coarse level around (cx, cy): (2 radius + 1)^2, -1 outside the picture."""
    height, width = image.shape[0], image.shape[1]
    side, size = 2 * radius + 1, 2 * half + 1
    wide = side + size - 1
    region = np.empty((3, wide, wide), np.float32)
    for j in range(wide):
        row = image[clamp(cy - radius - half + j, 0, height - 1)]
        for i in range(wide):
            k = clamp(cx - radius - half + i, 0, width - 1)
            for channel in range(3):
                region[channel, j, i] = np.float32(row[k, channel]) - np.float32(128)
    products = np.zeros((side, side), np.float32)
    energies = np.zeros((side, side), np.float32)
    for channel in range(3):
        total = np.zeros((side, side), np.float32)
        across, across_square = np.zeros((wide, side), np.float32), np.zeros((wide, side), np.float32)
        for j in range(wide):
            for b in range(size):
                for i in range(side):
                    value = region[channel, j, i + b]
                    across[j, i] += value
                    across_square[j, i] += value * value
        for j in range(side):
            for b in range(size):
                for i in range(side):
                    total[j, i] += across[j + b, i]
                    energies[j, i] += across_square[j + b, i]
            for a in range(size):
                for b in range(size):
                    factor = template[channel, a, b]
                    for i in range(side):
                        products[j, i] += factor * region[channel, j + a, i + b]
        for j in range(side):
            for i in range(side):
                energies[j, i] -= total[j, i] * total[j, i] / (size * size)
    # The finest level's flatness constant in this window's smaller norm.
    flat = np.float32(FLATNESS * size / 31.0)
    for j in range(side):
        for i in range(side):
            products[j, i] /= (np.sqrt(max(energies[j, i], np.float32(0))) + flat) * (norm + flat)
            if not (0 <= cx - radius + i < width and 0 <= cy - radius + j < height):
                products[j, i] = -1
    return products


@njit(cache=True, nogil=True)
def search(fine, coarse, step, x, y, radius, template, norm, coarse_template, coarse_norm, most, places, count):
    """Append up to ``most`` look-alikes of a template around (x, y) to places; returns the new count.

    Peaks are found at a level ``step`` times coarser, then climbed at full size and placed between pixels by a
    parabola.
    """
    half, coarse_half = (template.shape[1] - 1) // 2, (coarse_template.shape[1] - 1) // 2
    height, width = fine.shape[0], fine.shape[1]
    cx, cy, reach = int(np.rint(x / step)), int(np.rint(y / step)), int(np.ceil(radius / step))
    scores = _coarse_scores(coarse, cx, cy, reach, coarse_template, coarse_norm, coarse_half)
    side = 2 * reach + 1
    window = np.empty((3, 2 * half + 1, 2 * half + 1), np.float32)
    around = np.empty((3, 3))
    for _ in range(most):
        best, bj, bi = 0.2, -1, -1
        for j in range(side):
            for i in range(side):
                if scores[j, i] > best:
                    best, bj, bi = scores[j, i], j, i
        if bj < 0:
            break
        for j in range(max(bj - 1, 0), min(bj + 2, side)):
            for i in range(max(bi - 1, 0), min(bi + 2, side)):
                scores[j, i] = -1
        px, py = int((cx - reach + bi) * step), int((cy - reach + bj) * step)
        px, py = clamp(px, 0, width - 1), clamp(py, 0, height - 1)
        read_colours(fine, px, py, half, window)
        middle = correlate(window, template, norm)
        for climb in range(2 * step + 2):
            stride = 2 if climb < step // 2 else 1
            top, tx, ty = middle, px, py
            for j in range(3):
                for i in range(3):
                    if i == 1 and j == 1:
                        around[j, i] = middle
                        continue
                    read_colours(fine, px + (i - 1) * stride, py + (j - 1) * stride, half, window)
                    around[j, i] = correlate(window, template, norm)
                    qx, qy = px + (i - 1) * stride, py + (j - 1) * stride
                    if around[j, i] > top and 0 <= qx < width and 0 <= qy < height:
                        top, tx, ty = around[j, i], qx, qy
            if tx == px and ty == py and stride == 1:
                break
            px, py, middle = tx, ty, top
        sx = _vertex(around[1, 0], middle, around[1, 2])
        sy = _vertex(around[0, 1], middle, around[2, 1])
        places[count, 0], places[count, 1] = px + sx, py + sy
        count += 1
    return count


@njit(cache=True, nogil=True)
def _vertex(before, middle, after):
    bend = before - 2 * middle + after
    if bend >= -1e-9:
        return 0.0
    return clamp(0.5 * (before - after) / bend, -0.5, 0.5)


@njit(cache=True, nogil=True, inline="always")
def _rho(dx, dy, square):
    return square * np.log(1 + (dx * dx + dy * dy) / square)


@njit(cache=True, nogil=True)
def move_costs(places, counts, ahead, back, frame, square, out):
    """Cost of each move from a candidate of a frame to one of the next: how far it disagrees with both flows."""
    for a in range(counts[frame]):
        ax, ay = places[frame, a, 0], places[frame, a, 1]
        for b in range(counts[frame + 1]):
            dx, dy = places[frame + 1, b, 0] - ax, places[frame + 1, b, 1] - ay
            out[a, b] = 0.5 * _rho(dx - ahead[frame, a, 0], dy - ahead[frame, a, 1], square) + 0.5 * _rho(
                dx + back[frame + 1, b, 0], dy + back[frame + 1, b, 1], square
            )


@njit(cache=True, nogil=True)
def cheapest_chain(places, counts, data, ahead, back, square):
    """Candidate of each frame on the cheapest chain, the chain's move costs, and each frame's margin.

    The margin is how much dearer the best chain becomes that passes more than 8 px away in that frame.
    """
    frames, most = places.shape[0], places.shape[1]
    before = np.full((frames, most), np.inf)
    after = np.full((frames, most), np.inf)
    come = np.zeros((frames, most), np.int64)
    moves = np.empty((frames, most, most))
    for k in range(counts[0]):
        before[0, k] = data[0, k]
    for t in range(1, frames):
        move_costs(places, counts, ahead, back, t - 1, square, moves[t])
        for b in range(counts[t]):
            for a in range(counts[t - 1]):
                cost = before[t - 1, a] + moves[t, a, b]
                if cost < before[t, b]:
                    before[t, b], come[t, b] = cost, a
            before[t, b] += data[t, b]
    chain, steps, margin = np.zeros(frames, np.int64), np.zeros(frames), np.zeros(frames)
    best = np.inf
    for k in range(counts[frames - 1]):
        after[frames - 1, k] = 0
        if before[frames - 1, k] < best:
            best, chain[frames - 1] = before[frames - 1, k], k
    for t in range(frames - 1, 0, -1):
        for a in range(counts[t - 1]):
            for b in range(counts[t]):
                after[t - 1, a] = min(after[t - 1, a], after[t, b] + data[t, b] + moves[t, a, b])
        chain[t - 1] = come[t, chain[t]]
        steps[t] = moves[t, chain[t - 1], chain[t]]
    for t in range(frames):
        margin[t] = np.inf
        x, y = places[t, chain[t], 0], places[t, chain[t], 1]
        for k in range(counts[t]):
            if (places[t, k, 0] - x) ** 2 + (places[t, k, 1] - y) ** 2 > 64:
                margin[t] = min(margin[t], before[t, k] + after[t, k] - best)
    return chain, steps, margin
