# mypy: disable-error-code="untyped-decorator"
"""The compiled loop of finding points again: a warped patch fitted in a picture."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

RADIUS = 7  # pixels of the window that is compared
REACH = 14  # pixels of the patch, so that a shrunk and turned window still lies in it
ROUNDS, STILL = 20, 1e-4  # steps of the fit; squared pixels: a step that ends it
FLAT = 4.0  # variance below which a window says nothing
SLIDES = 1e-6  # determinant over squared trace of an edge, along which a fit slides


@njit(cache=True, nogil=True)
def _sample(picture: Any, x: float, y: float) -> float:
    row, column = int(np.floor(y)), int(np.floor(x))
    if row < 0 or column < 0 or row >= picture.shape[0] - 1 or column >= picture.shape[1] - 1:
        return np.nan
    v, u = y - row, x - column
    above = (1 - u) * picture[row, column] + u * picture[row, column + 1]
    below = (1 - u) * picture[row + 1, column] + u * picture[row + 1, column + 1]
    return float((1 - v) * above + v * below)


@njit(cache=True, nogil=True)
def fit(patches: Any, picture: Any, warps: Any, starts: Any, places: Any, alike: Any) -> None:
    """Fit each patch near its start; ``places`` (k, 2) and the correlation ``alike`` (k,), 0 where it cannot be had.

    ``patches`` (k, s, s), s = 2 REACH + 1; ``picture`` (h, w); ``warps`` (k, 2, 2) from steps in the picture to steps
    in the patch; ``starts`` (k, 2), pixels.
    """
    size = 2 * RADIUS + 1
    area = size * size
    wide = np.empty((size + 2, size + 2))
    across, down, seen = np.empty((size, size)), np.empty((size, size)), np.empty((size, size))
    for k in range(len(starts)):
        places[k, 0], places[k, 1] = starts[k, 0], starts[k, 1]
        alike[k] = 0.0
        for i in range(size + 2):
            for j in range(size + 2):
                u, v = j - RADIUS - 1.0, i - RADIUS - 1.0
                wide[i, j] = _sample(
                    patches[k],
                    REACH + warps[k, 0, 0] * u + warps[k, 0, 1] * v,
                    REACH + warps[k, 1, 0] * u + warps[k, 1, 1] * v,
                )
        total = power = xx = xy = yy = 0.0
        for i in range(size):
            for j in range(size):
                across[i, j] = 0.5 * (wide[i + 1, j + 2] - wide[i + 1, j])
                down[i, j] = 0.5 * (wide[i + 2, j + 1] - wide[i, j + 1])
                xx += across[i, j] ** 2
                xy += across[i, j] * down[i, j]
                yy += down[i, j] ** 2
                total += wide[i + 1, j + 1]
                power += wide[i + 1, j + 1] ** 2
        mean = total / area
        power -= total * mean
        det = xx * yy - xy * xy
        if not power > FLAT * area or not det > SLIDES * (xx + yy) ** 2:  # not-a-numbers end here, too
            continue
        x, y = starts[k, 0], starts[k, 1]
        for _ in range(ROUNDS):
            total = own = common = 0.0
            for i in range(size):
                for j in range(size):
                    value = _sample(picture, x + j - RADIUS, y + i - RADIUS)
                    seen[i, j] = value
                    total += value
                    own += value * value
                    common += value * (wide[i + 1, j + 1] - mean)
            here = total / area
            own -= total * here
            if not own > 1e-3:  # flat, or outside the picture
                alike[k] = 0.0
                break
            alike[k] = common / np.sqrt(own * power)
            gain = common / own
            right = below = 0.0
            for i in range(size):
                for j in range(size):
                    off = gain * (seen[i, j] - here) - (wide[i + 1, j + 1] - mean)
                    right += across[i, j] * off
                    below += down[i, j] * off
            dx, dy = (yy * right - xy * below) / det, (xx * below - xy * right) / det
            x -= dx
            y -= dy
            if dx * dx + dy * dy < STILL:
                break
        places[k, 0], places[k, 1] = x, y
