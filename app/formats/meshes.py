"""Meshes from and to files of five formats, chosen by the suffix."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from app.formats.atomic import replacing
from app.formats.glb import read_glb, write_glb
from app.formats.meshfile import MeshFile, Up, check_mesh, mesh_bytes
from app.formats.obj import read_obj, write_obj
from app.formats.off import read_off, write_off
from app.formats.ply import read_ply, write_ply
from app.formats.stl import read_stl, write_stl
from imitation.errors import InputError

_READERS: dict[str, Callable[[Path, bytes], MeshFile]] = {
    ".ply": lambda path, data: read_ply(data, path.name),
    ".obj": lambda path, data: read_obj(data, path.name),
    ".off": lambda path, data: read_off(data, path.name),
    ".stl": lambda path, data: read_stl(data, path.name),
    ".glb": read_glb,
    ".gltf": read_glb,
}
MESH_SUFFIXES = tuple(_READERS)


def read_mesh(path: str | Path) -> MeshFile:
    """Read a triangle mesh; vertices stay in the file's order and number, used by a face or not.

    PLY, OBJ, OFF and STL state no axis that points up and are taken as they are; GLB is turned from Y up to Z up. STL
    has no vertices of its own: corners of equal position become one.

    Raises
    ------
    InputError
        No such file, not such a mesh, cut off or damaged, NaN vertices, no faces, faces that name vertices that are
        not there.
    """
    path = Path(path)
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"The file {path.name} is no mesh that can be read: give PLY, OBJ, OFF, STL or GLB.")
    if not path.is_file():
        raise InputError(f"The mesh {path} does not exist: choose another file.")
    return check_mesh(reader(path, mesh_bytes(path)))


def write_mesh(
    path: str | Path,
    vertices: ArrayLike,
    faces: ArrayLike,
    colors: ArrayLike | None = None,
    *,
    normals: ArrayLike | None = None,
    exact: bool = False,
) -> None:
    """Write a triangle mesh in the format of the suffix; whole or not at all.

    Parameters
    ----------
    vertices : (n, 3) positions, Z up (turned to Y up in GLB), written in single precision.
    faces : (m, 3) vertex indices.
    colors : (n, 3) uint8 sRGB; not kept by STL.
    normals : (n, 3) unit normals, for PLY, OBJ and GLB.
    exact : double precision (PLY only).
    """
    path = Path(path)
    mesh = checked(vertices, faces, colors, path.name)
    n = None if normals is None else np.asarray(normals, np.float64)
    v, f, c = mesh.vertices, mesh.faces, mesh.colors
    suffix = path.suffix.lower()
    if suffix not in (".ply", ".obj", ".off", ".stl", ".glb"):
        raise InputError(f"A mesh cannot be written as {path.name}: use .ply, .obj, .off, .stl or .glb.")
    with replacing(path) as temporary:
        if suffix == ".ply":
            write_ply(temporary, v, f, c, n, exact=exact)
        elif suffix == ".obj":
            write_obj(temporary, v, f, c, n)
        elif suffix == ".off":
            write_off(temporary, v, f, c)
        elif suffix == ".stl":
            write_stl(temporary, v, f)
        else:
            write_glb(temporary, v, f, c, n)


def checked(
    vertices: ArrayLike, faces: ArrayLike, colors: ArrayLike | None = None, name: str = "", up: Up | None = None
) -> MeshFile:
    """A mesh of arrays, checked for shapes and numbers that can be used."""
    v, f = np.asarray(vertices, np.float64), np.asarray(faces)
    if v.ndim != 2 or v.shape[1] != 3 or f.ndim != 2 or f.shape[1] != 3 or f.dtype.kind not in "iu":
        raise InputError(f"A mesh needs vertices (n, 3) and integer faces (m, 3), but got {v.shape} and {f.shape}.")
    c = None if colors is None else np.asarray(colors)
    if c is not None and (c.shape != v.shape or c.dtype != np.uint8):
        raise InputError(f"Colours must be uint8 {v.shape}, but are {c.dtype} {c.shape}.")
    return check_mesh(MeshFile(v, f, c, up, name))
