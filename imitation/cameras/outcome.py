"""From a verdict to the cameras that go with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from imitation.cameras.adjust import Bundle, adjust
from imitation.cameras.again import found_again
from imitation.cameras.clip import Clip
from imitation.cameras.features import Features, Matches, find_features, match
from imitation.cameras.follow import Tracks
from imitation.cameras.mapping import GUESS, Model
from imitation.cameras.path import CameraPath, Verdict
from imitation.cameras.patience import patiently
from imitation.cameras.plane import least_squares_plane
from imitation.cameras.poses import Pose, Sightings, pose_all, triangulate
from imitation.cameras.reversal import right_way_round
from imitation.cameras.rotation import turning_bundle
from imitation.cameras.verdict import FocalKnown
from imitation.cameras.world import likely_world
from imitation.geometry.projection import Array
from imitation.progress import Progress, part

FAR = 3.0  # pixels: an observation that misses by more, or by 6 times the median, is left out
NARROW = np.radians(0.5)
FLAT = 0.4 / 960  # of the longest side: points that leave their common plane by less are flat
FEWEST = 50  # points that hold a path
MORE = "mask everything that moves, or film with more parallax"
NO_ANGLE = np.radians(1.0)
BLURRY = 1.5 / 960


def failed(clip: Clip, focal: float | None, reason: str) -> CameraPath:
    """Cameras that stand still, so that the clip can be shown; the verdict says that they mean nothing."""
    return _identity(clip, focal, "failed", reason)


def still(clip: Clip, tracks: Tracks, focal: float | None) -> CameraPath:
    """The identity for every frame; residuals are how far the corners stray from where they were first seen."""
    reason = "The camera stands still: depth, up and scale are unknown" + ("." if focal else ", the focal is guessed.")
    if len(clip) == 1:
        reason = "One frame alone shows no motion: depth, up and scale are unknown" + (
            "." if focal else ", the focal is guessed."
        )
    where: dict[int, Array] = {}
    residuals = np.full(len(clip), np.nan)
    for frame in range(len(tracks)):
        for name, pixel in zip(tracks.ids[frame].tolist(), tracks.pixels[frame], strict=True):
            where.setdefault(name, pixel)
        first = np.array([where[name] for name in tracks.ids[frame].tolist()]).reshape(-1, 2)
        off = np.linalg.norm(tracks.pixels[frame] - first, axis=1)
        off = off[off < FAR]  # what moves by itself is not the camera's
        if len(off):
            residuals[frame] = np.sqrt(np.mean(off**2)) / clip.scale
    return _identity(clip, focal, "static", reason, residuals)


def _identity(
    clip: Clip, focal: float | None, verdict: Verdict, reason: str, residuals: Array | None = None
) -> CameraPath:
    count = len(clip)
    K = clip.intrinsics(focal or GUESS * max(clip.working_size))
    return CameraPath(
        K=np.tile(K, (count, 1, 1)),
        R=np.tile(np.eye(3), (count, 1, 1)),
        T=np.zeros((count, 3)),
        verdict=verdict,
        reason=reason,
        residuals=residuals,
    )


def turning(
    clip: Clip,
    tracks: Tracks,
    features: Sequence[Features],
    matches: Mapping[tuple[int, int], Matches],
    focal: float,
    given: float | None,
    known: FocalKnown,
    progress: Progress,
) -> CameraPath:
    """Rotations and the focal length of a camera that does not travel; all centres coincide."""
    start = given or (GUESS * max(clip.working_size) if known == "not" else focal)
    bundle, guessed = turning_bundle(tracks, features, matches, start, clip.working_centre)
    bundle = refined(bundle, given is None and known != "not", progress, turn_only=True)
    reason = "The camera only turns: no depth can be recovered, and scale is unknown."
    if known == "not":
        reason += " It turns too little to tell the focal length, which is guessed."
    if known == "weakly":
        reason += " The focal length is weakly known."
    return path_of(clip, bundle, "rotation", reason + _interpolated(guessed), guessed)


def moving(
    clip: Clip, tracks: Tracks, features: Sequence[Features], model: Model, focal: float | None, progress: Progress
) -> CameraPath:
    """Every frame's pose from mapped key frames; "planar" where the points lie on one plane."""
    centre = clip.working_centre
    poses, guessed = pose_all(
        model, tracks, centre, rescue=_rescue(clip, features, model), progress=part(progress, 0.0, 0.15)
    )
    bundle = patiently(partial(_bundle, model, poses, tracks, centre), partial(progress, 0.15))
    bundle = refined(bundle, focal is None, part(progress, 0.15, 0.4))
    bundle = right_way_round(bundle, lambda other: refined(other, focal is None), free_focal=focal is None)
    # The second round begins where better cameras say, and finds what the first one's looked for beside its place.
    for settle, share in ((True, 0.4), (False, 0.7)):
        bundle = found_again(clip, bundle, settle=settle, progress=part(progress, share, share + 0.2))
        bundle = refined(bundle, focal is None, part(progress, share + 0.2, share + 0.3))
    angles = bundle.angles()
    if len(guessed) > 0.5 * len(clip) or len(bundle.points) < FEWEST:
        return failed(clip, focal, f"Only {len(clip) - len(guessed)} of {len(clip)} frames could be posed: {MORE}.")
    if not len(angles) or np.median(angles) < NO_ANGLE:
        return failed(clip, focal, "The camera travels too little for the depth of the scene: film with more parallax.")
    longest = max(clip.working_size)
    verdict: Verdict = "ok"
    reason = (
        "Solved from the background's parallax; scale is unknown, and up likely, until a ground and a length are given."
    )
    if _flatness(bundle, angles) < FLAT * longest:
        verdict = "planar"
        reason = (
            "The background is one plane: the cameras fit it, but scale is unknown and the focal length weakly known."
        )
    blurry = float(np.median(bundle.errors())) > BLURRY * longest
    if blurry:
        reason += " The residuals are large: lens distortion, a rolling shutter or a zoom may be the cause."
    return path_of(clip, bundle, verdict, reason + _interpolated(guessed), guessed)


