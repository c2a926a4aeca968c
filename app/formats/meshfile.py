"""A mesh as a file holds it, and what every reader checks."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError

Up = Literal["y", "z"]


def _floats(value: ArrayLike) -> NDArray[np.float64]:
    array = np.ascontiguousarray(value, np.float64)
    array.setflags(write=False)
    return array


def _indices(value: ArrayLike) -> NDArray[np.int32]:
    array = np.ascontiguousarray(value, np.int32)
    array.setflags(write=False)
    return array


def _bytes(value: ArrayLike | None) -> NDArray[np.uint8] | None:
    if value is None:
        return None
    array = np.ascontiguousarray(value, np.uint8)
    array.setflags(write=False)
    return array


@attrs.frozen(eq=False)
class MeshFile:
    """A triangle mesh with the vertices of its file, in the file's order and number.

    Attributes
    ----------
    vertices : (n, 3) positions in the file's unit.
    faces : (m, 3) vertex indices; polygons are split into fans.
    colors : (n, 3) uint8 sRGB, or None.
    up : the axis that points up where the format defines it (GLB is turned to "z" on reading), else None.
    name : the file's name, for messages.
    """

    vertices: NDArray[np.float64] = attrs.field(converter=_floats)
    faces: NDArray[np.int32] = attrs.field(converter=_indices)
    colors: NDArray[np.uint8] | None = attrs.field(default=None, converter=_bytes)
    up: Up | None = None
    name: str = ""


def mesh_bytes(path: Path) -> bytes:
    """The content of a mesh's file, or an InputError of one sentence."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"The file {path} cannot be read: {error.strerror or error}.") from error
    if not data:
        raise InputError(f"The file {path} is empty: choose another one.")
    return data


def check_mesh(mesh: MeshFile) -> MeshFile:
    """Give the mesh back if it can be used.

    Raises
    ------
    InputError
        NaN or infinite vertices, no vertices, no faces, a face that names a vertex that is not there.
    """
    name = mesh.name or "that was given"
    count = len(mesh.vertices)
    if not count:
        raise InputError(f"The mesh {name} has no vertices: choose another file.")
    # Ends of the whole array first, which NaN and infinite values reach: a mask a value takes several times as long.
    if not -np.inf < mesh.vertices.min() <= mesh.vertices.max() < np.inf:
        bad = ~np.isfinite(mesh.vertices).all(axis=1)
        raise InputError(
            f"The mesh {name} has {int(bad.sum())} vertices that are NaN or infinite (the first is "
            f"{int(bad.argmax())}): repair it in the program it comes from."
        )
    if not len(mesh.faces):
        raise InputError(f"The mesh {name} has no faces: give a surface, not a cloud of points.")
    if mesh.faces.min() < 0 or mesh.faces.max() >= count:
        wrong = ((mesh.faces < 0) | (mesh.faces >= count)).any(axis=1)
        raise InputError(
            f"Face {int(wrong.argmax())} of the mesh {name} names a vertex outside 0 to {count - 1}: the file is "
            "damaged."
        )
    return mesh


def fan(polygons: list[list[int]]) -> NDArray[np.int64]:
    """Triangles (m, 3) of polygons, each split into a fan from its first corner; fewer than 3 corners give none."""
    triangles = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    return np.array(triangles, np.int64).reshape(-1, 3)


def to_int32(faces: NDArray[np.integer], name: str) -> NDArray[np.int32]:
    """Faces as int32; values beyond its range are an error, never wrapped round."""
    if faces.dtype == np.int32:
        return np.asarray(faces, np.int32)
    if faces.size and (faces.max() > np.iinfo(np.int32).max or faces.min() < np.iinfo(np.int32).min):
        raise InputError(f"The mesh {name} has faces with impossible vertex numbers: the file is damaged.")
    return faces.astype(np.int32)


def y_up_to_z_up(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn vectors (..., 3) from Y up to Z up: (x, y, z) becomes (x, -z, y)."""
    return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)


def z_up_to_y_up(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn vectors (..., 3) from Z up to Y up: (x, y, z) becomes (x, z, -y)."""
    return np.stack([vectors[..., 0], vectors[..., 2], -vectors[..., 1]], axis=-1)
