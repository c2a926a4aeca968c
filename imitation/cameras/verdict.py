"""What the picture allows: nothing moves, one rotation explains it, one plane does, or there is parallax.

Model selection after Torr's geometric robust information criterion (GRIC): a model pays for what it misses (up to a
limit), for the dimension of what it allows each match, and for its parameters.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import attrs
import numpy as np

from imitation.cameras.features import Features, Matches
from imitation.cameras.follow import Tracks
from imitation.geometry.projection import Array

SIGMA = 1.5 / 960  # of the longest side: a model that misses by less leaves too little parallax for a depth
FEWEST = 40
SHARED = 30  # corners that two frames must share to be compared
STILL = 0.75 / 960  # a corner of a static camera stays this close to where it was first seen
LOG4 = float(np.log(4.0))


@attrs.frozen(eq=False)
class Wide:
    """Matches of two key frames far apart: their places in the list of key frames, and pixels (k, 2) in each."""

    first: int
    second: int
    a: Array
    b: Array


@attrs.frozen
class Evidence:
    """How well each model explains the wide pairs; scores per match, smaller is better.

    Attributes
    ----------
    rotation, homography, epipolar : scores.
    missed : median misses, pixels, of (rotation, homography, epipolar).
    focal : of the rotation model, pixels.
    moved : median length of the displacement, pixels.
    """

    rotation: float
    homography: float
    epipolar: float
    missed: tuple[float, float, float]
    focal: float
    moved: float


def stands_still(tracks: Tracks, longest: int) -> bool:
    """Whether in all pairs of frames, near and far, many corners are where they were and none stand out together.

    The rest may move: a subject without a mask, its shadow, noise on a blank floor.
    """
    count, near = len(tracks), STILL * longest
    if count == 1:
        return True
    shares, shifts, widest, lag = [], [], 0, 1
    while lag < count:
        for frame in range(0, count - lag, max(1, lag // 2)):
            a, b = tracks.common(frame, frame + lag)
            if len(a) >= SHARED:
                shares.append(float((np.linalg.norm(b - a, axis=1) < near).mean()))
                shifts.append(float(np.linalg.norm(np.median(b - a, axis=0))))
                widest = lag
        lag = 2 * lag + 1
    if widest < min((count - 1) / 2, 10):
        return False
    still = (np.array(shares) > 0.4) & (np.array(shifts) < 0.7 * near)
    return float(still.mean()) > 0.95


def wide_pairs(features: Sequence[Features], matches: Mapping[tuple[int, int], Matches]) -> list[Wide]:
    """For each key frame the farthest one with which it still shares enough matches."""
    chosen: dict[int, int] = {}
    for (i, j), pair in sorted(matches.items()):
        if len(pair) >= max(FEWEST, 0.1 * min(len(features[i].pixels), len(features[j].pixels))):
            chosen[i] = max(chosen.get(i, j), j)
    wide = []
    for i, j in sorted(chosen.items()):
        pair = matches[i, j]
        wide.append(Wide(i, j, features[i].pixels[pair[:, 0]], features[j].pixels[pair[:, 1]]))
    return wide


def turn_between(a: Array, b: Array, focal: float, centre: Array, rounds: int = 6) -> tuple[Array, Array]:
    """The rotation (3, 3) that takes the rays of pixels ``a`` to those of ``b``, and the misses (k,) in pixels."""
    u = np.concatenate([(a - centre) / focal, np.ones((len(a), 1))], axis=1)
    v = np.concatenate([(b - centre) / focal, np.ones((len(b), 1))], axis=1)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    weight = np.ones(len(a))
    R, missed = np.eye(3), np.full(len(a), np.inf)
    for _ in range(rounds):
        left, _, right = np.linalg.svd((v * weight[:, None]).T @ u)
        R = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
        seen = u @ R.T
        with np.errstate(divide="ignore", invalid="ignore"):
            missed = np.linalg.norm(focal * seen[:, :2] / seen[:, 2:] + centre - b, axis=1)
        missed = np.where(seen[:, 2] > 0, missed, 1e4)
        scale = max(1.5 * float(np.median(missed)), 0.2)
        weight = 1 / (1 + (missed / scale) ** 2)
    return R, missed


def rotation_focal(wide: Sequence[Wide], centre: Array, longest: int) -> float:
    """The one focal length, pixels, with which rotations explain the pairs best."""

    def cost(focal: float) -> float:
        missed = np.concatenate([turn_between(w.a, w.b, focal, centre)[1] for w in wide])
        limit = 4 * SIGMA * longest
        return float(np.mean(np.log1p((missed / limit) ** 2)))

    grid = longest * np.geomspace(0.35, 6.0, 22)
    costs = [cost(f) for f in grid]
    best = int(np.argmin(costs))
    low, high = np.log(grid[max(0, best - 1)]), np.log(grid[min(len(grid) - 1, best + 1)])
    golden = (np.sqrt(5) - 1) / 2
    x, y = high - golden * (high - low), low + golden * (high - low)
    at_x, at_y = cost(float(np.exp(x))), cost(float(np.exp(y)))
    for _ in range(14):
        if at_x < at_y:
            high, y, at_y = y, x, at_x
            x = high - golden * (high - low)
            at_x = cost(float(np.exp(x)))
        else:
            low, x, at_x = x, y, at_y
            y = low + golden * (high - low)
            at_y = cost(float(np.exp(y)))
    return float(np.exp(0.5 * (low + high)))


FocalKnown = Literal["well", "weakly", "not"]


def focal_known(wide: Sequence[Wide], centre: Array, focal: float, guess: float) -> FocalKnown:
    """How much worse rotations explain the pairs with another focal length: "not" if the guess does as well."""

    def missed(f: float) -> float:
        return float(np.median(np.concatenate([turn_between(w.a, w.b, f, centre)[1] for w in wide])))

    here = missed(focal)
    if missed(guess) < 1.1 * here + 0.02 and min(missed(focal / 1.5), missed(focal * 1.5)) < 1.1 * here + 0.02:
        return "not"
    return "weakly" if min(missed(focal / 1.25), missed(focal * 1.25)) < 1.2 * here + 0.02 else "well"


def _score(missed: Array, sigma: float, dimension: int, parameters: float) -> float:
    loss = np.minimum((missed / sigma) ** 2, 2.0 * (4 - dimension))
    return float(loss.sum() + LOG4 * dimension * len(missed) + np.log(4.0 * len(missed)) * parameters)


def _misses(wide: Wide) -> tuple[Array, Array]:
    """Misses (k,) of the best homography and of the best epipolar geometry, pixels."""
    import cv2

    cv2.setRNGSeed(0)
    a, b = wide.a, wide.b
    H, _ = cv2.findHomography(a, b, cv2.RANSAC, 3.0)
    F, _ = cv2.findFundamentalMat(a, b, cv2.FM_RANSAC, 1.5, 0.999)
    one = np.ones((len(a), 1))
    A, B = np.concatenate([a, one], axis=1), np.concatenate([b, one], axis=1)
    flat = np.full(len(a), 1e4)
    with np.errstate(divide="ignore", invalid="ignore"):
        if H is not None:
            q = A @ H.T
            flat = np.nan_to_num(np.linalg.norm(q[:, :2] / q[:, 2:] - b, axis=1), nan=1e4, posinf=1e4)
        if F is None or F.shape != (3, 3):
            return flat, np.full(len(a), 1e4)
        line, back = A @ F.T, B @ F
        epipolar = np.abs((B * line).sum(1)) / np.sqrt((line[:, :2] ** 2).sum(1) + (back[:, :2] ** 2).sum(1))
    return flat, np.nan_to_num(epipolar, nan=1e4, posinf=1e4)


def weigh(wide: Sequence[Wide], centre: Array, longest: int, focal: float | None = None) -> Evidence:
    """Score rotation (one focal length), homography and epipolar geometry on the wide pairs."""
    sigma = SIGMA * longest
    turning = focal or rotation_focal(wide, centre, longest)
    total = np.zeros(3)
    misses: tuple[list[Array], ...] = ([], [], [])
    for pair in wide:
        turned = turn_between(pair.a, pair.b, turning, centre)[1]
        flat, epipolar = _misses(pair)
        for kind, (missed, dimension, parameters) in enumerate(
            ((turned, 2, 3 + 1 / len(wide)), (flat, 2, 8), (epipolar, 3, 7))
        ):
            total[kind] += _score(missed, sigma, dimension, parameters)
            misses[kind].append(missed)
    count = sum(len(w.a) for w in wide)
    medians = [float(np.median(np.concatenate(m))) for m in misses]
    moved = float(np.median(np.concatenate([np.linalg.norm(w.a - w.b, axis=1) for w in wide])))
    scores = total / count
    return Evidence(
        float(scores[0]), float(scores[1]), float(scores[2]), (medians[0], medians[1], medians[2]), turning, moved
    )