def _interpolated(frames: Sequence[int]) -> str:
    if not frames:
        return ""
    named = ", ".join(map(str, frames[:8])) + (" and more" if len(frames) > 8 else "")
    return f" Frames {named} show too little background and are interpolated."


def _flatness(bundle: Bundle, angles: Array) -> float:
    """Median number of pixels by which points leave their common plane, as their parallax shows it."""
    points = bundle.points
    weight = np.ones(len(points))
    off = np.zeros(len(points))
    for _ in range(10):
        normal, middle, _ = least_squares_plane(points, weight)
        off = np.abs((points - middle) @ normal)
        weight = 1 / (1 + (off / max(2 * float(np.median(off)), 1e-12)) ** 2)
    depth = np.einsum("nj,nj->n", bundle.R[bundle.camera, 2], points[bundle.point]) + bundle.T[bundle.camera, 2]
    nearest = np.full(len(points), np.inf)
    np.minimum.at(nearest, bundle.point, depth)
    return float(np.median(bundle.focal * angles * off / nearest))


def _rescue(clip: Clip, features: Sequence[Features], model: Model) -> Callable[[int], tuple[Array, Array]]:
    """How a frame without corners finds points: SIFT against the nearest key frames."""
    seen: dict[int, tuple[Array, Array]] = {}
    for frame in model.poses:
        here = model.frames == frame
        seen[frame] = model.pixels[here], model.points[model.index[here]]
    posed = [f for f in features if f.frame in model.poses]

    def rescue(frame: int) -> tuple[Array, Array]:
        mine = find_features(clip, frame)
        points, pixels = [np.zeros((0, 3))], [np.zeros((0, 2))]
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
    for share, rounds, tolerance in ((0.5, 25, 1e-5), (1.0, 40, 1e-6)):
        scale = float(np.clip(2.5 * np.median(bundle.errors()), 0.25, 1.5))
        bundle = adjust(
            bundle,
            loss=scale,
            free_focal=free_focal,
            turn_only=turn_only,
            iterations=rounds,
            tolerance=tolerance,
            progress=part(progress, share - 0.5, share),
        )
        errors = bundle.errors()
        bundle = bundle.keep(errors < np.clip(6 * np.median(errors), 1.0, FAR))
        if not turn_only:
            bundle = bundle.keep((bundle.angles() > NARROW)[bundle.point])
    return bundle


def path_of(clip: Clip, bundle: Bundle, verdict: Verdict, reason: str, guessed: Sequence[int] = ()) -> CameraPath:
    """The adjusted cameras in the frames' own pixels and a likely world; a turning camera has no points."""
    count = len(clip)
    errors = bundle.errors() / clip.scale
    seen = np.bincount(bundle.camera, minlength=count)
    with np.errstate(divide="ignore", invalid="ignore"):
        residuals = np.sqrt(np.bincount(bundle.camera, weights=errors**2, minlength=count) / seen)
    residuals[list(guessed)] = np.nan
    path = CameraPath(
        K=np.tile(clip.intrinsics(bundle.focal), (count, 1, 1)),
        R=bundle.R,
        T=bundle.T,
        verdict=verdict,
        points=None if verdict == "rotation" else bundle.points,
        reason=reason,
        residuals=residuals,
        observations=None
        if verdict == "rotation"
        else np.concatenate([bundle.camera[:, None], clip.full(bundle.pixels)], axis=1),
        observed=np.zeros(0, np.int32) if verdict == "rotation" else bundle.point.astype(np.int32),
    )
    return path.transformed(*likely_world(path.R, path.T, path.points))
