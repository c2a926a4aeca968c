"""Sun and sky: shadow maps along the sun, and along many directions of the sky for soft contact shadows."""

from __future__ import annotations

import attrs
import numpy as np
from numba import njit
from numpy.typing import NDArray

from resources.world.raster import Ids, fill_light
from resources.world.skeleton import Array

FAR = -1e9


@attrs.frozen(eq=False)
class LightMaps:
    """Shadow maps along ``directions`` (k, 3), all of one size.

    Attributes
    ----------
    directions : (k, 3) unit, towards the light. axes : (k, 3, 3) rows: column and row axis, direction.
    middle : (3,) world point in the middle of the maps. texel : metres. maps : (k, r, r) height of what is nearest.
    """

    directions: Array
    axes: Array
    middle: Array
    texel: float
    maps: NDArray[np.float32]


def sky_directions(count: int) -> Array:
    """Directions (count, 3) spread evenly over the upper half of the sky."""
    i = np.arange(count) + 0.5
    z = 0.04 + 0.96 * (1 - i / count)
    angle = i * np.pi * (3 - 5**0.5)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def light_maps(vertices: Array, faces: Ids, directions: Array, middle: Array, width: float, texels: int) -> LightMaps:
    """Draw triangles along each direction; the maps cover ``width`` metres about ``middle`` (3,)."""
    texel = width / texels
    helper = np.where(np.abs(directions[:, 2:]) < 0.99, [[0.0, 0, 1]], [[1.0, 0, 0]])
    e = np.cross(helper, directions)
    e /= np.linalg.norm(e, axis=1, keepdims=True)
    axes = np.stack([e, np.cross(directions, e), directions], axis=1)
    maps = np.full((len(directions), texels, texels), FAR, np.float32)
    for k, axis in enumerate(axes):
        local = (vertices - middle) @ axis.T
        local[:, :2] = local[:, :2] / texel + (texels - 1) / 2
        fill_light(np.ascontiguousarray(local), faces, maps[k])
    return LightMaps(directions, np.ascontiguousarray(axes), np.asarray(middle, np.float64), texel, maps)


@njit(cache=True, nogil=True)
def lit(axis, texel, nearest, x, y, z, bias):  # type: ignore[no-untyped-def]
    """Share of light (0 to 1) at a place (x, y, z) from the middle of a map, softened over one texel."""
    r = nearest.shape[0]
    u = (axis[0, 0] * x + axis[0, 1] * y + axis[0, 2] * z) / texel + (r - 1) / 2
    v = (axis[1, 0] * x + axis[1, 1] * y + axis[1, 2] * z) / texel + (r - 1) / 2
    if u < 0 or v < 0 or u >= r - 1 or v >= r - 1:
        return 1.0
    h = axis[2, 0] * x + axis[2, 1] * y + axis[2, 2] * z + bias
    i, j = int(u), int(v)
    a, b = u - i, v - j
    s00 = 1.0 if nearest[j, i] <= h else 0.0
    s10 = 1.0 if nearest[j, i + 1] <= h else 0.0
    s01 = 1.0 if nearest[j + 1, i] <= h else 0.0
    s11 = 1.0 if nearest[j + 1, i + 1] <= h else 0.0
    return (s00 * (1 - a) + s10 * a) * (1 - b) + (s01 * (1 - a) + s11 * a) * b
