"""Cameras of a clip (paper A, 3.1): from pictures to a pose for every frame and a verdict about what is known."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from imitation.cameras.adjust import Bundle, adjust
from imitation.cameras.clip import Clip
from imitation.cameras.features import Features, find_features, match, match_pairs, pairs_of
from imitation.cameras.follow import Tracks, follow_corners, key_frames
from imitation.cameras.mapping import GUESS, Model, map_key_frames
from imitation.cameras.path import CameraPath, Verdict
from imitation.cameras.poses import Pose, Sightings, pose_all, triangulate
from imitation.cameras.world import likely_world
from imitation.errors import InputError
from imitation.geometry.projection import Array
from imitation.progress import Progress, part, steps

FAR = 3.0  # pixels: an observation that misses by more, or by 6 times the median, is left out
NARROW = np.radians(0.5)


def solve_cameras(
    frames: Sequence[Any],
    *,
    masks: Sequence[Any] | None = None,
    focal: float | None = None,
    progress: Progress | None = None,
) -> CameraPath:
    """Solve the camera of every frame of a clip with a static background (paper A, 3.1).

    Corners are followed through all frames; key frames get SIFT features, matched over wide pairs, and are mapped
    incrementally; the other frames are posed from the corners; one adjustment over all frames follows.

    Parameters
    ----------
    frames : sequence of uint8 RGB (h, w, 3); read two or three times, a frame at a time.
    masks : sequence of bool (h, w), True on the subject and its shadow; grown here by 1 % of the picture's length.
    focal : focal length in pixels, if known; then it is kept.
    progress : gets fractions in [0, 1]; may raise ``Cancelled``.

    Returns
    -------
    CameraPath
        World: likely up +Z, first camera looking along +Y, unknown scale (see ``reason``). One pinhole focal length
        for the clip, principal point in the middle, no lens distortion, rolling shutter or zoom.

    Raises
    ------
    InputError
        No frames, frames of other sizes, wrong masks, a focal length that is not positive.
    """
    clip = Clip.of(frames, masks)
    if focal is not None and not (np.isfinite(focal) and focal > 0):
        raise InputError(f"The focal length must be a positive number of pixels, but is {focal}.")
    given = None if focal is None else focal * clip.scale
    tracks = follow_corners(clip, part(progress, 0.0, 0.25))
    keys = key_frames(tracks, clip.working_size[0])
    features = [find_features(clip, frame) for frame in steps(keys, part(progress, 0.25, 0.5))]
    matches = match_pairs(features, pairs_of(len(keys)), part(progress, 0.5, 0.6))
    model = map_key_frames(features, matches, clip.working_size, focal=given, progress=part(progress, 0.6, 0.85))
    if model is None:
        return _failed(clip, given, "No camera path explains how the background moves; add parallax or better masks.")
    return _finish(clip, tracks, features, model, given, part(progress, 0.85, 1.0))


def _failed(clip: Clip, focal: float | None, reason: str) -> CameraPath:
    """Cameras that stand still, so that the clip can be shown; the verdict says that they mean nothing."""
    count = len(clip)
    K = clip.intrinsics(focal or GUESS * max(clip.working_size))
    return CameraPath(
        K=np.repeat(K[None], count, 0),
        R=np.repeat(np.eye(3)[None], count, 0),
        T=np.zeros((count, 3)),
        verdict="failed",
        reason=reason,
    )


def _rescue(clip: Clip, features: Sequence[Features], model: Model) -> Any:
    """How a frame without corners finds points: SIFT against the nearest key frames."""
    seen: dict[int, tuple[Array, Array]] = {}
    for frame in model.poses:
        here = model.frames == frame
        seen[frame] = model.pixels[here], model.points[model.index[here]]
    posed = [f for f in features if f.frame in model.poses]

    def rescue(frame: int) -> tuple[Array, Array]:
        mine = find_features(clip, frame)
        points, pixels = [], []
        for other in sorted(posed, key=lambda f: abs(f.frame - frame))[:3]:
            pairs = match(other, mine)
            places, world = seen[other.frame]
            if not len(places) or not len(pairs):
                continue
            gap = np.abs(other.pixels[pairs[:, 0], None] - places[None]).max(2)
            near = gap.argmin(1)
            good = gap[np.arange(len(pairs)), near] < 0.01
            points.append(world[near[good]])
            pixels.append(mine.pixels[pairs[good, 1]])
        if not points:
            return np.zeros((0, 3)), np.zeros((0, 2))
        return np.concatenate(points), np.concatenate(pixels)

    return rescue


def _bundle(model: Model, poses: dict[int, Pose], tracks: Tracks, centre: Array) -> Bundle:
    """Key frames' points and followed corners in one adjustment."""
    sightings = Sightings.of(tracks)
    corners, sound = triangulate(poses, model.focal, centre, sightings)
    used = sound[sightings.corner]
    names = np.cumsum(sound) - 1 + len(model.points)
    count = len(tracks)
    return Bundle.of(
        model.focal,
        centre,
        np.stack([poses[t][0] for t in range(count)]),
        np.stack([poses[t][1] for t in range(count)]),
        np.concatenate([model.points, corners[sound]]),
        np.concatenate([model.frames, sightings.frame[used]]),
        np.concatenate([model.index, names[sightings.corner[used]]]),
        np.concatenate([model.pixels, sightings.pixels[used]]),
    )


