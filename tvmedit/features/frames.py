"""One frame of a time-varying mesh, checked: what every later step may rely on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]
Faces = NDArray[np.int32]


def check_vertices(vertices: Any, frame: int) -> Array:
    """Vertices of one frame as (v, 3) float64, or an InputError that names the frame."""
    try:
        points = np.ascontiguousarray(vertices, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"Frame {frame} has vertices that are not numbers: give an array of shape (v, 3).") from None
    if points.ndim != 2 or points.shape[1] != 3:
        raise InputError(f"Frame {frame} has vertices of shape {points.shape}: give an array of shape (v, 3).")
    if len(points) == 0:
        raise InputError(f"Frame {frame} has no vertices: leave it out or capture it again.")
    # Values that are not finite reach one end or the other, so that the ends tell of all of them.
    if max(float(points.max()), -float(points.min())) < 1e12:
        return points
    if not np.isfinite(points).all():
        count = int((~np.isfinite(points)).any(axis=1).sum())
        raise InputError(
            f"Frame {frame} has {count} vertices that are not finite numbers: repair or leave out that frame."
        )
    raise InputError(f"Frame {frame} has vertices more than 1e12 units away: repair or leave out that frame.")


def check_faces(faces: Any, count: int, frame: int) -> Faces:
    """Triangles of one frame as (m, 3) int32, or an InputError that names the frame."""
    triangles = np.asarray(faces)
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise InputError(
            f"Frame {frame} has faces of shape {triangles.shape}: give triangles as an array of shape (m, 3)."
        )
    if len(triangles) == 0:
        raise InputError(f"Frame {frame} has no faces: leave it out or capture it again.")
    if not np.issubdtype(triangles.dtype, np.integer):
        raise InputError(f"Frame {frame} has faces that are not whole numbers: give vertex numbers.")
    if int(triangles.min()) < 0 or int(triangles.max()) >= count:
        raise InputError(f"Frame {frame} has faces that name vertices beyond its {count}: the mesh is damaged.")
    return np.ascontiguousarray(triangles, dtype=np.int32)


def upright(points: Array, up: str) -> Array:
    """Vertices turned so that z is up; up is "z" or "y" (y up becomes z up, right-handed)."""
    if up == "z":
        return points
    if up == "y":
        return np.ascontiguousarray(np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1))
    raise InputError(f'The up axis is {up!r}: say "z" or "y".')


def checked_meshes(meshes: Iterable[tuple[Any, Any]], up: str) -> Iterator[tuple[Array, Faces]]:
    """Check and turn each mesh as it comes; nothing is kept."""
    for frame, mesh in enumerate(meshes):
        try:
            vertices, faces = mesh[0], mesh[1]
        except (TypeError, IndexError, KeyError):
            raise InputError(f"Frame {frame} is not a mesh: give (vertices, faces).") from None
        points = check_vertices(vertices, frame)
        yield upright(points, up), check_faces(faces, len(points), frame)


def as_frames(vertices: Any, faces: Any) -> list[tuple[Array, Faces | None]]:
    """Frames of ``frame_features``: (v, 3), (n, v, 3), or a sequence of (v, 3); faces alike, shared or none."""
    if isinstance(vertices, np.ndarray) and vertices.ndim == 2:
        vertices, faces = [vertices], None if faces is None else [faces]
    shared = faces is not None and isinstance(faces, np.ndarray) and faces.ndim == 2
    each: Sequence[Any] | None = None if faces is None or shared else list(faces)
    frames: list[tuple[Array, Faces | None]] = []
    for frame, mesh in enumerate(vertices):
        points = check_vertices(mesh, frame)
        if each is not None and frame >= len(each):
            raise InputError(f"Frame {frame} has no faces: give faces for every frame, or none at all.")
        own = faces if shared else None if each is None else each[frame]
        frames.append((points, None if own is None else check_faces(own, len(points), frame)))
    if not frames:
        raise InputError("The sequence has no frames: give at least one mesh.")
    return frames
