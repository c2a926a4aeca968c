"""Compiled pieces of the robust mode: window correlation, search for look-alikes, cheapest chain of candidates."""

# mypy: disable-error-code="no-untyped-def,assignment"
from __future__ import annotations

import numpy as np
from numba import njit

from imitation.tracking.kernels import FAST, clamp, flow_at, outside_mask, read_colours, read_region

FLATNESS = 100.0  # added to norms, so that windows without texture match nothing


@njit(cache=True, nogil=True)
def make_template(image, x, y, half):
    """Window (s, 3 s) around (x, y) with the mean of each channel taken off, and its norm."""
    size = 2 * half + 1
    template = np.empty((size, 3 * size), np.float32)
    read_colours(image, x, y, half, template)
    energy = 0.0
    for channel in range(3):
        template[:, channel::3] -= template[:, channel::3].mean()
    for value in template.ravel():
        energy += value * value
    return template, np.sqrt(energy)


@njit(cache=True, nogil=True, fastmath=FAST)
def _spread(totals, square, area):
    """Energy of a window about the mean of each channel, from the sums of its columns and of its squares."""
    means = np.float32(0)
    for channel in range(3):
        total = np.float32(0)
        for i in range(channel, totals.shape[0], 3):
            total += totals[i]
        means += total * total
    return max(square - means / area, np.float32(0))


@njit(cache=True, nogil=True, fastmath=FAST)
def correlate(region, row, column, template, norm, totals):
    """Zero-mean normalised correlation of the window at (row, column) of a region with a template; 0 when flat.

    ``column`` counts channels; ``totals`` (3 s,) is scratch.
    """
    size, across = template.shape
    totals[:] = 0
    product, square = np.float32(0), np.float32(0)
    for j in range(size):
        now, wanted = region[row + j, column : column + across], template[j]
        for i in range(across):
            value = now[i] - np.float32(128)
            totals[i] += value
            square += value * value
            product += value * wanted[i]
    spread = _spread(totals, square, size * size)
    flat = np.float32(FLATNESS * size / 31.0)
    return product / ((np.sqrt(spread) + flat) * (norm + flat))


