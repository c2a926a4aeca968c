"""SIFT features of key frames and their matches over wide pairs."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.clip import Clip
from imitation.geometry.projection import Array
from imitation.progress import Progress, steps

FEATURES = 2000
CELLS = 8  # the strongest of each cell first, so that one busy corner does not take all
RATIO = 0.8
LENGTH = 512.0  # of a descriptor; sums of products of whole numbers this small are exact in float32

Matches = NDArray[np.int64]


@attrs.frozen(eq=False)
class Features:
    """Features of one frame: pixels (k, 2) of the working size and root-SIFT descriptors (k, 128)."""

    frame: int
    pixels: Array
    descriptors: NDArray[np.float32]


def _spread(response: Array, pixels: Array, size: tuple[int, int], most: int) -> NDArray[np.int64]:
    """Indices of the features to keep: round by round the strongest that each cell has left."""
    column = np.clip(pixels[:, 0] / size[0] * CELLS * 2, 0, CELLS * 2 - 1).astype(int)
    row = np.clip(pixels[:, 1] / size[1] * CELLS, 0, CELLS - 1).astype(int)
    cell = row * CELLS * 2 + column
    order = np.lexsort((pixels[:, 1], pixels[:, 0], -response, cell))
    first = np.searchsorted(cell[order], cell[order])
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order)) - first
    best = np.lexsort((pixels[:, 1], pixels[:, 0], -response, place))
    return np.sort(best[:most])


def find_features(clip: Clip, frame: int, most: int = FEATURES) -> Features:
    """At most ``most`` SIFT features of the background, spread over the picture."""
    import cv2

    grey, allowed = clip.grey(frame), clip.background(frame)
    sift = cv2.SIFT_create(  # type: ignore[attr-defined]
        nfeatures=0, nOctaveLayers=3, contrastThreshold=0.015, edgeThreshold=10, sigma=1.6, enable_precise_upscale=True
    )
    found = sift.detect(grey, allowed)
    if not found:
        return Features(frame, np.zeros((0, 2)), np.zeros((0, 128), np.float32))
    pixels = np.array([k.pt for k in found], np.float64)
    response = np.array([k.response for k in found], np.float64)
    kept = _spread(response, pixels, clip.working_size, most)
    found, raw = sift.compute(grey, [found[i] for i in kept])
    rooted = np.sqrt(raw / np.maximum(raw.sum(1, keepdims=True), 1e-9))
    descriptors = np.rint(rooted * LENGTH).astype(np.float32)
    return Features(frame, np.array([k.pt for k in found], np.float64), descriptors)


def match(first: Features, second: Features) -> Matches:
    """Pairs (m, 2) of features that are each other's best and clearly better than the next."""
    a, b = first.descriptors, second.descriptors
    if len(a) < 2 or len(b) < 2:
        return np.zeros((0, 2), np.int64)
    distance = (a * a).sum(1)[:, None] + (b * b).sum(1)[None, :] - 2 * (a @ b.T)
    rows = np.arange(len(a))
    best = distance.argmin(1)
    nearest = distance[rows, best]
    mutual = distance.argmin(0)[best] == rows
    distance[rows, best] = np.inf
    good = mutual & (nearest < RATIO**2 * distance.min(1))
    return np.stack([rows[good], best[good]], axis=1)


def pairs_of(count: int, near: int = 5) -> list[tuple[int, int]]:
    """Pairs of key frames worth matching: the ``near`` next ones, then at doubling distance."""
    chosen = {(i, i + d) for d in range(1, near + 1) for i in range(count - d)}
    distance = 8
    while distance < count:
        chosen |= {(i, i + distance) for i in range(count - distance)}
        distance *= 2
    return sorted(chosen)


def match_pairs(
    features: Sequence[Features], pairs: Sequence[tuple[int, int]], progress: Progress | None = None
) -> dict[tuple[int, int], Matches]:
    """Matches of many pairs, by indices into ``features``."""
    return {(i, j): match(features[i], features[j]) for i, j in steps(pairs, progress)}
