"""A moving mesh of one connectivity as an array, checked."""

from __future__ import annotations

from fractions import Fraction

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.formats.meshfile import MeshFile, check_mesh
from imitation.errors import InputError


@attrs.frozen(eq=False)
class MeshSequence:
    """A mesh that moves: the same faces in every frame.

    Attributes
    ----------
    vertices : (n, v, 3) positions in each frame, world, Z up.
    faces : (m, 3) vertex indices.
    fps : frames per second; frame k is shown at k / fps seconds.
    colors : (v, 3) uint8 sRGB, or None.
    name : what it is called, for messages and inside files.
    """

    vertices: NDArray[np.floating]
    faces: NDArray[np.int32]
    fps: Fraction
    colors: NDArray[np.uint8] | None = None
    name: str = "character"

    def __len__(self) -> int:
        return len(self.vertices)

    def __getitem__(self, frame: int) -> MeshFile:
        return MeshFile(self.vertices[frame], self.faces, self.colors, "z", self.name)


def mesh_sequence(
    vertices: ArrayLike,
    faces: ArrayLike,
    fps: Fraction | float,
    colors: ArrayLike | None = None,
    name: str = "character",
) -> MeshSequence:
    """A checked sequence of arrays; frames of float32 stay float32.

    Raises
    ------
    InputError
        Wrong shapes, no frames, NaN positions, faces that name no vertex, a rate that is none.
    """
    v, f = np.asarray(vertices), np.asarray(faces)
    if v.dtype not in (np.float32, np.float64):
        v = v.astype(np.float64)
    if v.ndim != 3 or v.shape[2] != 3 or f.ndim != 2 or f.shape[1] != 3 or f.dtype.kind not in "iu":
        raise InputError(f"A sequence needs vertices (n, v, 3) and integer faces (m, 3), but got {v.shape}, {f.shape}.")
    if not len(v):
        raise InputError("A sequence of no frames cannot be used: give at least one.")
    rate = Fraction(fps).limit_denominator(100_000) if np.isfinite(float(fps)) else Fraction(0)
    if not 0 < rate <= 1000:
        raise InputError(f"The frame rate must be above 0 and at most 1000, but got {fps}.")
    bad = ~np.isfinite(v).all(axis=(1, 2))
    if bad.any():
        raise InputError(f"Frame {int(bad.argmax())} of the sequence {name} has vertices that are NaN or infinite.")
    c = None if colors is None else np.asarray(colors)
    if c is not None and (c.shape != v.shape[1:] or c.dtype != np.uint8):
        raise InputError(f"Colours must be uint8 {v.shape[1:]}, but are {c.dtype} {c.shape}.")
    check_mesh(MeshFile(v[0], f, c, "z", name))
    return MeshSequence(v, f.astype(np.int32), rate, c, name)


def vertex_normals(vertices: NDArray[np.floating], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Unit normals (v, 3), weighted by area; (0, 0, 1) where a vertex has no face."""
    corners = np.asarray(vertices, np.float64)[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros((len(vertices), 3))
    for axis in range(3):
        weights = np.repeat(across[:, axis], 3)
        normals[:, axis] = np.bincount(faces.reshape(-1), weights=weights, minlength=len(vertices))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    flat = lengths[:, 0] < 1e-30
    normals[flat] = (0.0, 0.0, 1.0)
    lengths[flat] = 1.0
    unit: NDArray[np.float64] = normals / lengths
    return unit
