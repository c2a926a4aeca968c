"""Light and tone of a character matched to the clip, roughly, from a clean plate and its depth."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.rendering.light import Look, key_direction
from imitation.rendering.mesh import UP, linear

Picture = NDArray[np.uint8]
_LUMA = np.array([0.2126, 0.7152, 0.0722])
_TYPICAL = 0.20
"""Linear reflectance of an outdoor scene taken as a whole."""
_AMBER = 0.35
"""How much more red and less blue the warmest light has."""
_TELLING = 0.03
"""Share of the plate's variance that its normals must explain for a light direction to be believed."""


def background_normals(depth: NDArray[np.floating], camera: Camera, step: int = 4) -> NDArray[np.float64]:
    """World normals (h', w', 3) of every ``step``-th pixel, towards the camera, NaN at edges and where unknown."""
    z = np.asarray(depth, np.float64)[::step, ::step]
    rows, columns = np.mgrid[: depth.shape[0] : step, : depth.shape[1] : step]
    points = camera.lift(np.stack([columns, rows], axis=-1), z)
    normals = np.full(points.shape, np.nan)
    right = points[1:-1, 2:] - points[1:-1, :-2]
    down = points[2:, 1:-1] - points[:-2, 1:-1]
    across = np.cross(down, right)
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    jump = np.maximum(np.abs(z[1:-1, 2:] - z[1:-1, :-2]), np.abs(z[2:, 1:-1] - z[:-2, 1:-1])) / z[1:-1, 1:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = np.where((jump < 0.08)[..., None], across / length, np.nan)
    facing = np.einsum("hwk,hwk->hw", unit, camera.centre - points[1:-1, 1:-1]) < 0
    normals[1:-1, 1:-1] = np.where(facing[..., None], -unit, unit)
    return normals


def match_look(
    picture: Picture, depth: NDArray[np.floating], camera: Camera, *, up: ArrayLike = UP, look: Look | None = None
) -> Look:
    """Guess key light, colour and strength of the lights from a plate: a start that the user adjusts.

    Brightness is regressed on the normals of the background, robustly: whatever faces the key is brighter on average,
    whatever its own colour. The lights' colour is the plate's mean colour, drawn half way to white.

    Parameters
    ----------
    picture : uint8 RGB (h, w, 3). depth : (h, w) camera z, NaN where unknown.
    up : of the world.
    look : what is kept where the plate says nothing.
    """
    start = look or Look()
    step = max(1, round(max(picture.shape) / 240))
    normals = background_normals(depth, camera, step)
    light = linear(picture[::step, ::step].astype(np.float64))
    known = np.isfinite(normals).all(axis=-1)
    if known.sum() < 50:
        return start
    mean = np.maximum(np.median(light[known], axis=0), 1e-4)
    bright = float(mean @ _LUMA)
    tint = np.sqrt(mean / bright)
    strength = np.clip(np.sqrt(bright / _TYPICAL), 0.55, 1.6)
    scale = strength * tint
    key, share = _key(normals[known], light[known] @ _LUMA, np.asarray(up, np.float64))

    def tinted(rgb: tuple[float, float, float]) -> tuple[float, float, float]:
        r, g, b = (float(v) for v in np.asarray(rgb) * scale)
        return r, g, b

    return attrs.evolve(
        start,
        key=start.key if key is None else (float(key[0]), float(key[1]), float(key[2])),
        key_light=tinted(start.key_light),
        fill_light=tinted(start.fill_light),
        sky=tinted(start.sky),
        bounce=tinted(start.bounce),
        # The less one direction explains, the softer the light, and the fainter its shadow.
        shadow=float(start.shadow * np.clip(0.6 + 4 * share, 0.6, 1.3)),
    )


def adjusted_look(
    look: Look, camera: Camera, up: ArrayLike = UP, *, turn: float = 0.0, lift: float = 0.0, brightness: float = 1.0,
    shadow: float = 1.0, warmth: float = 0.0,
) -> Look:  # fmt: skip
    """Turn the lights of a look by hand; its main light stands still from then on.

    Parameters
    ----------
    camera : of the first frame, by which a look without a direction takes its own.
    turn, lift : degrees clockwise seen from above, and upwards; the light stays 5 to 90 degrees above the ground.
    brightness, shadow : factors on all lights, and on how dark shadows are.
    warmth : -1 blue to 1 amber; the lights stay as bright.
    """
    if not (np.isfinite([turn, lift, brightness, shadow]).all() and brightness >= 0 and shadow >= 0):
        raise InputError("Lights need finite angles and factors that are not negative.")
    if not abs(warmth) <= 1:
        raise InputError(f"The warmth of the light is between -1 and 1, not {warmth}.")
    above = np.asarray(up, np.float64) / np.linalg.norm(np.asarray(up, np.float64))
    key = key_direction(look, camera, above)
    height = np.arcsin(np.clip(key @ above, -1, 1))
    level = key - above * (key @ above)
    if np.linalg.norm(level) < 1e-9:
        level = np.roll(above, 1) - above * (np.roll(above, 1) @ above)
    level = level / np.linalg.norm(level)
    angle = -np.radians(turn)
    level = level * np.cos(angle) + np.cross(above, level) * np.sin(angle)
    if lift:
        height = np.clip(height + np.radians(lift), np.radians(5), np.radians(90))
    turned = np.sin(height) * above + np.cos(height) * level

    tint = np.array([1 + _AMBER * warmth, 1.0, 1 - _AMBER * warmth])
    tint *= brightness / float(tint @ _LUMA) if warmth else brightness

    def brighter(rgb: tuple[float, float, float]) -> tuple[float, float, float]:
        return float(rgb[0] * tint[0]), float(rgb[1] * tint[1]), float(rgb[2] * tint[2])

    return attrs.evolve(
        look,
        key=(float(turned[0]), float(turned[1]), float(turned[2])),
        key_light=brighter(look.key_light),
        fill_light=brighter(look.fill_light),
        sky=brighter(look.sky),
        bounce=brighter(look.bounce),
        shadow=float(np.clip(look.shadow * shadow, 0, 1)),
        contact=float(np.clip(look.contact * shadow, 0, 1)),
    )


def _key(
    normals: NDArray[np.float64], bright: NDArray[np.float64], up: NDArray[np.float64]
) -> tuple[NDArray[np.float64] | None, float]:
    """Unit direction to the main light, or None, and the share of the variance of log brightness it explains."""
    value = np.log(np.maximum(bright, 1e-3))
    basis = np.concatenate([np.ones((len(normals), 1)), normals], axis=1)
    weight = np.ones(len(value))
    fit = np.zeros(4)
    for _ in range(8):
        root = np.sqrt(weight)[:, None]
        ridge = np.diag([0.0, 1.0, 1.0, 1.0]) * 0.01 * len(value)
        fit = np.linalg.solve((root * basis).T @ (root * basis) + ridge, (root * basis).T @ (root[:, 0] * value))
        off = np.abs(value - basis @ fit)
        weight = 1 / (1 + (off / (1.5 * max(float(np.median(off)), 0.1))) ** 2)
    rest = np.average((value - basis @ fit) ** 2, weights=weight)
    spread = np.average((value - np.average(value, weights=weight)) ** 2, weights=weight)
    share = float(np.clip(1 - rest / max(spread, 1e-12), 0, 1))
    up = up / np.linalg.norm(up)
    direction = fit[1:]
    if share < _TELLING or np.linalg.norm(direction) < 1e-6:
        return None, share
    direction = direction / np.linalg.norm(direction)
    level = direction - up * (direction @ up)
    # The sun stands between 25 and 75 degrees up as far as a character's light goes.
    height = np.clip(direction @ up, np.sin(np.radians(25)), np.sin(np.radians(75)))
    if np.linalg.norm(level) < 1e-3:
        return None, share
    unit: NDArray[np.float64] = height * up + np.sqrt(1 - height**2) * level / np.linalg.norm(level)
    return unit, share


def grain_of(picture: Picture) -> float:
    """Standard deviation of a picture's noise, grey levels: the median of second differences where it is smoothest."""
    import cv2

    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY).astype(np.float32)
    kernel = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]], np.float32)
    detail = np.abs(cv2.filter2D(grey, cv2.CV_32F, kernel))[2:-2, 2:-2]
    local = cv2.blur(detail, (15, 15))
    calm = local <= np.quantile(local, 0.2)
    # Each value is noise of weight 6; grey holds 0.66 of the noise of one channel.
    return float(np.median(detail[calm]) / 0.6745 / 6 / 0.66)


def add_grain(picture: Picture, alpha: NDArray[np.floating], sigma: float, seed: int) -> Picture:
    """Noise of ``sigma`` levels where ``alpha`` (h, w) says that something was laid over a film; seeded a frame."""
    done: Picture = picture.copy()
    rows = np.flatnonzero((alpha != 0).any(axis=1))
    if not len(rows):
        return done
    # Noise comes row by row: what lies below the last that is covered is not asked for, and no other row changes.
    last = int(rows[-1]) + 1
    noise = np.random.default_rng(seed).standard_normal((last, *picture.shape[1:]), dtype=np.float32)
    box = slice(int(rows[0]), last)
    noisy = picture[box] + sigma * noise[box] * alpha[box, :, None]
    done[box] = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    return done
