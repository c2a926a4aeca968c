"""Atom distances that do not care which way the performer faces: least over one common yaw for the whole window."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent
from tvmedit.compiled import compiled_sums
from tvmedit.features.feature import Features

YAWS = 48
BLOCK = 128


def yaw_free_atom_distances(
    features: Features,
    taps: NDArray[np.float64],
    *,
    harmonics: int | None = None,
    yaws: int = YAWS,
    progress: Progress | None = None,
) -> NDArray[np.float32]:
    """Distance of every two atoms, least over one common turn about the up axis.

    The square is the window-weighted mean of the squared Hellinger distances of the frames in the two windows; the
    correlation over azimuth comes from cross-spectra: one matrix product a harmonic, summed along the diagonals, one
    inverse transform a pair. Only the upper half is computed, in blocks of rows.

    Parameters
    ----------
    features : Features
        Robust ones of n frames.
    taps : (2 K + 1,) float64
        Window that sums to 1.
    harmonics : int, optional
        Azimuth harmonics used; all of them by default, 5 for a preview.
    yaws : int
        Angles tried.

    Returns
    -------
    (n, n) float32, symmetric, 0 on the diagonal
    """
    if features.method != "robust":
        raise InputError('Only robust features can be turned: use method="robust".')
    n, half = len(features), len(taps) // 2
    spectrum = np.fft.rfft(features.histograms, axis=3).astype(np.complex64)
    bins = features.parts[2]
    used = spectrum.shape[3] if harmonics is None else min(harmonics + 1, spectrum.shape[3])
    spectrum = spectrum[..., :used].reshape(n, -1, used)
    # Both windows are clamped at the ends: frame -1 is frame 0.
    clamped = np.clip(np.arange(-half, n + half), 0, n - 1)
    parts = [_pair(spectrum[clamped, :, k]) for k in range(used)]
    waves = _waves(used, bins, yaws)
    power = (features.histograms.reshape(n, -1).astype(np.float64) ** 2).sum(axis=1)[clamped]
    energy = np.convolve(power, taps[::-1], mode="valid")
    window = taps.astype(np.float32)
    distances = np.zeros((n, n), np.float32)
    report = progress or silent
    report(0.0)
    for first in range(0, n, BLOCK):
        last = min(first + BLOCK, n)
        rows, columns = slice(first, last + 2 * half), slice(first, n + 2 * half)
        cross = np.empty((2 * used, last - first + 2 * half, n - first + 2 * half), np.float32)
        for k in range(used):
            left, crossed = parts[k]
            np.matmul(left[rows], left[columns].T, out=cross[2 * k])
            np.matmul(left[rows], crossed[columns].T, out=cross[2 * k + 1])
        summed = np.zeros((last - first, 2 * used, n - first), np.float32)
        _slide(cross, window, summed)
        # The largest correlation over all turns: one matrix product a row of pairs.
        best = np.empty((last - first, n - first), np.float32)
        for row in range(last - first):
            np.max(waves @ summed[row], axis=0, out=best[row])
        square = energy[first:last, None] + energy[first:] - 2.0 * best
        distances[first:last, first:] = np.sqrt(np.maximum(square, 0.0))
        report(1.0 - ((n - last) / n) ** 2)
    upper = np.triu(distances, 1)
    return upper + upper.T


def _pair(values: NDArray[np.complex64]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Real matrices whose products give the real and the imaginary part of conj(a) b."""
    left = np.concatenate([values.real, values.imag], axis=1)
    crossed = np.concatenate([values.imag, -values.real], axis=1)
    return np.ascontiguousarray(left), np.ascontiguousarray(crossed)


def _waves(used: int, bins: int, yaws: int) -> NDArray[np.float32]:
    """Inverse real transform of (real, imaginary) pairs at evenly spaced turns, (yaws, 2 used)."""
    harmonic = np.arange(used)
    twice = np.where((harmonic == 0) | (2 * harmonic == bins), 1.0, 2.0) / bins
    angle = 2 * np.pi * harmonic[:, None] * np.arange(yaws) / yaws
    waves = np.empty((2 * used, yaws))
    waves[0::2] = twice[:, None] * np.cos(angle)
    waves[1::2] = -twice[:, None] * np.sin(angle)
    return np.ascontiguousarray(waves.T, dtype=np.float32)


@compiled_sums
def _slide(
    cross: NDArray[np.float32], window: NDArray[np.float32], summed: NDArray[np.float32]
) -> None:  # pragma: no cover - compiled
    """Sum cross-spectra (depth, i, j) along diagonals under the window, into (i, depth, j)."""
    rows, depth, columns = summed.shape
    for i in range(rows):
        for k in range(depth):
            total = summed[i, k]
            for tap in range(len(window)):
                weight = window[tap]
                line = cross[k, i + tap]
                for j in range(columns):
                    total[j] += weight * line[j + tap]
