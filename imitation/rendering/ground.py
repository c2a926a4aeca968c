"""The shadow of a character on the ground: a plane, or whatever surface a depth map shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

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


def _rows(value: ArrayLike) -> NDArray[np.float64]:
    array = np.array(value, np.float64).reshape(-1, 3)
    if not np.isfinite(array).all():
        raise InputError("Ground near the feet needs points of three finite numbers.")
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


@attrs.frozen(eq=False)
class Footing:
    """Ground known only near the feet, such as the steps of a stair: level round each point.

    Attributes
    ----------
    points : (k, 3) where the ground is, world; the contacts of this frame.
    normal : (3,) pointing up.
    reach : how far the ground is taken to be level round a point, world units; None: a third of the character.
    """

    points: NDArray[np.float64] = attrs.field(converter=_rows)
    normal: NDArray[np.float64] = attrs.field(converter=_vector, default=(0.0, 0.0, 1.0))
    reach: float | None = None


def footing_at(
    contacts: Mapping[str, Sequence[tuple[int, int, ArrayLike]]], frame: int, normal: ArrayLike = (0.0, 0.0, 1.0)
) -> Footing | None:
    """The ground near the feet in one frame; between two contacts a foot's level moves evenly from one to the next.

    Parameters
    ----------
    contacts : foot to [(first frame, last frame, place (3,)), ...], frames both included.

    Returns
    -------
    None where no foot has a contact.
    """
    points = []
    for intervals in contacts.values():
        ordered = sorted(intervals, key=lambda each: each[0])
        times = [float(moment) for first, last, _ in ordered for moment in (first, max(last, first + 1e-3))]
        places = np.array([place for _, _, place in ordered for _ in range(2)], np.float64).reshape(-1, 3)
        if len(times):
            points.append([float(np.interp(frame, times, places[:, axis])) for axis in range(3)])
    return Footing(points, normal) if points else None


_STEP = 2
"""Pixels from one computed sample of a shadow to the next."""
_FADED = 1.6
"""Reaches from a foot's point at which its shadow has faded out."""

Ground = Plane | Footing | NDArray[np.floating]
"""Flat ground, ground near the feet, or the background's depth (h, w), camera z, NaN where unknown."""

Lights = tuple[LightMap, LightMap]