def refined(bundle: Bundle, free_focal: bool, progress: Progress | None = None, turn_only: bool = False) -> Bundle:
    """Adjust, leave out what misses, adjust again at the loss that the remaining errors suggest."""
    for share, rounds in ((0.5, 25), (1.0, 40)):
        scale = float(np.clip(2.5 * np.median(bundle.errors()), 0.25, 1.5))
        bundle = adjust(
            bundle,
            loss=scale,
            free_focal=free_focal,
            turn_only=turn_only,
            iterations=rounds,
            progress=part(progress, share - 0.5, share),
        )
        errors = bundle.errors()
        bundle = bundle.keep(errors < np.clip(6 * np.median(errors), 1.0, FAR))
        if not turn_only:
            bundle = bundle.keep((bundle.angles() > NARROW)[bundle.point])
    return bundle


def _finish(
    clip: Clip, tracks: Tracks, features: Sequence[Features], model: Model, focal: float | None, progress: Progress
) -> CameraPath:
    width, height = clip.working_size
    centre = np.array([(width - 1) / 2, (height - 1) / 2])
    poses, guessed = pose_all(
        model, tracks, centre, rescue=_rescue(clip, features, model), progress=part(progress, 0.0, 0.3)
    )
    bundle = refined(_bundle(model, poses, tracks, centre), focal is None, part(progress, 0.3, 1.0))
    reason = (
        "Solved from the background's parallax; scale and true up are unknown until a ground and a length are given."
    )
    if guessed:
        named = ", ".join(map(str, guessed[:8])) + (" and more" if len(guessed) > 8 else "")
        reason += f" Frames {named} show too little background and are interpolated."
    return path_of(clip, bundle, "ok", reason, guessed)


def path_of(
    clip: Clip, bundle: Bundle, verdict: Verdict, reason: str, guessed: Sequence[int] = (), *, level: bool = True
) -> CameraPath:
    """The adjusted cameras in the frames' own pixels and a likely world."""
    count = len(clip)
    errors = bundle.errors() / clip.scale
    seen = np.bincount(bundle.camera, minlength=count)
    with np.errstate(divide="ignore", invalid="ignore"):
        residuals = np.sqrt(np.bincount(bundle.camera, weights=errors**2, minlength=count) / seen)
    residuals[list(guessed)] = np.nan
    pixels = clip.full(bundle.pixels)
    path = CameraPath(
        K=np.repeat(clip.intrinsics(bundle.focal)[None], count, 0),
        R=bundle.R,
        T=bundle.T,
        verdict=verdict,
        points=bundle.points,
        reason=reason,
        residuals=residuals,
        observations=np.concatenate([bundle.camera[:, None], pixels], axis=1),
        observed=bundle.point.astype(np.int32),
    )
    if not level:
        return path
    return attrs.evolve(path.transformed(*likely_world(path.R, path.T, path.points)))
