"""What stands in the way of dense depth, in one sentence, and the range of depths to search."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from imitation.cameras.clip import Clip
from imitation.cameras.features import find_features, match
from imitation.cameras.path import CameraPath
from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

INSTEAD = "lay a plane through selected points or assume a constant depth instead"
VERDICTS = {
    "static": "The camera stands still, so that no depth can be seen",
    "rotation": "The camera only turns, so that no depth can be seen",
    "planar": "The background is one flat surface, whose plane is all the depth there is",
    "failed": "The cameras were not found, so that no depth can be seen",
}
FEWEST_FRAMES = 3
COVERED = 0.98  # of a picture under masks: nothing is left to measure
SHIFT = 2.0  # pixels by which the background must move, beside what turning does
NEAR, FAR = 0.8, 1.4  # factors by which the range of depths is widened
NEIGHBOURS = 4  # frames on both sides whose points are likely in sight
FITTING = 0.35  # of the matches that must obey the cameras
WITHIN = 3.0  # pixels at a width of 960


def check_input(frames: Sequence[Any], cameras: CameraPath, masks: Sequence[Any] | None) -> None:
    """Refuse what cannot have depth, before anything is computed.

    Raises
    ------
    InputError
        Frames, masks and cameras do not belong together.
    NoSolution
        The cameras have no parallax.
    """
    if len(frames) < FEWEST_FRAMES:
        raise InputError(
            f"The clip has {len(frames)} frames, too few for depth: give at least {FEWEST_FRAMES}, filmed from "
            "different places."
        )
    if len(cameras) != len(frames):
        raise InputError(
            f"There are {len(cameras)} cameras for {len(frames)} frames: they belong to another clip, or to a part."
        )
    first = np.asarray(frames[0])
    if first.ndim != 3 or first.shape[2] != 3 or first.dtype != np.uint8:
        raise InputError(f"Frame 0 must be uint8 RGB (h, w, 3), but is {first.dtype} of shape {first.shape}.")
    height, width = first.shape[:2]
    if min(width, height) < 64:
        raise InputError(f"The frames are {width} x {height} pixels; depth needs at least 64 on each side.")
    centre = cameras.K[:, :2, 2] / np.array([width - 1, height - 1])
    if (np.abs(centre - 0.5) > 0.25).any():
        x, y = 2 * cameras.K[0, :2, 2] + 1
        raise InputError(
            f"The cameras are for pictures of about {x:.0f} x {y:.0f} pixels, but the frames are {width} x {height}: "
            "they belong to another clip."
        )
    if masks is not None:
        if len(masks) != len(frames):
            raise InputError(f"There are {len(masks)} masks for {len(frames)} frames; give one mask a frame.")
        if np.shape(masks[0]) != (height, width):
            raise InputError(
                f"The mask of frame 0 is {np.shape(masks[0])}, but the frames are {height} high and {width} wide."
            )
        shares = [float(np.mean(np.asarray(masks[t]) > 0)) for t in range(0, len(masks), max(1, len(masks) // 12))]
        if np.median(shares) > COVERED:
            raise InputError("The masks cover the whole picture: no background is left to measure.")
    if cameras.verdict in VERDICTS:
        raise NoSolution(f"{VERDICTS[cameras.verdict]}: {INSTEAD}.")
    extent = float(np.linalg.norm(np.ptp(cameras.centres, axis=0)))
    if extent <= 1e-9 * max(1.0, float(np.abs(cameras.centres).max())):
        raise NoSolution(f"All cameras stand in one place, so that there is no parallax: {INSTEAD}.")


@attrs.frozen
class Range:
    """Depths to search, world units: from ``near`` to ``far``; ``middle`` is the median depth of the background."""

    near: float
    far: float
    middle: float


def find_range(
    frames: Sequence[Any], cameras: CameraPath, masks: Sequence[Any] | None, progress: Progress = silent
) -> Range:
    """The range of background depths, from the cameras' points or from features triangulated here.

    Raises
    ------
    InputError
        The cameras do not explain how the picture moves.
    NoSolution
        The background hardly moves against the camera: no parallax, or a scene at infinity.
    """
    found = _triangulated(frames, cameras, masks, progress)
    depths = _seen_depths(cameras, np.shape(frames[0])) if len(cameras.points) >= 50 else found
    if len(depths) < 12:
        raise NoSolution(f"Too few background points show parallax for depth to be searched: {INSTEAD}.")
    low, middle, high = np.percentile(depths, [1, 50, 99])
    extent = float(np.linalg.norm(cameras.centres[:, None] - cameras.centres[None, :: max(1, len(cameras) // 8)],
                                  axis=-1).max())  # fmt: skip
    shift = float(cameras.K[0, 0, 0]) * extent / float(np.percentile(depths, 10))
    if shift < SHIFT:
        raise NoSolution(
            f"The whole way of the camera shifts the background by {shift:.1f} pixels: it is too far away, or the "
            f"camera moves too little; {INSTEAD}."
        )
    return Range(NEAR * float(low), FAR * float(high), float(middle))


def range_near(cameras: CameraPath, frame: int, whole: Range) -> Range:
    """The range of depths to search in one frame: of the points observed in it and its neighbours, else the clip's."""
    if not len(cameras.observations):
        return whole
    close = np.abs(cameras.observations[:, 0] - frame) <= NEIGHBOURS
    names = np.unique(cameras.observed[close])
    z = cameras[frame].depth(cameras.points[names])
    z = z[z > 0]
    if len(z) < 50:
        return whole
    low, middle, high = np.percentile(z, [1, 50, 99])
    return Range(max(NEAR * float(low), 0.05 * float(middle)), FAR * float(high), float(middle))


