# mypy: disable-error-code="untyped-decorator"
"""How many other frames' depths confirm each pixel's."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.sweep import geometry
from imitation.geometry.projection import Camera


def agreeing(
    inverse: NDArray[np.float32],
    camera: Camera,
    others: Sequence[NDArray[np.float32]],
    cameras: Sequence[Camera],
    tolerance: float,
) -> NDArray[np.uint8]:
    """Count (h, w) of the other frames in which the same place is seen at the same depth.

    Parameters
    ----------
    inverse : (h, w) inverse depth, 0 where none; of the others too.
    tolerance : difference of inverse depths in the reference that still counts as the same.
    """
    count = np.zeros(inverse.shape, np.uint8)
    if others:
        poses = [(each.K, each.R, each.T) for each in cameras]
        maps = geometry((camera.K, camera.R, camera.T), poses)
        for n, other in enumerate(others):
            _agree(inverse, other, maps.A[n], maps.b[n], maps.back_b[n], np.float32(tolerance), count)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _agree(inverse: Any, other: Any, A: Any, b: Any, back_b: Any, tolerance: Any, count: Any) -> None:
    height, width = inverse.shape
    for y in range(height):
        for x in range(width):
            w = inverse[y, x]
            if w <= 0:
                continue
            z = A[2, 0] * x + A[2, 1] * y + A[2, 2] + w * b[2]
            if z <= 0:
                continue
            u = (A[0, 0] * x + A[0, 1] * y + A[0, 2] + w * b[0]) / z
            v = (A[1, 0] * x + A[1, 1] * y + A[1, 2] + w * b[1]) / z
            if not (u >= -0.5 and v >= -0.5 and u < width - 0.5 and v < height - 0.5):
                continue
            there = other[int(v + 0.5), int(u + 0.5)]
            if there <= 0:
                continue
            # The inverse depth in the reference of what the other sees: w1 = w2 z2 / z1.
            scale = 1 / z + (there - w / z) * back_b[2]
            if scale > 0 and abs(there / scale - w) <= tolerance and count[y, x] < 255:
                count[y, x] += 1
