"""What a user would mark on the sample clip: lassos, clicks and contacts, each as roughly as a hand does it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from resources.world.gait import Interval
from resources.world.skeleton import Array

Lasso = list[list[float]]


def lasso(mask: NDArray[np.bool_], rng: np.random.Generator, margin: int = 5, rough: float = 1.5) -> Lasso:
    """A closed line (x, y) drawn round a mask (h, w) with some pixels of margin and of roughness."""
    import cv2

    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * margin + 1, 2 * margin + 1))
    # Drawn over a post, not round it: whoever draws a lasso takes the hidden part in.
    whole = mask.astype(np.uint8)
    for width in (13, 21, 31, 45, 61):
        whole = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((width, width), np.uint8))
        _, _, found, _ = cv2.connectedComponentsWithStats(whole)
        if (found[1:, cv2.CC_STAT_AREA] > 0.004 * mask.sum()).sum() <= 1:
            break
    grown = cv2.dilate(whole, kernel)
    outlines, _ = cv2.findContours(grown, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not outlines:
        return []
    outline = max(outlines, key=cv2.contourArea)
    line = cv2.approxPolyDP(outline, 2.5, True)[:, 0].astype(np.float64)
    line += rng.normal(0, rough, line.shape).clip(-2 * rough, 2 * rough)
    height, width = mask.shape
    line = line.clip(0, [width - 1, height - 1])
    return [[round(float(x), 1), round(float(y), 1)] for x, y in line]


def clicks(
    track: Array, visible: NDArray[np.bool_], rng: np.random.Generator, every: int = 20, error: float = 0.5
) -> dict[int, tuple[float, float]]:
    """Clicks on a track (n, 2) in about every ``every``-th frame where the point is seen, off by up to ``error``."""
    frames = np.flatnonzero(visible)
    found: dict[int, tuple[float, float]] = {}
    for wanted in [*range(0, len(track) - every // 2, every), len(track) - 1]:
        nearest = int(frames[np.argmin(np.abs(frames - wanted))]) if len(frames) else -1
        off = rng.uniform(-error, error, 2)
        if nearest >= 0 and abs(nearest - wanted) <= every // 3:
            found[nearest] = (round(float(track[nearest, 0] + off[0]), 2), round(float(track[nearest, 1] + off[1]), 2))
    return found


def marked(contacts: Mapping[str, Sequence[Interval]], rng: np.random.Generator) -> dict[str, list[tuple[int, int]]]:
    """The contacts that a user marks: all of three frames or more, now and then a frame late or early."""
    found: dict[str, list[tuple[int, int]]] = {}
    for name, spans in contacts.items():
        for first, last, _ in spans:
            late, early = (int(n) for n in rng.integers(0, 2, 2))
            if last - first >= 2:
                span = (first + (late if first else 0), last - early)
                found.setdefault(name, []).append(span if span[1] - span[0] >= 1 else (first, last))
    return found
