"""Pixel centres stay at integers when frames are reduced, solved and brought back to full size."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from imitation.depth.depthmap import resized, scaled_camera
from imitation.geometry.projection import Camera

FULL, SMALL = (854, 480), (480, 270)
SCALE = (SMALL[0] / FULL[0], SMALL[1] / FULL[1])


def test_a_reduced_camera_sees_a_mark_where_the_reduced_picture_has_it() -> None:
    """A bright spot drawn at a point's pixel, reduced as frames are: its middle is where the small camera says."""
    camera = Camera([[700.0, 0, 426.5], [0, 700.0, 239.5], [0, 0, 1]], np.eye(3), np.zeros(3))
    for point in ([0.0, 0.0, 5.0], [1.3, -0.7, 5.0], [-2.1, 1.1, 5.0]):
        x, y = camera.project(point)
        columns, rows = np.meshgrid(np.arange(FULL[0]), np.arange(FULL[1]))
        spot = np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / (2 * 6.0**2)).astype(np.float32)
        small = cv2.resize(spot, SMALL, interpolation=cv2.INTER_AREA)
        columns, rows = np.meshgrid(np.arange(SMALL[0]), np.arange(SMALL[1]))
        middle = [(small * columns).sum() / small.sum(), (small * rows).sum() / small.sum()]
        assert middle == pytest.approx(scaled_camera(camera, SCALE).project(point), abs=0.02)


def test_depth_that_is_brought_to_full_size_stays_in_its_place() -> None:
    """A slanted plane's inverse depth, exact at the small camera's pixels, is exact at the large one's."""
    small = np.meshgrid(np.arange(SMALL[0]), np.arange(SMALL[1]))
    back = [(c + 0.5) / s - 0.5 for c, s in zip(small, SCALE, strict=True)]
    large = np.meshgrid(np.arange(FULL[0]), np.arange(FULL[1]))

    def plane(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 0.1 + 2e-4 * x + 3e-4 * y

    found = resized(plane(*back).astype(np.float32), FULL, 1.0)
    off = np.abs(found - plane(*large))[4:-4, 4:-4]
    assert off.max() < 0.06 * 2e-4  # pixels; half a one would be eight times as much
