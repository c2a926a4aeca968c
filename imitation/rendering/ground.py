"""The shadow of a character on the ground: a plane, or whatever surface a depth map shows."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.rendering.light import LightMap, Look, blocked


def _vector(value: ArrayLike) -> NDArray[np.float64]:
    array = np.array(value, np.float64)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise InputError(f"A plane needs a point and a normal of three finite numbers, but got {array.shape}.")
    return array


@attrs.frozen(eq=False)
class Plane:
    """Flat ground.

    Attributes
    ----------
    point : (3,) a point on it, world.
    normal : (3,) pointing up.
    """

    point: NDArray[np.float64] = attrs.field(converter=_vector)
    normal: NDArray[np.float64] = attrs.field(converter=_vector, default=(0.0, 0.0, 1.0))


_STEP = 2
"""Pixels from one computed sample of a shadow to the next."""

Ground = Plane | NDArray[np.floating]
"""Flat ground, or the background's depth (h, w), camera z, NaN where unknown."""


def ground_shadow(
    vertices: NDArray[np.float64],
    lights: tuple[LightMap, LightMap],
    camera: Camera,
    size: tuple[int, int],
    ground: Ground,
    look: Look,
    up: NDArray[np.float64],
) -> NDArray[np.float32]:
    """How dark the ground is in each pixel (h, w), 0 to 1: a cast shadow that softens with distance, and contact.

    Parameters
    ----------
    vertices : (v, 3) the character, world.
    lights : what the key light and the sky see of it.
    ground : see Ground.
    """
    import cv2

    shade = np.zeros((size[1], size[0]), np.float32)
    key, sky = lights
    box = _box(vertices, key, camera, size, ground, up)
    if box is None:
        return shade
    left, top, right, bottom = box
    columns, rows = np.meshgrid(np.arange(left, right, _STEP), np.arange(top, bottom, _STEP))
    pixels = np.stack([columns.reshape(-1), rows.reshape(-1)], axis=1)
    rays = camera.rays(pixels)
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(ground, Plane):
            z = ((ground.point - camera.centre) @ ground.normal) / (rays @ ground.normal)
        else:
            z = np.asarray(ground, np.float64)[top:bottom:_STEP, left:right:_STEP].reshape(-1)
        there = np.isfinite(z) & (z > 0)
    points = camera.centre + z[there, None] * rays[there]
    radius = key.radius
    cast = blocked(points, key, surface=False, least=0.02 * radius, spread=0.10, fade=2.2 * radius, count=20)
    contact = blocked(points, sky, surface=False, least=0.07 * radius, fade=0.16 * radius, count=28)
    dark = 1 - (1 - look.shadow * cast) * (1 - look.contact * np.minimum(1.0, 1.25 * contact))
    patch = np.zeros(rows.shape, np.float32)
    patch.reshape(-1)[there] = dark
    middle = float(camera.depth((vertices.min(axis=0) + vertices.max(axis=0)) / 2))
    blur = 0.012 * radius * float(camera.K[0, 0]) / max(middle, 1e-9) / _STEP
    patch = cv2.GaussianBlur(patch, (0, 0), float(np.clip(blur, 0.6, 8.0)), borderType=cv2.BORDER_REPLICATE)
    # Sample (0, 0) of the coarse patch lies on the pixel (left, top).
    place = np.array([[1 / _STEP, 0, 0], [0, 1 / _STEP, 0]], np.float64)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    shade[top:bottom, left:right] = cv2.warpAffine(
        patch, place, (right - left, bottom - top), flags=flags, borderMode=cv2.BORDER_REPLICATE
    )
    return shade


def _box(
    vertices: NDArray[np.float64],
    key: LightMap,
    camera: Camera,
    size: tuple[int, int],
    ground: Ground,
    up: NDArray[np.float64],
) -> tuple[int, int, int, int] | None:
    """Pixels that a shadow may reach: round the character and round its projections on the ground."""
    direction = -key.camera.R[2]
    if isinstance(ground, Plane):
        slope = max(float(direction @ ground.normal), 0.1)
        fall = ((vertices - ground.point) @ ground.normal)[:, None]
        reach = np.concatenate([vertices - fall * direction / slope, vertices - fall * ground.normal])
    else:
        reach = np.concatenate([vertices, vertices - direction * 2 * key.radius])
    margin = 0.15 * key.radius
    across = np.stack([camera.R[0], camera.R[1], camera.R[2]]) * margin
    cloud = np.concatenate([reach + shift for shift in (*across, *-across)])
    pixels = camera.project(cloud)
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    if not len(pixels):
        return None
    low = np.clip(np.floor(pixels.min(axis=0)), 0, size).astype(int)
    high = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int)
    if (high <= low).any():
        return None
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])