def _seen_depths(cameras: CameraPath, shape: tuple[int, ...]) -> Array:
    """Depths (k,) of the cameras' points in those of a few frames that show them."""
    kept = []
    for frame in range(0, len(cameras), max(1, len(cameras) // 12)):
        camera = cameras[frame]
        pixels, z = camera.project(cameras.points), camera.depth(cameras.points)
        with np.errstate(invalid="ignore"):
            inside = (z > 0) & (pixels >= 0).all(axis=1) & (pixels < [shape[1], shape[0]]).all(axis=1)
        kept.append(z[inside])
    return np.concatenate(kept)


def _pairs(cameras: CameraPath) -> list[tuple[int, int]]:
    """A few pairs of frames about a quarter of the way apart."""
    centres = cameras.centres
    count = len(cameras)
    pairs = []
    for first in sorted({0, count // 3, 2 * count // 3}):
        away = np.linalg.norm(centres - centres[first], axis=1)
        wide = np.flatnonzero(away[first + 1 :] >= 0.25 * away.max()) + first + 1
        second = int(wide[0]) if len(wide) else count - 1
        if second > first:
            pairs.append((first, second))
    return pairs


def _triangulated(frames: Sequence[Any], cameras: CameraPath, masks: Sequence[Any] | None, progress: Progress) -> Array:
    """Depths (k,) of matched features; refuses cameras that they contradict and scenes that they show at infinity."""
    clip = Clip.of(frames, masks)
    tolerance = WITHIN / 960 * max(clip.size)
    depths, fitting, total, shifts = [], 0, 0, []
    chosen = _pairs(cameras)
    for number, (first, second) in enumerate(chosen):
        progress(number / len(chosen))
        a = find_features(clip, first)
        progress((number + 0.4) / len(chosen))
        b = find_features(clip, second)
        progress((number + 0.8) / len(chosen))
        pairs = match(a, b)
        if len(pairs) < 12:
            continue
        p, q = clip.full(a.pixels[pairs[:, 0]]), clip.full(b.pixels[pairs[:, 1]])
        z, miss, shift = _meet(cameras, first, second, p, q)
        good = miss < tolerance
        total, fitting = total + len(pairs), fitting + int(good.sum())
        shifts.append(shift[good])
        depths.append(z[good & (z > 0) & (shift > SHIFT)])
    if not total:
        raise NoSolution(
            f"The background shows too few features that several frames share, so that depth has no hold: {INSTEAD}."
        )
    if fitting < FITTING * total:
        raise InputError(
            f"Only {fitting} of {total} matched features obey the cameras: they belong to another clip, or the "
            "background moves."
        )
    if np.percentile(np.concatenate(shifts), 75) < SHIFT:
        raise NoSolution(
            "The background does not shift as the camera moves: it is at infinity for this camera path, so that no "
            f"depth can be seen; {INSTEAD}."
        )
    return np.concatenate(depths)


def _meet(cameras: CameraPath, first: int, second: int, p: Array, q: Array) -> tuple[Array, Array, Array]:
    """Depth in the first camera of matched pixels (k, 2), distance of q from p's epipolar line, and q's parallax."""
    one, two = cameras[first], cameras[second]
    turn = two.R @ one.R.T
    a = np.concatenate([p, np.ones((len(p), 1))], axis=1) @ (two.K @ turn @ np.linalg.inv(one.K)).T
    b = two.K @ (two.T - turn @ one.T)
    # q ~ a + w b: two equations for w, solved by least squares.
    m = q * b[2] - b[:2]
    n = a[:, :2] - q * a[:, 2:]
    w = (m * n).sum(axis=1) / np.maximum((m * m).sum(axis=1), 1e-30)
    seen = a + w[:, None] * b
    with np.errstate(divide="ignore", invalid="ignore"):
        miss = np.linalg.norm(seen[:, :2] / seen[:, 2:] - q, axis=1)
        shift = np.linalg.norm(a[:, :2] / a[:, 2:] - q, axis=1)
        z = np.where(w > 0, 1 / w, -1.0)
    return z, np.nan_to_num(miss, nan=np.inf), np.nan_to_num(shift, nan=0.0)
