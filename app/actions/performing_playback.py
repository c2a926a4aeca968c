"""Frames made ready to be drawn: of the composed performance, or of a sequence as captured."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.performing_frames import performance_frames, sequence_footage
from app.actions.session import Session
from app.formats.images import read_image
from app.formats.tvm import FrameMesh, painted

LARGEST = 1024
"""Pixels of a picture's longer side while it is played."""


@attrs.frozen(eq=False)
class ShownFrame:
    """A mesh as a renderer takes it; world, metres, z up.

    Attributes
    ----------
    vertices, normals : (v, 3) float32. faces : (m, 3) int32. colours : (v, 3) uint8, None where it has none.
    low, high : corners (3,) of the box around it.
    closed : whether its inside is never seen.
    sequence : number of the sequence it comes from. source : its frame there. blended : whether it is an in-between.
    coordinates : (v, 2) float32 places in ``picture`` (h, w, 3) uint8, (0, 0) its lower left corner, rows from the top;
        None where it wears no picture. Vertices are doubled where the picture has a seam.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8] | None
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    sequence: int
    source: int
    blended: bool = False
    closed: bool = False
    coordinates: NDArray[np.float32] | None = None
    picture: NDArray[np.uint8] | None = None

    @property
    def size(self) -> int:
        """Bytes that it keeps."""
        arrays = (self.vertices, self.normals, self.faces, self.colours, self.coordinates, self.picture)
        return sum(each.nbytes for each in arrays if each is not None)


class ShownFrames(Sequence[ShownFrame]):
    """``frames[k]`` reads and prepares one frame; safe to use from another thread than the window's.

    Attributes
    ----------
    fps : frames a second.
    """

    def __init__(self, meshes: Any, fps: float, sequence: int | None) -> None:
        self._meshes, self.fps, self._sequence = meshes, fps, sequence

    def __len__(self) -> int:
        return len(self._meshes)

    def __getitem__(self, position: Any) -> Any:
        if isinstance(position, slice):
            return [self[k] for k in range(len(self))[position]]
        position = range(len(self))[position]
        mesh = self._meshes[position]
        if self._sequence is not None:
            return ready(mesh, self._sequence, position)
        sequence, source = (int(value) for value in self._meshes.performance.frames[position])
        return ready(mesh, sequence, source, self._meshes.blended(position))


def ready(mesh: FrameMesh, sequence: int, source: int, blended: bool = False) -> ShownFrame:
    """Prepare one mesh: single precision, normals, the box around it, its picture where it wears one."""
    from imitation.geometry.drawing import drawn_normals, hides_its_inside

    vertices = np.ascontiguousarray(mesh.vertices, np.float32)
    faces = np.ascontiguousarray(mesh.faces, np.int32).reshape(-1, 3)
    columns = vertices.T
    low, high = (np.array([end(column) for column in columns], np.float64) for end in (np.min, np.max))
    normals, closed = drawn_normals(vertices, faces), bool(hides_its_inside(vertices, faces))
    worn = _worn(mesh) if mesh.colours is None else None
    if worn is not None:
        index, split, coordinates, picture = worn
        return ShownFrame(
            vertices[index],
            normals[index],
            split,
            None,
            low,
            high,
            sequence,
            source,
            blended,
            closed,
            coordinates,
            picture,
        )
    colours = painted(mesh).colours
    paint = None if colours is None else np.ascontiguousarray(colours[:, :3], np.uint8)
    return ShownFrame(vertices, normals, faces, paint, low, high, sequence, source, blended, closed)


Worn = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float32], NDArray[np.uint8]]


def _worn(mesh: FrameMesh) -> Worn | None:
    """How a mesh wears its picture: vertex of each place (w,), faces (m, 3) of places, coordinates (w, 2), picture.

    None where it wears none or several, or not everywhere: then its colours are sampled at the vertices.
    """
    texture = mesh.texture
    if texture is None or not len(mesh.faces):
        return None
    number = int(texture.image_of_face[0])
    if number < 0 or (texture.image_of_face != number).any() or (texture.corners < 0).any():
        return None
    count = len(texture.coordinates)
    pairs = mesh.faces.astype(np.int64) * count + texture.corners
    places, inverse = np.unique(pairs, return_inverse=True)
    path = texture.images[number]
    picture = _small_picture(path, path.stat().st_mtime_ns)
    coordinates = np.ascontiguousarray(texture.coordinates[places % count], np.float32)
    return places // count, inverse.reshape(-1, 3).astype(np.int32), coordinates, picture


@lru_cache(maxsize=4)
def _small_picture(path: Path, written: int) -> NDArray[np.uint8]:
    """A picture, made smaller where it is larger than a view can show."""
    import cv2

    del written  # part of the key only: a picture that was painted over is read again
    picture = read_image(path)
    share = LARGEST / max(picture.shape[:2])
    if share < 1:
        picture = np.asarray(cv2.resize(picture, None, fx=share, fy=share, interpolation=cv2.INTER_AREA), np.uint8)
    return np.ascontiguousarray(picture)


def performance_shown(session: Session, *, blended: bool = True, aligned: bool = True) -> ShownFrames:
    """Give the frames of the composed performance; to compare, without in-betweens or every clip as filmed.

    Raises ``InputError`` when it has not been composed.
    """
    frames = performance_frames(session, blended=blended and aligned, aligned=aligned)
    return ShownFrames(frames, frames.fps, None)


def sequence_shown(session: Session, sequence_id: str) -> ShownFrames:
    """Give the frames of a sequence as captured."""
    sequences = session.document.sequences
    number = [each.id for each in sequences].index(sequence_id)
    return ShownFrames(sequence_footage(session, sequence_id), sequences[number].fps, number)