def ground_shadow(
    vertices: NDArray[np.float64],
    lights: Lights,
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
    if not isinstance(ground, Footing):
        box = _box(_reached(vertices, lights[0], ground), 0.15 * lights[0].radius, camera, size)
        shades = np.zeros((size[1], size[0]), np.float32)
        if box is not None:
            shades[box[1] : box[3], box[0] : box[2]] = _patch(vertices, lights, camera, ground, look, box)
        return shades
    open_share = np.ones((size[1], size[0]), np.float32)
    reach = ground.reach or 0.33 * lights[0].radius
    for point in ground.points:
        plane = Plane(point, ground.normal)
        box = _box(point[None], _FADED * reach, camera, size)
        if box is None:
            continue
        shade = _patch(vertices, lights, camera, plane, look, box, reach)
        # Where the levels of two feet meet, the darker counts: each shades its own step.
        part = open_share[box[1] : box[3], box[0] : box[2]]
        np.minimum(part, 1 - shade, out=part)
    return np.subtract(1, open_share, out=open_share)


Box = tuple[int, int, int, int]


def _patch(
    vertices: NDArray[np.float64],
    lights: Lights,
    camera: Camera,
    ground: Plane | NDArray[np.floating],
    look: Look,
    box: Box,
    reach: float | None = None,
) -> NDArray[np.float32]:
    """The shadow (h, w) in a box of pixels; with ``reach`` it fades out round the plane's point."""
    import cv2

    left, top, right, bottom = box
    columns, rows = np.meshgrid(np.arange(left, right, _STEP), np.arange(top, bottom, _STEP))
    rays = camera.rays(np.stack([columns.reshape(-1), rows.reshape(-1)], axis=1))
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(ground, Plane):
            z = ((ground.point - camera.centre) @ ground.normal) / (rays @ ground.normal)
        else:
            z = np.asarray(ground, np.float64)[top:bottom:_STEP, left:right:_STEP].reshape(-1)
        there = np.isfinite(z) & (z > 0)
    points, fading = camera.centre + z[there, None] * rays[there], 1.0
    if reach is not None and isinstance(ground, Plane):
        away = np.linalg.norm(points - ground.point, axis=1) / reach
        inner = away < _FADED
        there[there], points = inner, points[inner]
        fading = np.clip(_FADED - away[inner], 0, 1) ** 2
    dark = _darkness(points, lights, look) * fading
    patch = np.zeros(rows.shape, np.float32)
    patch.reshape(-1)[there] = np.minimum(dark, 1.0)
    middle = float(camera.depth((vertices.min(axis=0) + vertices.max(axis=0)) / 2))
    blur = 0.012 * lights[0].radius * float(camera.K[0, 0]) / max(middle, 1e-9) / _STEP
    patch = np.asarray(cv2.GaussianBlur(patch, (0, 0), float(np.clip(blur, 0.6, 8.0)), borderType=cv2.BORDER_REPLICATE))
    # Sample (0, 0) of the coarse patch lies on the pixel (left, top).
    place = np.array([[1 / _STEP, 0, 0], [0, 1 / _STEP, 0]], np.float64)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    shade: NDArray[np.float32] = cv2.warpAffine(
        patch, place, (right - left, bottom - top), flags=flags, borderMode=cv2.BORDER_REPLICATE
    )
    return shade


def _darkness(points: NDArray[np.float64], lights: Lights, look: Look) -> NDArray[np.float64]:
    key, sky = lights
    radius = key.radius
    cast = blocked(points, key, surface=False, least=0.02 * radius, spread=0.10, fade=2.2 * radius, count=20)
    contact = blocked(points, sky, surface=False, least=0.07 * radius, fade=0.16 * radius, count=28)
    dark: NDArray[np.float64] = 1 - (1 - look.shadow * cast) * (1 - look.contact * np.minimum(1.0, 1.25 * contact))
    return dark


def _reached(vertices: NDArray[np.float64], key: LightMap, ground: Plane | NDArray[np.floating]) -> NDArray[np.float64]:
    """World points round which a shadow may lie: the character and where it falls."""
    direction = -key.camera.R[2]
    if isinstance(ground, Plane):
        slope = max(float(direction @ ground.normal), 0.1)
        fall = ((vertices - ground.point) @ ground.normal)[:, None]
        return np.concatenate([vertices - fall * direction / slope, vertices - fall * ground.normal])
    return np.concatenate([vertices, vertices - direction * 2 * key.radius])


def _box(points: NDArray[np.float64], margin: float, camera: Camera, size: tuple[int, int]) -> Box | None:
    """Pixels within ``margin`` world units of points."""
    # Moved along the camera's own axes, both ways: to the sides, which needs no second look, and in depth.
    local = points @ camera.R.T + camera.T
    lowest, highest = [], []
    for shift in (0.0, margin, -margin):
        z = local[:, 2] + shift
        before = z > 0
        if not before.any():
            continue
        z = z[before, None]
        pixels = local[before, :2] @ camera.K[:2, :2].T / z + camera.K[:2, 2]
        aside = margin * np.abs(camera.K[:2, :2]).max(axis=1) / z if shift == 0 else 0.0
        lowest.append((pixels - aside).min(axis=0))
        highest.append((pixels + aside).max(axis=0))
    if not lowest:
        return None
    low = np.clip(np.floor(np.min(lowest, axis=0)), 0, size).astype(int)
    high = np.clip(np.ceil(np.max(highest, axis=0)) + 1, 0, size).astype(int)
    if (high <= low).any():
        return None
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])