@njit(cache=True, nogil=True)
def describe(image, places, count, templates, norms, weight, mask, out):
    """Correlation of each place with both templates and its data cost: out[:, 0..2] = (cost, left, right)."""
    size, across = templates.shape[1], templates.shape[2]
    window, totals = np.empty((size, across), np.float32), np.empty(across, np.float32)
    last = templates.shape[0] - 1
    for k in range(count):
        x, y = places[k, 0], places[k, 1]
        read_colours(image, x, y, (size - 1) // 2, window)
        a = correlate(window, 0, 0, templates[0], norms[0], totals) if weight > 0 else 0.0
        b = correlate(window, 0, 0, templates[last], norms[last], totals) if weight < 1 else 0.0
        miss = weight * (1 - a) + (1 - weight) * (1 - b)
        out[k, 0] = 6 * min(miss, 0.7) + 10 * outside_mask(mask, x, y)
        out[k, 1], out[k, 2] = a, b


@njit(cache=True, nogil=True)
def _likeness(image, x, y, templates, norms, weight, window, totals):
    """Blended correlation with both templates at a place, and the greater of the two."""
    last = templates.shape[0] - 1
    read_colours(image, x, y, (templates.shape[1] - 1) // 2, window)
    a = correlate(window, 0, 0, templates[0], norms[0], totals)
    b = correlate(window, 0, 0, templates[last], norms[last], totals) if last else a
    return weight * a + (1 - weight) * b, max(a, b)


@njit(cache=True, nogil=True)
def settle(image, x, y, templates, norms, weight, reach, least):
    """Nearest peak of the likeness within ``reach`` pixels, or (x, y) itself where nothing there is like the clicks.

    Returns x, y and the greater correlation there.
    """
    size, across = templates.shape[1], templates.shape[2]
    window, totals = np.empty((size, across), np.float32), np.empty(across, np.float32)
    top, match = _likeness(image, x, y, templates, norms, weight, window, totals)
    begin, found, px, py = match, match, x, y
    around = np.zeros((3, 3))
    stride = 2.0
    while stride > 0.4:
        bx, by = px, py
        around[1, 1] = top
        for j in range(3):
            for i in range(3):
                if i == 1 and j == 1:
                    continue
                qx, qy = px + (i - 1) * stride, py + (j - 1) * stride
                value, greater = _likeness(image, qx, qy, templates, norms, weight, window, totals)
                around[j, i] = value
                if value > top and (qx - x) ** 2 + (qy - y) ** 2 <= reach * reach:
                    top, found, bx, by = value, greater, qx, qy
        if bx == px and by == py:
            if stride < 0.6:
                px += stride * _vertex(around[1, 0], top, around[1, 2])
                py += stride * _vertex(around[0, 1], top, around[2, 1])
            stride /= 2
        px, py = (bx, by) if stride > 0.4 and (bx != px or by != py) else (px, py)
    if found < least:
        return x, y, begin
    return px, py, found


@njit(cache=True, nogil=True)
def kinship(first, x, y, second, u, v, half):
    """Correlation of the window at (x, y) of one picture with that at (u, v) of another."""
    size = 2 * half + 1
    template, norm = make_template(first, x, y, half)
    window, totals = np.empty((size, 3 * size), np.float32), np.empty(3 * size, np.float32)
    read_colours(second, u, v, half, window)
    return correlate(window, 0, 0, template, norm, totals)


@njit(cache=True, nogil=True)
def flows_at(bits, table, scale, places, count, mask, out):
    """Dense flow at each place into out (k, 2)."""
    for k in range(count):
        out[k, 0], out[k, 1] = flow_at(bits, table, scale, places[k, 0], places[k, 1], mask)


@njit(cache=True, nogil=True, fastmath=FAST)
def _coarse_scores(region, side, template, norm, out):
    """Correlation of a template at all side x side places of a region, into out."""
    size = template.shape[0]
    sums = np.zeros((side, 3 * side), np.float32)
    squares = np.zeros((side, 3 * side), np.float32)
    line, line_square = np.zeros(3 * side, np.float32), np.zeros(3 * side, np.float32)
    products = np.zeros(3 * side, np.float32)
    for j in range(side + size - 1):
        line[:], line_square[:] = 0, 0
        for b in range(size):
            now = region[j, 3 * b : 3 * (b + side)]
            for i in range(3 * side):
                line[i] += now[i]
                line_square[i] += now[i] * now[i]
        for k in range(max(j - size + 1, 0), min(j + 1, side)):
            total, square = sums[k], squares[k]
            for i in range(3 * side):
                total[i] += line[i]
                square[i] += line_square[i]
    flat = np.float32(FLATNESS * size / 31.0)
    for j in range(side):
        products[:] = 0
        for a in range(size):
            row = region[j + a]
            for b in range(size):
                red, green, blue = template[a, 3 * b], template[a, 3 * b + 1], template[a, 3 * b + 2]
                now = row[3 * b : 3 * (b + side)]
                for i in range(side):
                    products[i] += red * now[3 * i] + green * now[3 * i + 1] + blue * now[3 * i + 2]
        for i in range(side):
            spread = np.float32(0)
            for channel in range(3):
                spread += squares[j, 3 * i + channel] - sums[j, 3 * i + channel] ** 2 / (size * size)
            out[j, i] = products[i] / ((np.sqrt(max(spread, np.float32(0))) + flat) * (norm + flat))


@njit(cache=True, nogil=True, inline="always")
def _score(region, row, column, template, norm, totals, known):
    if known[row, column] < -1:
        known[row, column] = correlate(region, row, 3 * column, template, norm, totals)
    return known[row, column]


@njit(cache=True, nogil=True)
def search(fine, coarse, step, x, y, radius, templates, norms, coarse_templates, coarse_norms, most, places, count):
    """Append up to ``most`` look-alikes of each template around (x, y) to places; returns the new count.

    Peaks are found at a level ``step`` times coarser, then climbed at full size and placed between pixels by a
    parabola.
    """
    height, width = fine.shape[0], fine.shape[1]
    size, coarse_size = templates.shape[1], coarse_templates.shape[1]
    half, coarse_half = (size - 1) // 2, (coarse_size - 1) // 2
    cx, cy, reach = int(np.rint(x / step)), int(np.rint(y / step)), int(np.ceil(radius / step))
    cx, cy = clamp(cx, 0, coarse.shape[1] - 1), clamp(cy, 0, coarse.shape[0] - 1)
    side, wide = 2 * reach + 1, (reach + 2) * step
    coarse_region = np.empty((side + 2 * coarse_half, 3 * (side + 2 * coarse_half)), np.float32)
    read_region(coarse, cx, cy, reach + coarse_half, coarse_region)
    coarse_region -= np.float32(128)
    fine_x, fine_y = min(cx * step, width - 1), min(cy * step, height - 1)
    region = np.empty((2 * (wide + half) + 1, 3 * (2 * (wide + half) + 1)), np.float32)
    read_region(fine, fine_x, fine_y, wide + half, region)
    scores, totals = np.empty((side, side), np.float32), np.empty(3 * size, np.float32)
    known = np.empty((2 * wide + 1, 2 * wide + 1), np.float32)
    for which in range(templates.shape[0]):
        template, norm = templates[which], norms[which]
        _coarse_scores(coarse_region, side, coarse_templates[which], coarse_norms[which], scores)
        known[:] = -2
        for _ in range(most):
            best, bj, bi = 0.2, -1, -1
            for j in range(side):
                for i in range(side):
                    if scores[j, i] > best:
                        best, bj, bi = scores[j, i], j, i
            if bj < 0:
                break
            scores[max(bj - 1, 0) : bj + 2, max(bi - 1, 0) : bi + 2] = -1
            row, column = bj * step + wide - reach * step, bi * step + wide - reach * step
            row, column = _climb(region, row, column, template, norm, totals, known, step // 2)
            px, py = fine_x - wide + column, fine_y - wide + row
            if not (0 <= px < width and 0 <= py < height):
                continue
            middle = _score(region, row, column, template, norm, totals, known)
            left = _score(region, row, column - 1, template, norm, totals, known)
            right = _score(region, row, column + 1, template, norm, totals, known)
            above = _score(region, row - 1, column, template, norm, totals, known)
            below = _score(region, row + 1, column, template, norm, totals, known)
            places[count, 0] = px + _vertex(left, middle, right)
            places[count, 1] = py + _vertex(above, middle, below)
            count += 1
    return count


@njit(cache=True, nogil=True)
def _climb(region, row, column, template, norm, totals, known, stride):
    """Go to the best of eight neighbours until there is none better, with shorter and shorter steps."""
    last = known.shape[0] - 2
    while stride > 0:
        top, to_row, to_column = _score(region, row, column, template, norm, totals, known), row, column
        for j in range(max(row - stride, 1), min(row + stride, last) + 1, stride):
            for i in range(max(column - stride, 1), min(column + stride, last) + 1, stride):
                value = _score(region, j, i, template, norm, totals, known)
                if value > top:
                    top, to_row, to_column = value, j, i
        if to_row == row and to_column == column:
            stride //= 2
        row, column = to_row, to_column
    return row, column


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
