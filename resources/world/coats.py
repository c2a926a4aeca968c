"""Coats of those who move: fur and clothes as functions of the place in the rest pose, so that they stick."""

from __future__ import annotations

import numpy as np
from numba import njit

from resources.world.noise import cells, hashed, layers, step


@njit(cache=True, nogil=True, inline="always")
def _mix(a, b, t):  # type: ignore[no-untyped-def]
    return a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t


@njit(cache=True, nogil=True)
def _hair(x, y, z, fp):  # type: ignore[no-untyped-def]
    """Strands along the body, about 1."""
    return 1 + 0.5 * layers(x * 0.5, y * 1.5, z * 1.2, 0.028, 3, fp) + 0.35 * layers(x, y, z, 0.11, 3, fp)


@njit(cache=True, nogil=True)
def hound_fur(x, y, z, fp):  # type: ignore[no-untyped-def]
    """A tricolour hound: white legs and muzzle, tan flanks, a dark saddle, ticked all over; linear RGB."""
    edge = 0.09 * layers(x, y, z, 0.16, 4, fp)
    white, tan, dark = (0.72, 0.66, 0.57), (0.48, 0.22, 0.075), (0.075, 0.05, 0.038)
    colour = tan
    saddle = step(0.545, 0.575, z + 1.2 * edge) * step(-0.45, -0.39, x + edge) * (1 - step(0.26, 0.31, x + edge))
    colour = _mix(colour, dark, saddle)
    front = step(0.24, 0.36, x + edge)
    belly = 1 - step(0.46, 0.485, z + edge + 0.04 * (x < -0.2) - 0.05 * front)
    collar = step(0.37, 0.39, x + 0.5 * edge) * (1 - step(0.46, 0.48, x + 0.4 * edge)) * step(0.5, 0.55, z)
    colour = _mix(colour, white, max(belly, 0.95 * collar))
    blaze = step(0.53, 0.57, x) * step(0.72, 0.75, z) * (1 - step(0.016, 0.024, abs(y + 0.25 * edge)))
    muzzle = step(0.655, 0.69, x + 0.6 * edge)
    colour = _mix(colour, white, max(muzzle, blaze))
    ear = step(0.072, 0.08, abs(y)) * step(0.48, 0.5, x) * step(0.74, 0.77, z)
    colour = _mix(colour, (0.2, 0.085, 0.035), ear)
    colour = _mix(colour, white, 1 - step(-0.76, -0.71, x + edge))
    d, _, name = cells(x * 26, y * 26, z * 26)
    size = 0.16 + 0.34 * name
    tick = 1 - step(size, size + 0.1 + 10 * fp, d)
    if name > 0.62:
        tick = 0.0
    colour = _mix(colour, (0.13, 0.07, 0.04) if colour[0] > 0.15 else (0.3, 0.16, 0.08), 0.85 * tick)
    d, _, name = cells(x * 11 + 3, y * 11, z * 11)
    patch = (1 - step(0.22 + 0.25 * name, 0.3 + 0.25 * name + 6 * fp, d)) * (1.0 if name < 0.4 else 0.0)
    colour = _mix(colour, (0.3, 0.13, 0.05) if colour[0] > 0.15 else (0.19, 0.11, 0.07), 0.8 * patch)
    eye = np.sqrt((x - 0.625) ** 2 + (abs(y) - 0.064) ** 2 + (z - 0.883) ** 2)
    colour = _mix(colour, (0.012, 0.008, 0.006), 1 - step(0.013, 0.017 + fp, eye))
    colour = _mix(colour, (0.02, 0.016, 0.016), step(0.812, 0.822, x) * step(0.785, 0.795, z))
    k = _hair(x, y, z, fp)
    return colour[0] * k, colour[1] * k, colour[2] * k


