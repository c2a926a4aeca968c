"""The filmed room shows what its truth says: what is scored against depth must stand in the picture."""

import attrs
import cv2
import numpy as np
import pytest

from resources.world.camera import lateral_camera
from tests.imitation.cameras.scenes import paint
from tests.imitation.depth.scenes import HARD, parts_of, ray_cast


@pytest.mark.parametrize("frame", [0, 20, 39])
def test_every_surface_is_painted_where_it_is_nearest(frame: int) -> None:
    """Faces of a box that turn their back to the camera used to be painted over its top."""
    size = (240, 135)
    parts, _ = parts_of(4, HARD)
    camera = lateral_camera(40, seed=4, size=size)[frame]
    true = 6 * (ray_cast(parts, camera, size)[1] + 1)
    named = [attrs.evolve(part, texture=np.full_like(part.texture, 6 * (i + 1))) for i, part in enumerate(parts)]
    shown = paint(named, camera, size, one_sided=True)[..., 0].astype(int)
    beside = np.ones((3, 3), np.uint8)
    inner = cv2.dilate(true.astype(np.uint8), beside) == cv2.erode(true.astype(np.uint8), beside)
    wrong = inner & (np.abs(shown - true) > 1)
    assert wrong.sum() <= 0.0005 * inner.sum()
    twosided = paint(named, camera, size)[..., 0].astype(int)
    assert (inner & (np.abs(twosided - true) > 1)).sum() > wrong.sum()
