"""The camera of the sample world: in somebody's hands, shaking, following the subject a little."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from imitation.cameras.path import CameraPath
from imitation.errors import InputError
from resources.world.skeleton import Array

Style = Literal["handheld", "passing", "static", "rotation"]


def look(eyes: Array, targets: Array, rolls: Array | None = None) -> tuple[Array, Array]:
    """R (n, 3, 3) and T (n, 3) of cameras at ``eyes`` (n, 3) that look at ``targets`` (n, 3), Z up, turned by rolls."""
    forward = targets - eyes
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    down = np.cross(forward, right)
    if rolls is not None:
        c, s = np.cos(rolls)[:, None], np.sin(rolls)[:, None]
        right, down = c * right + s * down, c * down - s * right
    R = np.stack([right, down, forward], axis=1)
    return R, -np.einsum("nij,nj->ni", R, eyes)


def shake(frames: int, columns: int, seed: int, smooth: float) -> Array:
    """Smooth noise (frames, columns) of unit strength, as a hand gives it; longer clips begin like shorter ones."""
    rng = np.random.default_rng([seed, 31])
    margin = int(4 * smooth) + 1
    white = rng.standard_normal((columns, frames + 2 * margin)) if columns else np.zeros((0, frames + 2 * margin))
    noise = gaussian_filter1d(white, smooth, axis=1)[:, margin : margin + frames]
    result: Array = noise.T * np.sqrt(2 * smooth * np.sqrt(np.pi))
    return result


def make_camera(
    centre: ArrayLike,
    diagonal: float,
    *,
    azimuth: float = 90.0,
    style: Style = "handheld",
    seed: int = 0,
    size: tuple[int, int] = (960, 540),
    focal: float | None = None,
    distance: float = 3.0,
    height: float = 0.55,
    follow: float = 0.6,
    travel: float = 0.5,
) -> CameraPath:
    """Film a subject.

    Parameters
    ----------
    centre : (n, 3) middle of the subject in each frame, world metres.
    diagonal : of the subject, metres.
    azimuth : degrees between the subject's heading (+x) and the camera as the subject sees it: 90 from its right side,
        0 from in front.
    style : "handheld" (shakes, follows a little, walks along), "passing" (walks past the subject against its way,
        at its side: azimuth 60 or more), "static" (a tripod), "rotation" (a tripod whose head turns with the subject).
    size : (width, height) pixels. focal : pixels, 900 at width 960 where None.
    distance : from the subject's mean place, diagonals. height : of the camera above the subject's middle, metres.
    follow : share of the subject's way that the camera walks along. travel : metres it also moves sideways.
    """
    centre = np.asarray(centre, np.float64)
    if style not in ("handheld", "passing", "static", "rotation"):
        raise InputError(f"A camera of the sample world is handheld, passing, static or rotation, not {style!r}.")
    frames = len(centre)
    focal = 900.0 / 960.0 * size[0] if focal is None else focal
    middle = centre.mean(axis=0)
    slow = gaussian_filter1d(centre, 12, axis=0, mode="nearest")
    angle = np.radians(max(azimuth, 60.0) if style == "passing" else azimuth)
    away = np.array([np.cos(angle), -np.sin(angle), 0.0])
    side = np.array([np.sin(angle), np.cos(angle), 0.0])
    base = middle + distance * diagonal * away + [0.0, 0.0, height]
    u = np.linspace(-0.5, 0.5, frames) if frames > 1 else np.zeros(1)
    step = u * u * u * -1.2 + u * 1.3
    if style == "handheld":
        eyes = base + follow * (slow - middle) + travel * step[:, None] * side
        target = middle + 0.85 * (slow - middle)
    elif style == "passing":
        way = 0.9 * distance * diagonal
        eyes = base + way * step[:, None] * np.array([-1.0, 0.0, 0.0])
        target = middle + 0.95 * (slow - middle)
    else:
        eyes = np.broadcast_to(base, (frames, 3)).copy()
        target = np.broadcast_to(middle, (frames, 3)) if style == "static" else middle + 0.9 * (slow - middle)
    rolls = np.zeros(frames)
    if style in ("handheld", "passing"):
        slow_hand, quick_hand = shake(frames, 7, seed, 9.0), shake(frames, 7, seed + 1000, 2.0)
        eyes = eyes + 0.03 * slow_hand[:, :3] + 0.003 * quick_hand[:, :3]
        target = target + distance * diagonal * (0.012 * slow_hand[:, 3:6] + 0.0016 * quick_hand[:, 3:6])
        rolls = 0.012 * slow_hand[:, 6] + 0.002 * quick_hand[:, 6]
    elif style == "rotation":
        hand = shake(frames, 4, seed, 4.0)
        target = target + distance * diagonal * 0.008 * hand[:, :3]
        rolls = 0.006 * hand[:, 3]
    R, T = look(eyes, np.asarray(target), rolls)
    K = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1.0]])
    return CameraPath(K=np.repeat(K[None], frames, axis=0), R=R, T=T, verdict="static" if style == "static" else "ok")


def lateral_camera(
    frames: int = 40, *, seed: int = 0, size: tuple[int, int] = (480, 270), focal: float | None = None, way: float = 1.3
) -> CameraPath:
    """Walk ``way`` metres sideways before ``scene.room``, looking along +y, f = 0.9 of the width, in a hand."""
    focal = 0.9 * size[0] if focal is None else focal
    u = np.linspace(-0.5, 0.5, frames) if frames > 1 else np.zeros(1)
    slow, quick = shake(frames, 7, seed + 7, 7.0), shake(frames, 7, seed + 2007, 1.5)
    eyes = np.stack([way * u, np.full(frames, -3.4), np.full(frames, 1.3)], axis=1)
    eyes = eyes + 0.025 * slow[:, :3] + 0.004 * quick[:, :3]
    target = np.stack([0.35 * way * u, np.full(frames, 3.0), np.full(frames, 0.95)], axis=1)
    target = target + 0.08 * slow[:, 3:6] + 0.012 * quick[:, 3:6]
    R, T = look(eyes, target, 0.008 * slow[:, 6] + 0.002 * quick[:, 6])
    K = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1.0]])
    return CameraPath(K=np.repeat(K[None], frames, axis=0), R=R, T=T)
