"""Cameras of a clip (paper A, 3.1): from pictures to a pose for every frame and a verdict about what is known."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from imitation.cameras.clip import Clip
from imitation.cameras.features import find_features, match, match_pairs, pairs_of
from imitation.cameras.follow import Tracks, follow_corners, key_frames
from imitation.cameras.mapping import GUESS, map_key_frames
from imitation.cameras.outcome import failed, moving, still, turning
from imitation.cameras.path import CameraPath
from imitation.cameras.patience import patiently
from imitation.cameras.verdict import focal_known, stands_still, weigh, wide_pairs
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

BARE = 20  # corners a frame, below which a picture says nothing
LONG_LENS = 4.0  # focal over longest side: a turn with a longer lens is rather a shift along a wall
LOST, UNLIKE = 0.15, 0.6  # a cut: so few corners found again, so unlike the picture before


def solve_cameras(
    frames: Sequence[Any],
    *,
    masks: Sequence[Any] | None = None,
    focal: float | None = None,
    progress: Progress | None = None,
) -> CameraPath:
    """Solve the camera of every frame of a clip with a static background (paper A, 3.1).

    Corners are followed through all frames; key frames get SIFT features, matched over wide pairs. From these the
    verdict is taken: a camera that stands still, one that only turns (rotations and focal length), or one that moves:
    then key frames are mapped incrementally, the other frames posed from the corners, and all is adjusted at once.

    Parameters
    ----------
    frames : sequence of uint8 RGB (h, w, 3); read two or three times, a frame at a time.
    masks : sequence of bool (h, w), True on the subject and its shadow; grown here by 1 % of the picture's length.
    focal : focal length in pixels, if known; then it is kept.
    progress : gets fractions in [0, 1]; may raise ``Cancelled``.

    Returns
    -------
    CameraPath
        World: likely up +Z, first camera looking along +Y, unknown scale (a static camera: the identity). ``verdict``
        "ok", "static", "rotation", "planar" (one plane explains the background: focal and depth are weakly known) or
        "failed"; ``reason`` says why and what is unknown. One pinhole focal length for the clip, principal point in
        the middle, no lens distortion, rolling shutter or zoom.

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
    bare = _bare(clip, tracks)
    if bare:
        return failed(clip, given, bare)
    longest = max(clip.working_size)
    if stands_still(tracks, longest):
        return still(clip, tracks, given)
    keys = key_frames(tracks, clip.working_size[0])
    features = []
    report = progress or silent
    for done, frame in enumerate(keys):
        share = 0.25 + 0.25 * done / len(keys)
        features.append(patiently(partial(find_features, clip, frame), partial(report, share)))
    matches = match_pairs(features, pairs_of(len(keys)), part(progress, 0.5, 0.6))
    wide = wide_pairs(features, matches)
    if wide:
        evidence = patiently(partial(weigh, wide, clip.working_centre, longest, given), partial(report, 0.6))
        long_lens = given is None and evidence.focal > LONG_LENS * longest
        if evidence.rotation < evidence.epipolar and not long_lens:
            known = focal_known(wide, clip.working_centre, evidence.focal, GUESS * longest) if given is None else "well"
            return turning(clip, tracks, features, matches, evidence.focal, given, known, part(progress, 0.6, 1.0))
    model = map_key_frames(
        features, matches, tracks, clip.working_size, focal=given, progress=part(progress, 0.6, 0.75)
    )
    if model is None or len(model.poses) < max(3, 0.3 * len(keys)):
        return failed(
            clip,
            given,
            "No camera path explains how the background moves: mask everything that moves, or film with more parallax.",
        )
    return moving(clip, tracks, features, model, given, part(progress, 0.75, 1.0))


def _bare(clip: Clip, tracks: Tracks) -> str:
    """Why the corners are not enough to go on, or nothing."""
    seen = np.array([len(i) for i in tracks.ids])
    if np.median(seen) < BARE:
        return (
            f"The background shows too few features (about {int(np.median(seen))} a frame): it may be blank or blurred,"
            " or the masks may cover too much."
        )
    for frame in np.flatnonzero((tracks.survived < LOST) & (tracks.likeness < UNLIKE)):
        before, after = find_features(clip, int(frame) - 1), find_features(clip, int(frame))
        if min(len(before.pixels), len(after.pixels)) > 5 * BARE > 5 * len(match(before, after)):
            return f"The clip cuts to another picture at frame {frame}: split it there and solve each part by itself."
    return ""
