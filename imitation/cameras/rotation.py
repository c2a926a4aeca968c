"""A camera that only turns: rotations and, if the turn is wide enough, the focal length."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from imitation.cameras.adjust import Bundle
from imitation.cameras.features import Features, Matches
from imitation.cameras.follow import Tracks
from imitation.cameras.poses import Sightings
from imitation.cameras.verdict import turn_between
from imitation.geometry.projection import Array

FEWEST = 8
WRONG = 12.0  # pixels: a match that misses the chained rotations by more is no match


def chain(tracks: Tracks, focal: float, centre: Array) -> tuple[Array, list[int]]:
    """Rotations (n, 3, 3) from frame to frame, the first the identity; and frames without enough corners."""
    R = np.tile(np.eye(3), (len(tracks), 1, 1))
    guessed = []
    for frame in range(1, len(tracks)):
        a, b = tracks.common(frame - 1, frame)
        if len(a) < FEWEST:
            guessed.append(frame)
            R[frame] = R[frame - 1]
        else:
            R[frame] = turn_between(a, b, focal, centre)[0] @ R[frame - 1]
    return R, guessed


def _rays(pixels: Array, R: Array, focal: float, centre: Array) -> Array:
    local = np.concatenate([(pixels - centre) / focal, np.ones((len(pixels), 1))], axis=1)
    rays = np.einsum("nji,nj->ni", R, local)
    unit: Array = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return unit


def turning_bundle(
    tracks: Tracks,
    features: Sequence[Features],
    matches: Mapping[tuple[int, int], Matches],
    focal: float,
    centre: Array,
) -> tuple[Bundle, list[int]]:
    """Chained rotations with all corners as directions and the wide matches that tie the clip together."""
    R, guessed = chain(tracks, focal, centre)
    sightings = Sightings.of(tracks)
    long = np.bincount(sightings.corner) >= 3
    used = long[sightings.corner]
    frames, pixels = [sightings.frame[used]], [sightings.pixels[used]]
    index = [(np.cumsum(long) - 1)[sightings.corner[used]]]
    count = int(long.sum())
    for (i, j), pair in sorted(matches.items()):
        first, second = features[i], features[j]
        a, b = first.pixels[pair[:, 0]], second.pixels[pair[:, 1]]
        rays = _rays(a, np.tile(R[first.frame], (len(a), 1, 1)), focal, centre) @ R[second.frame].T
        with np.errstate(divide="ignore", invalid="ignore"):
            missed = np.linalg.norm(focal * rays[:, :2] / rays[:, 2:] + centre - b, axis=1)
        good = (missed < WRONG) & (rays[:, 2] > 0)
        names = count + np.arange(int(good.sum()))
        for frame, seen in ((first.frame, a[good]), (second.frame, b[good])):
            frames.append(np.full(len(names), frame, np.int64))
            pixels.append(seen)
            index.append(names)
        count += len(names)
    where, point, pixel = np.concatenate(frames), np.concatenate(index), np.concatenate(pixels)
    directions = np.zeros((count, 3))
    np.add.at(directions, point, _rays(pixel, R[where], focal, centre))
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-12)
    return Bundle.of(focal, centre, R, np.zeros((len(R), 3)), directions, where, point, pixel), guessed
