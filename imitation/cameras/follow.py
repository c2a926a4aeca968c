"""Corners followed from frame to frame: what moves how far, where new key frames are worth it, where a cut is."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.clip import Clip, Grey
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

CORNERS = 900
WINDOW = 15
LEVELS = 4
ROUND_TRIP = 0.5  # pixels: forward and back again
SETTLE = 15  # pixels: window in which a corner is compared with its first picture
STRAY = 1.0  # pixels: a first picture that fits farther away does not fit
FRESH = 8  # frames: until then a corner has drifted by less than the fit to its first picture is noisy


@attrs.frozen(eq=False)
class Tracks:
    """Corners followed through a clip, in pixels of the working size.

    Attributes
    ----------
    ids : one (k,) array a frame, names of the corners seen there, ascending.
    pixels : one (k, 2) array a frame, beside ``ids``.
    motion : (n,) median length of the step from the frame before, pixels (0 for the first).
    sharpness : (n,) gradient energy of each frame, for choosing among neighbours.
    survived : (n,) share of the corners of the frame before that were found again.
    likeness : (n,) correlation of the small picture with that of the frame before.
    """

    ids: list[NDArray[np.int64]]
    pixels: list[Array]
    motion: Array
    sharpness: Array
    survived: Array
    likeness: Array

    def __len__(self) -> int:
        return len(self.ids)

    def common(self, first: int, second: int) -> tuple[Array, Array]:
        """Pixels (k, 2) in two frames of the corners seen in both."""
        _, a, b = np.intersect1d(self.ids[first], self.ids[second], assume_unique=True, return_indices=True)
        return self.pixels[first][a], self.pixels[second][b]


def _small(grey: Grey) -> Array:
    import cv2

    small = cv2.resize(grey, (32, 18), interpolation=cv2.INTER_AREA).astype(np.float64).ravel()
    small -= small.mean()
    return np.asarray(small / (np.linalg.norm(small) + 1e-9))


def _fresh(grey: Grey, allowed: Grey | None, pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """New corners away from those there are and from the subject."""
    import cv2

    apart = max(4, round(0.011 * max(grey.shape)))
    free = np.full(grey.shape, 255, np.uint8) if allowed is None else allowed.copy()
    for x, y in np.rint(pixels).astype(int):
        cv2.circle(free, (int(x), int(y)), apart, 0, -1)
    wanted = CORNERS - len(pixels)
    found = cv2.goodFeaturesToTrack(grey, wanted, 0.004, apart, mask=free, blockSize=5) if wanted > 0 else None
    if found is None:
        return np.zeros((0, 2), np.float32)
    corners: NDArray[np.float32] = found.reshape(-1, 2)
    return corners


def _inside(pixels: NDArray[np.float32], grey: Grey, allowed: Grey | None) -> NDArray[np.bool_]:
    height, width = grey.shape
    x, y = pixels[:, 0], pixels[:, 1]
    good = np.isfinite(pixels).all(1) & (x >= 3) & (y >= 3) & (x <= width - 4) & (y <= height - 4)
    if allowed is not None:
        column = np.clip(np.nan_to_num(x), 0, width - 1).astype(int)
        row = np.clip(np.nan_to_num(y), 0, height - 1).astype(int)
        good &= allowed[row, column] > 0
    checked: NDArray[np.bool_] = good
    return checked


@attrs.define(eq=False)
class _Alive:
    """The corners that are being followed, with the pictures in which they were first seen."""

    pixels: NDArray[np.float32] = attrs.field(factory=lambda: np.zeros((0, 2), np.float32))
    names: NDArray[np.int64] = attrs.field(factory=lambda: np.zeros(0, np.int64))
    born: NDArray[np.int64] = attrs.field(factory=lambda: np.zeros(0, np.int64))
    origin: NDArray[np.float32] = attrs.field(factory=lambda: np.zeros((0, 2), np.float32))
    pictures: dict[int, Grey] = attrs.field(factory=dict)
    drift: NDArray[np.float32] = attrs.field(factory=lambda: np.zeros(2, np.float32))
    following: int = 0

    def keep(self, good: NDArray[np.bool_]) -> None:
        """Drop the others, and the pictures that nobody needs any more."""
        self.pixels, self.names, self.origin = self.pixels[good], self.names[good], self.origin[good]
        self.born = self.born[good]
        alive = set(np.unique(self.born).tolist())
        self.pictures = {frame: picture for frame, picture in self.pictures.items() if frame in alive}

    def add(self, new: NDArray[np.float32], frame: int, grey: Grey) -> None:
        """Begin to follow corners of this frame."""
        self.pixels = np.concatenate([self.pixels, new]).astype(np.float32)
        self.origin = np.concatenate([self.origin, new]).astype(np.float32)
        self.names = np.concatenate([self.names, np.arange(self.following, self.following + len(new))])
        self.born = np.concatenate([self.born, np.full(len(new), frame, np.int64)])
        self.pictures[frame] = grey
        self.following += len(new)

    def step(self, before: Grey, grey: Grey, allowed: Grey | None) -> tuple[float, float]:
        """Follow into the next frame and back; give the share found again and the median step, pixels."""
        import cv2

        options: dict[str, Any] = {"winSize": (WINDOW, WINDOW), "maxLevel": LEVELS}
        options["flags"] = cv2.OPTFLOW_USE_INITIAL_FLOW
        moved, found, _ = cv2.calcOpticalFlowPyrLK(before, grey, self.pixels, self.pixels + self.drift, **options)
        back, again, _ = cv2.calcOpticalFlowPyrLK(grey, before, moved, moved - self.drift, **options)
        good = (found.ravel() == 1) & (again.ravel() == 1) & _inside(moved, grey, allowed)
        good &= np.linalg.norm(back - self.pixels, axis=1) <= ROUND_TRIP
        median = 0.0
        if good.any():
            steps = moved[good] - self.pixels[good]
            self.drift = np.median(steps, axis=0).astype(np.float32)
            median = float(np.median(np.linalg.norm(steps, axis=1)))
        self.pixels = moved
        self.keep(good)
        return float(good.mean()), median

    def settle(self, frame: int, grey: Grey) -> None:
        """Move each corner to where its first picture fits, so that small errors of many steps do not add up.

        One that looks different by now (blur, another side) stays where its last step took it.
        """
        import cv2

        for born in np.unique(self.born[self.born < frame - FRESH]).tolist():
            here = np.flatnonzero(self.born == born)
            first = self.pixels[here]
            settled, found, _ = cv2.calcOpticalFlowPyrLK(
                self.pictures[born],
                grey,
                self.origin[here],
                first.copy(),
                winSize=(SETTLE, SETTLE),
                maxLevel=0,
                criteria=(cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 20, 0.005),
                flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
            )
            near = (found.ravel() == 1) & (np.linalg.norm(settled - first, axis=1) < STRAY)
            self.pixels[here[near]] = settled[near]


def follow_corners(clip: Clip, progress: Progress | None = None) -> Tracks:
    """Follow corners through the clip, forward, each step checked by going back; lost ones are replaced."""
    import cv2

    report = progress or silent
    count = len(clip)
    ids: list[NDArray[np.int64]] = []
    places: list[Array] = []
    motion, sharpness = np.zeros(count), np.zeros(count)
    survived, likeness = np.ones(count), np.ones(count)
    before = np.zeros((0, 0), np.uint8)
    before_small = np.zeros(0)
    alive = _Alive()
    for frame in range(count):
        report(frame / count)
        grey, allowed = clip.grey(frame), clip.background(frame)
        small = _small(grey)
        dx, dy = cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(grey, cv2.CV_32F, 0, 1)
        sharpness[frame] = float(np.mean(np.hypot(dx, dy)))
        if frame:
            likeness[frame] = float(small @ before_small)
            survived[frame] = 0.0
            if len(alive.pixels):
                survived[frame], motion[frame] = alive.step(before, grey, allowed)
                alive.settle(frame, grey)
        if len(alive.pixels) < 0.8 * CORNERS:
            alive.add(_fresh(grey, allowed, alive.pixels), frame, grey)
        ids.append(alive.names.copy())
        places.append(alive.pixels.astype(np.float64))
        before, before_small = grey, small
    report(1.0)
    return Tracks(ids, places, motion, sharpness, survived, likeness)


def key_frames(tracks: Tracks, width: int, most: int = 25) -> list[int]:
    """Frames for wide pairs: evenly spaced in camera motion, the sharpest of their neighbours, first and last in.

    About every third to eighth frame and at most ``most``, unless the picture moves so far that neighbouring
    key frames would share too little.
    """
    count = len(tracks)
    if count <= 3:
        return list(range(count))
    travelled = np.cumsum(tracks.motion) / width
    total = float(travelled[-1])
    wanted = int(np.clip(total / 0.05, max(12, count / 5), min(most, count / 3)))
    wanted = min(max(wanted, int(np.ceil(total / 0.15)) + 1, 3), count)
    # Time keeps its share so that a pause is not left without a key frame.
    clock = 0.7 * travelled / max(total, 1e-9) + 0.3 * np.linspace(0, 1, count)
    chosen: list[int] = []
    for mark in np.linspace(0, clock[-1], wanted):
        frame = int(np.argmin(np.abs(clock - mark)))
        reach = max(0, min(2, count // (4 * wanted)))
        near = range(max(0, frame - reach), min(count, frame + reach + 1))
        if 0 < frame < count - 1:
            frame = max(near, key=lambda t: (tracks.sharpness[t], -abs(t - frame)))
        if frame not in chosen:
            chosen.append(frame)
    return sorted(chosen)
