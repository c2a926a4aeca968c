"""Frame distances (eq. 2-4) and atom distances (eq. 5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent
from tvmedit.features.feature import Features

Array = NDArray[np.float64]
PAPER_TAPS = (0.25, 0.5, 1.0, 0.5, 0.25)
"""The printed window of eq. 5: half a second at ten frames a second."""
BLOCK = 256


def hann_taps(fps: float, seconds: float = 0.5) -> Array:
    """Hann window of an atom: 2 K + 1 taps with K = round(fps * seconds / 2), at least 1; the taps sum to 1."""
    half = max(1, round(fps * seconds / 2))
    window = np.hanning(2 * half + 3)[1:-1]
    return np.asarray(window / window.sum())


def frame_distances(
    features: Features,
    other: Features | None = None,
    *,
    headings: Array | None = None,
    other_headings: Array | None = None,
    progress: Progress | None = None,
) -> NDArray[np.float32]:
    """Distance of every two frames (eq. 2).

    "paper": the Euclidean distances of the three histograms, combined (eq. 2-4). "robust": the Hellinger distance of
    the joint histograms, at a fixed yaw: the world's, or each frame's own heading if ``headings`` are given.

    Parameters
    ----------
    features, other : Features
        Of one method; other=None compares a sequence with itself.
    headings, other_headings : (n,), (m,) float64, optional
        Radians; only for "robust".

    Returns
    -------
    (n, m) float32
    """
    own = other is None
    second = features if other is None else other
    if second.method != features.method:
        raise InputError(f'Features of method "{features.method}" cannot be compared with "{second.method}": use one.')
    left, right = _rows(features, headings), _rows(second, headings if own else other_headings)
    if left.shape[1] != right.shape[1]:
        left, right = _same_bins(features, second)
    squares_left, squares_right = (left**2).sum(axis=1), (right**2).sum(axis=1)
    distances = np.empty((len(left), len(right)), np.float32)
    report = progress or silent
    for first in range(0, len(left), BLOCK):
        rows = slice(first, first + BLOCK)
        square = squares_left[rows, None] + squares_right - 2.0 * (left[rows] @ right.T)
        distances[rows] = np.sqrt(np.maximum(square, 0.0))
        report(min(1.0, (first + BLOCK) / len(left)))
    if own:
        np.fill_diagonal(distances, 0.0)
        distances = np.asarray(0.5 * (distances + distances.T), np.float32)
    return distances


def turned(features: Features, headings: Array) -> NDArray[np.float32]:
    """Robust histograms turned back by each frame's heading, (n, d) float32: all performers face +x."""
    spectrum = np.fft.rfft(features.histograms, axis=3)
    harmonics = np.arange(spectrum.shape[3])
    spectrum *= np.exp(1j * np.asarray(headings)[:, None] * harmonics)[:, None, None, :]
    back = np.fft.irfft(spectrum, n=features.parts[2], axis=3)
    return np.asarray(back.reshape(len(back), -1), np.float32)


def _rows(features: Features, headings: Array | None) -> Array:
    if headings is not None and features.method == "robust":
        return turned(features, headings).astype(np.float64)
    return features.histograms.reshape(len(features), -1).astype(np.float64)


def _same_bins(first: Features, second: Features) -> tuple[Array, Array]:
    """Pad the r histograms of two printed features to one number of bins (eq. 4)."""
    if first.parts[1:] != second.parts[1:]:
        raise InputError("The two sequences were described with different bins: use the same bin sizes for both.")
    most = max(first.parts[0], second.parts[0])
    padded = []
    for features in (first, second):
        radius = features.histograms[:, : features.parts[0]]
        wide = np.pad(radius, ((0, 0), (0, most - radius.shape[1])))
        padded.append(np.concatenate([wide, features.histograms[:, features.parts[0] :]], axis=1).astype(np.float64))
    return padded[0], padded[1]


def atom_distances(
    frame_distances: NDArray[np.floating], taps: Sequence[float] | Array | None = None
) -> NDArray[np.float32]:
    """Distance of every two atoms (eq. 5): frame distances summed along the diagonal under a window.

    At the ends of a sequence the frame numbers are clamped: a missing tap would make the ends look alike.

    Parameters
    ----------
    frame_distances : (n, m) float
    taps : odd number of floats, optional
        Default: 0.25, 0.5, 1, 0.5, 0.25 as printed.

    Returns
    -------
    (n, m) float32
    """
    window = np.asarray(PAPER_TAPS if taps is None else taps, np.float64)
    if window.ndim != 1 or len(window) % 2 == 0:
        raise InputError(f"An atom needs an odd number of taps, but got {len(window)}.")
    distances = np.asarray(frame_distances)
    if distances.ndim != 2 or min(distances.shape) == 0:
        raise InputError(f"The frame distances have shape {distances.shape}: give a matrix with at least one frame.")
    if not np.isfinite(distances).all():
        raise InputError("The frame distances hold values that are not finite: compute them from finite vertices.")
    half = len(window) // 2
    rows, columns = distances.shape
    atoms = np.zeros((rows, columns), np.float64)
    # Row and column are clamped together, tap by tap, as the two windows slide as one.
    for shift, weight in zip(range(-half, half + 1), window, strict=True):
        row = np.clip(np.arange(rows) + shift, 0, rows - 1)
        column = np.clip(np.arange(columns) + shift, 0, columns - 1)
        atoms += weight * distances[np.ix_(row, column)]
    return atoms.astype(np.float32)
