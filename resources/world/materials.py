"""What surfaces look like: albedo (linear RGB), gloss and relief of each material at a place, compiled."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numba import njit

from resources.world.coats import cloth, fox_fur, hound_fur
from resources.world.noise import cells, hashed, layers, step


class Material(IntEnum):
    """Materials by the number that the compiled code uses."""

    PAVING = 0
    STONE = 1
    BRICK = 2
    PLASTER = 3
    IRON = 4
    CLAY = 5
    LEAF = 6
    WOOD = 7
    GRASS = 8
    HOUND = 9
    CLOTH = 10
    BUSY = 11
    WEAK = 12
    GLASS = 13
    SHUTTER = 14
    ROPE = 15
    BARK = 16
    FOX = 17
    HEDGE = 18
    BALL = 19


@njit(cache=True, nogil=True)
def _tiles(u, v, width, height, joint, shift):  # type: ignore[no-untyped-def]
    """How far inside its tile a place is (0 in the joint, 1 inside) and a number of the tile."""
    row = int(np.floor(v / height))
    u = u + shift * (row % 2) * width
    column = int(np.floor(u / width))
    a, b = u - column * width, v - row * height
    edge = min(min(a, width - a), min(b, height - b))
    return step(joint * 0.4, joint * 1.3, edge), hashed(column, row, 7)


@njit(cache=True, nogil=True)
def _wall(x, y, nx):  # type: ignore[no-untyped-def]
    """The coordinate along an upright wall."""
    return y if abs(nx) > 0.7 else x


@njit(cache=True, nogil=True)
def _paving(x, y, z, fp):  # type: ignore[no-untyped-def]
    inside, name = _tiles(x + 0.02 * layers(x, y, 0.0, 0.3, 2, fp), y, 0.62, 0.44, 0.012, 0.5)
    tone = 0.8 + 0.42 * (name - 0.5)
    grain = layers(x, y, z + 9 * name, 0.22, 6, fp)
    speck = layers(x, y, z, 0.025, 2, fp)
    k = tone * (1 + 0.62 * grain + 0.35 * speck)
    moss = (1 - inside) * 0.75
    r, g, b = 0.37 * k, 0.315 * k, 0.245 * k
    warm = 0.09 * (name - 0.5)
    return (r + warm) * (1 - moss) + 0.06 * moss, g * (1 - moss) + 0.07 * moss, (b - warm) * (1 - moss) + 0.03 * moss


@njit(cache=True, nogil=True)
def _stone(x, y, z, nx, nz, fp):  # type: ignore[no-untyped-def]
    if nz > 0.7:
        inside, name = _tiles(y, x, 0.9, 0.32, 0.006, 0.5)
    else:
        inside, name = _tiles(_wall(x, y, nx), z, 0.48, 0.12, 0.007, 0.5)
    vein = layers(x, y, z, 0.35, 6, fp)
    pit = layers(x + 31, y, z, 0.045, 3, fp)
    dirt = step(0.0, 0.35, layers(x, y + 7, z, 0.5, 3, fp))
    k = (0.88 + 0.35 * (name - 0.5)) * (1 + 0.55 * vein + 0.5 * pit) * (1 - 0.35 * dirt) * (0.45 + 0.55 * inside)
    return 0.52 * k, 0.455 * k * (1 + 0.05 * dirt), 0.36 * k


@njit(cache=True, nogil=True)
def _brick(x, y, z, nx, fp):  # type: ignore[no-untyped-def]
    u = _wall(x, y, nx)
    inside, name = _tiles(u, z, 0.235, 0.078, 0.008, 0.5)
    grain = layers(x, y, z + 5 * name, 0.09, 4, fp)
    stain = layers(x, y, z, 1.4, 4, fp)
    k = (0.6 + 0.8 * name) * (1 + 0.55 * grain) * (1 + 0.5 * stain)
    m = 1 - inside
    mortar = 0.33 * (1 + 0.4 * grain)
    hue = 0.08 * (hashed(int(name * 977), 3, 1) - 0.5)
    return (
        (0.33 + hue) * k * inside + mortar * m,
        0.125 * k * inside + mortar * 0.93 * m,
        0.08 * k * inside + mortar * 0.8 * m,
    )


@njit(cache=True, nogil=True)
def _plaster(x, y, z, fp):  # type: ignore[no-untyped-def]
    cloud = layers(x, y, z, 0.9, 5, fp)
    fine = layers(x, y, z, 0.06, 3, fp)
    run = step(0.05, 0.4, layers(x * 3, y * 3, z * 0.35, 0.4, 3, fp)) * step(1.2, 3.0, z)
    crack = 1 - step(0.0, 0.012 + fp, abs(layers(x, y, z + 3, 0.8, 4, 0.0)))
    k = (1 + 0.2 * cloud + 0.22 * fine) * (1 - 0.25 * run) * (1 - 0.3 * crack)
    return 0.64 * k, 0.53 * k, 0.385 * k


@njit(cache=True, nogil=True)
def _grass(x, y, z, fp):  # type: ignore[no-untyped-def]
    patch = layers(x, y, z, 0.8, 4, fp)
    blade = layers(x * 1.0, y * 2.4, z, 0.05, 3, fp)
    dry = step(0.1, 0.5, layers(x + 40, y, z, 1.3, 3, fp))
    k = 1 + 0.5 * patch + 1.0 * blade
    return (0.1 + 0.12 * dry) * k, (0.17 + 0.03 * dry) * k, 0.045 * k


@njit(cache=True, nogil=True)
def _leaf(s0, s1, s2, deep):  # type: ignore[no-untyped-def]
    k = (0.55 + 0.8 * s0) * (0.25 + 0.75 * s1 * s1)
    if s2 > 0.93 and deep == 0:
        return 0.62 * k, 0.1 * k, 0.16 * k
    warm = 0.06 * s2
    return (0.075 + warm) * k, (0.17 + 0.5 * warm) * k, 0.04 * k


@njit(cache=True, nogil=True)
def _busy(x, y, z, fp):  # type: ignore[no-untyped-def]
    k = 0.4 + 0.5 * layers(x, y, z, 0.35, 4, fp) + 0.75 * layers(x + 9, y, z, 0.06, 4, fp)
    d, _, name = cells(x * 7, y * 7, z * 7)
    spot = (1 - step(0.25, 0.32 + fp * 7, d)) * 0.8
    tint = 0.5 * (name - 0.5) * spot
    k = max(0.03, k * (1 - spot * (0.2 + 0.6 * name)))
    hue = 0.5 * layers(x + 50, y, z, 0.5, 4, fp)
    return k * (1 + hue + tint), k, k * (1 - hue - tint)


@njit(cache=True, nogil=True)
def albedo(m, x, y, z, nx, ny, nz, s0, s1, s2, fp):  # type: ignore[no-untyped-def]
    """Linear RGB and gloss of material ``m`` at (x, y, z) with a normal, its shades, and a pixel of ``fp`` metres."""
    if m == 0:
        r, g, b = _paving(x, y, z, fp)
        return r, g, b, 0.03
    if m == 1:
        r, g, b = _stone(x, y, z, nx, nz, fp)
        return r, g, b, 0.03
    if m == 2:
        r, g, b = _brick(x, y, z, nx, fp)
        return r, g, b, 0.02
    if m == 3:
        r, g, b = _plaster(x, y, z, fp)
        return r, g, b, 0.02
    if m == 4:
        k = 1 + 0.5 * layers(x, y, z, 0.12, 4, fp)
        return 0.035 * k, 0.05 * k, 0.048 * k, 0.5
    if m == 5:
        k = 1 + 0.45 * layers(x, y, z * 2, 0.14, 5, fp)
        lime = 0.25 * step(0.1, 0.4, layers(x + 3, y, z, 0.2, 3, fp))
        return 0.44 * k + lime * 0.4, 0.175 * k + lime * 0.4, 0.09 * k + lime * 0.35, 0.08
    if m == 6 or m == 18:
        r, g, b = _leaf(s0, s1, s2, m == 18)
        return r, g, b, 0.12
    if m == 7:
        k = 1 + 0.7 * layers(x * 0.25, y * 3, z * 3, 0.08, 4, fp)
        return 0.3 * k, 0.17 * k, 0.085 * k, 0.12
    if m == 8:
        r, g, b = _grass(x, y, z, fp)
        return r, g, b, 0.02
    if m == 9:
        r, g, b = hound_fur(x, y, z, fp)
        return r, g, b, 0.1
    if m == 10:
        r, g, b = cloth(x, y, z, fp)
        return r, g, b, 0.05
    if m == 11:
        r, g, b = _busy(x, y, z, fp)
        return r, g, b, 0.0
    if m == 12:
        k = 0.5 * (1 + 0.05 * layers(x, y, z, 0.5, 5, fp))
        return k, k * 0.97, k * 0.92, 0.0
    if m == 13:
        k = 1 + 0.6 * layers(x, y, z, 0.7, 3, fp)
        return 0.05 * k, 0.065 * k, 0.08 * k, 0.9
    if m == 14:
        slat = 0.7 + 0.3 * step(0.1, 0.5, abs((z / 0.055) % 1.0 - 0.5) * 2)
        k = slat * (1 + 0.35 * layers(x, y, z, 0.16, 5, fp))
        return 0.1 * k, 0.25 * k, 0.27 * k, 0.1
    if m == 15:
        k = 0.75 + 0.25 * np.sin(90 * (x + y) + 160 * z)
        return 0.5 * k, 0.4 * k, 0.26 * k, 0.02
    if m == 16:
        k = 0.8 + 1.2 * layers(x * 3, y * 3, z * 0.6, 0.1, 5, fp)
        return 0.19 * k, 0.14 * k, 0.1 * k, 0.02
    if m == 17:
        r, g, b = fox_fur(x, y, z, fp)
        return r, g, b, 0.1
    k = 1 + 0.2 * layers(x, y, z, 0.05, 3, fp)
    stripe = step(0.42, 0.5, abs((np.arctan2(y - s1, x - s0) * 6 / (2 * np.pi)) % 2.0 - 1.0))
    return (
        k * (0.72 * stripe + 0.7 * (1 - stripe)),
        k * (0.1 * stripe + 0.66 * (1 - stripe)),
        k * (0.07 * stripe + 0.55 * (1 - stripe)),
        0.3,
    )


@njit(cache=True, nogil=True)
def relief(m, x, y, z, nx, nz, fp):  # type: ignore[no-untyped-def]
    """Height of the surface's own relief, metres."""
    if m == 0:
        inside, name = _tiles(x + 0.02 * layers(x, y, 0.0, 0.3, 2, fp), y, 0.62, 0.44, 0.012, 0.5)
        return 0.004 * inside + 0.008 * layers(x, y, z + 9 * name, 0.11, 3, fp)
    if m == 1:
        return 0.007 * layers(x + 31, y, z, 0.09, 3, fp)
    if m == 2:
        inside, name = _tiles(_wall(x, y, nx), z, 0.235, 0.078, 0.008, 0.5)
        return 0.006 * inside + 0.004 * layers(x, y, z + 5 * name, 0.05, 2, fp)
    if m == 3:
        return 0.004 * layers(x, y, z, 0.07, 3, fp)
    if m == 16:
        return 0.03 * layers(x * 3, y * 3, z * 0.6, 0.1, 3, fp)
    if m == 9 or m == 17:
        return 0.004 * layers(x * 0.45, y * 1.3, z * 1.0, 0.03, 2, fp)
    return 0.0
