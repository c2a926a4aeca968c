# mypy: disable-error-code="untyped-decorator"
"""Lights: where they stand, what they see, and how much of one a point receives."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from imitation.geometry.projection import Camera
from imitation.rendering.raster import depths

_AWAY = 40.0
"""Distance of a light in radii of what it lights: far enough to count as parallel."""


@attrs.frozen
class Look:
    """How a character is lit; all in linear light.

    Attributes
    ----------
    key : direction to the main light, world; None: up and to the left behind the first camera.
    key_light, fill_light, sky, bounce : RGB strengths of the main light, of the one opposite, of the sky above and of
        the ground below.
    base : sRGB colour of a character without colours, 0 to 1.
    gloss : strength of highlights.
    shadow : how dark the cast shadow is, 0 to 1.
    contact : how dark the ground is right under the character, 0 to 1.
    """

    key: tuple[float, float, float] | None = None
    key_light: tuple[float, float, float] = (1.62, 1.52, 1.38)
    fill_light: tuple[float, float, float] = (0.13, 0.155, 0.20)
    sky: tuple[float, float, float] = (0.30, 0.34, 0.41)
    bounce: tuple[float, float, float] = (0.16, 0.14, 0.115)
    base: tuple[float, float, float] = (0.72, 0.67, 0.62)
    gloss: float = 0.10
    shadow: float = 0.42
    contact: float = 0.62


@attrs.frozen(eq=False)
class LightMap:
    """What a far light sees.

    Attributes
    ----------
    camera : the light as a camera.
    nearest, farthest : float32 (s, s) depth of the surface nearest to and farthest from the light; inf and -inf where
        there is none.
    pixel : size of a pixel at the subject, world units.
    radius : of the sphere round the subject, world units.
    """

    camera: Camera
    nearest: NDArray[np.float32]
    farthest: NDArray[np.float32]
    pixel: float
    radius: float


def key_direction(look: Look, camera: Camera, up: ArrayLike) -> NDArray[np.float64]:
    """Unit direction (3,) to the main light, world."""
    if look.key is not None:
        direction = np.asarray(look.key, np.float64)
        return direction / np.linalg.norm(direction)
    above = np.asarray(up, np.float64)
    level = [axis - above * (axis @ above) for axis in (camera.R[0], camera.R[2])]
    right, ahead = (axis / max(float(np.linalg.norm(axis)), 1e-9) for axis in level)
    direction = 1.25 * above - 1.0 * right - 0.35 * ahead
    unit: NDArray[np.float64] = direction / np.linalg.norm(direction)
    return unit


def look_at(
    place: NDArray[np.float64], target: NDArray[np.float64], up: NDArray[np.float64], K: NDArray[np.float64]
) -> Camera:
    """A camera at ``place`` that looks at ``target``, its picture upright."""
    forward = (target - place) / np.linalg.norm(target - place)
    right = np.cross(forward, up)
    if np.linalg.norm(right) < 1e-9:
        right = np.cross(forward, np.roll(up, 1))
    right = right / np.linalg.norm(right)
    R = np.stack([right, np.cross(forward, right), forward])
    return Camera(K, R, -R @ place)


def light_map(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], direction: NDArray[np.float64], size: int = 384
) -> LightMap:
    """Look at a mesh from a light far away in a direction."""
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(vertices - centre, axis=1).max()), 1e-9)
    focal = _AWAY * size / 2 / 1.04
    K = np.array([[focal, 0, (size - 1) / 2], [0, focal, (size - 1) / 2], [0, 0, 1.0]])
    camera = look_at(centre + direction * _AWAY * radius, centre, np.roll(direction, 1), K)
    nearest, farthest = depths(vertices, faces, camera, (size, size))
    return LightMap(camera, nearest, farthest, _AWAY * radius / focal, radius)


def disc(count: int) -> NDArray[np.float64]:
    """Points (count, 2) spread evenly over the unit disc."""
    turn, away = np.arange(count) * 2.399963229728653, np.sqrt((np.arange(count) + 0.5) / count)
    return np.stack([away * np.cos(turn), away * np.sin(turn)], axis=1)


def blocked(
    points: NDArray[np.float64],
    light: LightMap,
    *,
    surface: bool,
    least: float,
    spread: float = 0.0,
    fade: float = np.inf,
    bias: float = 0.0,
    count: int = 24,
) -> NDArray[np.float64]:
    """How much of a light each point (n, 3) does not get, 0 to 1.

    Parameters
    ----------
    surface : the points lie on the mesh itself (compare with its lit side), not on the ground below.
    least : radius of the light's blur where the shadow touches what casts it, world units.
    spread : growth of that radius with the distance to what casts the shadow.
    fade : distance over which a shadow loses all but 1/e of its strength, world units.
    bias : how much nearer to the light something must be to cast a shadow, world units.
    count : samples a point.
    """
    local = np.ascontiguousarray(points @ light.camera.R.T + light.camera.T)
    # Ground is in shadow below anything, even below a foot that sinks into it; the gap is to the lowest surface.
    lowest = light.nearest if surface else light.farthest
    focal, middle = float(light.camera.K[0, 0]), float(light.camera.K[0, 2])
    shares: NDArray[np.float64] = _blocked(
        local, light.nearest, lowest, focal, middle, disc(count), least / light.pixel, spread / light.pixel, fade, bias
    )
    return shares


@njit(cache=True, nogil=True)
def _blocked(
    local: Any, depths: Any, lowest: Any, focal: float, middle: float, pattern: Any, least: float, spread: float,
    fade: float, bias: float,
) -> Any:  # fmt: skip
    size = depths.shape[0]
    shares = np.zeros(local.shape[0])
    # Where the map holds anything: most of the ground lies beside it.
    left, top, right, bottom = size, size, -1, -1
    for y in range(size):
        for x in range(size):
            if depths[y, x] < np.inf:
                left, right, top, bottom = min(left, x), max(right, x), min(top, y), max(bottom, y)
    for n in range(local.shape[0]):
        z = local[n, 2]
        u, v = focal * local[n, 0] / z + middle, focal * local[n, 1] / z + middle
        radius = least
        reach = least if spread == 0 else least + spread * 0.6 * size * z / focal
        if u + reach < left - 1 or u - reach > right + 1 or v + reach < top - 1 or v - reach > bottom + 1:
            continue
        if spread > 0:
            gap, found = 0.0, 0.0
            for k in range(pattern.shape[0]):
                x, y = round(u + reach * pattern[k, 0]), round(v + reach * pattern[k, 1])
                if 0 <= x < size and 0 <= y < size and depths[y, x] < z - bias:
                    # What is near casts the sharper shadow, so it counts more.
                    apart = max(z - lowest[y, x], 0.0)
                    weight = 1.0 / (apart + 0.02 * size * z / focal)
                    gap += weight * apart
                    found += weight
            if found == 0:
                continue
            radius = least + spread * gap / found
        total = 0.0
        for k in range(pattern.shape[0]):
            x, y = round(u + radius * pattern[k, 0]), round(v + radius * pattern[k, 1])
            if 0 <= x < size and 0 <= y < size and depths[y, x] < z - bias:
                # Most shadows do not fade at all.
                total += np.exp(-max(z - lowest[y, x], 0.0) / fade) if fade < np.inf else 1.0
        shares[n] = total / pattern.shape[0]
    return shares
