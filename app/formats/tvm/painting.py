"""Colours a vertex from a texture, where only colours a vertex can be used."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.images import read_image
from app.formats.tvm.frames import FrameMesh


def painted(mesh: FrameMesh) -> FrameMesh:
    """Give the mesh with colours a vertex, sampled from its texture if it has one and no colours."""
    if mesh.texture is None or mesh.colours is not None:
        return mesh
    texture = mesh.texture
    colours = np.full((len(mesh.vertices), 3), 255, np.uint8)
    for number, path in enumerate(texture.images):
        worn = texture.image_of_face == number
        corners, vertices = texture.corners[worn].reshape(-1), mesh.faces[worn].reshape(-1)
        known = corners >= 0
        at = texture.coordinates[corners[known]]
        picture = _picture(path, path.stat().st_mtime_ns)
        height, width = picture.shape[:2]
        # Outside 0 to 1 the picture repeats; coordinates that are no numbers are its corner.
        with np.errstate(invalid="ignore"):
            u, v = np.nan_to_num(at % 1.0).T
        column = np.minimum((u * width).astype(np.int64), width - 1)
        row = np.minimum(((1.0 - v) * height).astype(np.int64), height - 1)
        colours[vertices[known]] = picture[row, column]
    return attrs.evolve(mesh, colours=colours)


@lru_cache(maxsize=2)
def _picture(path: Path, written: int) -> NDArray[np.uint8]:
    del written  # part of the key only: a picture that was painted over is read again
    return read_image(path)