@njit(cache=True, nogil=True)
def fox_fur(x, y, z, fp):  # type: ignore[no-untyped-def]
    """A fox: russet, dark socks and ear tips, white bib and tail tip; linear RGB, the rest pose in a hound's places."""
    edge = 0.07 * layers(x, y, z, 0.13, 4, fp)
    russet, cream, sock = (0.6, 0.2, 0.045), (0.8, 0.72, 0.6), (0.06, 0.04, 0.035)
    colour = _mix(russet, (0.42, 0.11, 0.025), step(0.6, 0.68, z + edge) * (x < 0.4))
    bib = step(0.28, 0.36, x + edge) * (1 - step(0.52, 0.56, z + edge - 0.35 * max(0.0, x - 0.36)))
    colour = _mix(colour, cream, bib)
    colour = _mix(colour, sock, 1 - step(0.2, 0.25, z + edge))
    cheek = step(0.62, 0.68, x) * (1 - step(0.8, 0.815, z + 0.4 * edge))
    colour = _mix(colour, cream, cheek)
    colour = _mix(colour, cream, 1 - step(-0.74, -0.68, x + edge))
    colour = _mix(colour, sock, step(0.95, 0.98, z + 0.4 * edge) * (x > 0.4))
    eye = np.sqrt((x - 0.743) ** 2 + (abs(y) - 0.078) ** 2 + (z - 0.838) ** 2)
    colour = _mix(colour, (0.015, 0.01, 0.008), max(1 - step(0.02, 0.028, eye), step(0.882, 0.892, x)))
    k = _hair(x, y, z, fp)
    return colour[0] * k, colour[1] * k, colour[2] * k


@njit(cache=True, nogil=True)
def cloth(x, y, z, fp):  # type: ignore[no-untyped-def]
    """A person: checked shirt, jeans, boots, skin and hair; linear RGB."""
    weave = 1 + 0.35 * layers(x, y, z, 0.02, 2, fp) + 0.3 * layers(x, y, z, 0.2, 4, fp)
    side = abs(y)
    head, hand = z > 1.5, side > 0.235 and z < 0.9
    if head or hand:
        colour = (0.56, 0.32, 0.22)
        hair = head and z > 1.6 and (x < 0.045 + 0.03 * layers(x, y, z, 0.05, 3, fp) or z > 1.735)
        if hair:
            k = 0.7 + 1.2 * layers(x * 2, y * 2, z * 0.6, 0.04, 3, fp)
            return 0.12 * k, 0.065 * k, 0.035 * k
        eye = np.sqrt((x - 0.115) ** 2 + (side - 0.035) ** 2 + (z - 1.655) ** 2)
        colour = _mix(colour, (0.03, 0.02, 0.02), 1 - step(0.012, 0.016 + fp, eye))
        k = 1 + 0.3 * layers(x, y, z, 0.05, 3, fp)
        return colour[0] * k, colour[1] * k, colour[2] * k
    if z > 0.98 + 0.01 * layers(x, y, z, 0.1, 2, fp) or side > 0.24:
        u, v = (np.arctan2(y, x) * 0.14 if side < 0.2 else x) / 0.09, z / 0.09
        a = 1.0 if (u % 1.0) < 0.42 else 0.0
        b = 1.0 if (v % 1.0) < 0.42 else 0.0
        thin = 1.0 if (u % 1.0 > 0.68 and u % 1.0 < 0.75) or (v % 1.0 > 0.68 and v % 1.0 < 0.75) else 0.0
        colour = _mix((0.62, 0.5, 0.36), (0.5, 0.055, 0.04), 0.5 * (a + b))
        colour = _mix(colour, (0.05, 0.06, 0.12), 0.8 * thin)
        patch = hashed(int(np.floor(u)), int(np.floor(v)), 3)
        k = weave * (0.85 + 0.3 * patch)
        return colour[0] * k, colour[1] * k, colour[2] * k
    if z > 0.15:
        fade = step(0.05, 0.4, layers(x, y, z, 0.25, 4, fp) + 0.15)
        d, _, name = cells(x * 16, y * 16, z * 16)
        stain = 0.55 * (1 - step(0.2, 0.4 + 8 * fp, d)) * (1.0 if name > 0.6 else 0.0)
        colour = _mix((0.06, 0.1, 0.2), (0.2, 0.29, 0.42), fade)
        colour = _mix(colour, (0.5, 0.46, 0.38), stain)
        return colour[0] * weave, colour[1] * weave, colour[2] * weave
    k = weave if z > 0.03 else 0.5 * weave
    return 0.24 * k, 0.13 * k, 0.06 * k
