"""What an OBJ file wears: material colours, and pictures by texture coordinates."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, fan
from app.formats.tvm.frames import Texture
from imitation.errors import InputError

LARGEST_MTL = 1 << 22
Material = tuple[tuple[float, float, float] | None, Path | None]


def obj_dress(data: bytes, path: Path, mesh: MeshFile) -> tuple[NDArray[np.uint8] | None, Texture | None]:
    """Read colours (v, 3) from materials, and the texture, of an OBJ whose geometry has been read already."""
    if b"vt " not in data and b"usemtl" not in data:
        return None, None
    coordinates: list[list[float]] = []
    polygons: list[list[int]] = []
    names: list[str] = []
    library: dict[str, Material] = {}
    present = ""
    for line in data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines():
        words = line.split()
        if not words:
            continue
        kind = words[0]
        if kind == b"vt":
            coordinates.append(_pair(words, path))
        elif kind == b"f":
            corners = [word.split(b"/") for word in words[1:] if not word.startswith(b"#")]
            polygons.append([_texture_index(corner, len(coordinates), path) for corner in corners])
            names.append(present)
        elif kind == b"usemtl" and len(words) > 1:
            present = b" ".join(words[1:]).decode("utf-8", "replace")
        elif kind == b"mtllib" and len(words) > 1:
            library |= _materials(path.parent, b" ".join(words[1:]).decode("utf-8", "replace"))
    repeats = [max(len(polygon) - 2, 0) for polygon in polygons]
    triangle_names = [name for name, count in zip(names, repeats, strict=True) for _ in range(count)]
    texture = _texture(coordinates, fan(polygons), triangle_names, library, path)
    return _colours(mesh, triangle_names, library), texture


def _pair(words: list[bytes], path: Path) -> list[float]:
    try:
        return [float(words[1]), float(words[2]) if len(words) > 2 else 0.0]
    except (ValueError, IndexError) as error:
        raise InputError(f"The OBJ file {path.name} has texture coordinates that are no numbers.") from error


def _texture_index(corner: list[bytes], count: int, path: Path) -> int:
    if len(corner) < 2 or not corner[1]:
        return -1
    try:
        number = int(corner[1])
    except ValueError as error:
        raise InputError(f"The OBJ file {path.name} has a face corner that cannot be understood.") from error
    index = number - 1 if number > 0 else count + number
    if not 0 <= index < 1 << 31:
        raise InputError(f"The OBJ file {path.name} names texture coordinates that are not there.")
    return index


def _materials(folder: Path, name: str) -> dict[str, Material]:
    """Colours and pictures of a material library beside the mesh; one that is not there dresses nothing."""
    file = _beside(folder, name)
    if file is None or file.stat().st_size > LARGEST_MTL:
        return {}
    found: dict[str, Material] = {}
    present = ""
    for line in file.read_bytes().splitlines():
        words = line.decode("utf-8", "replace").split()
        if not words:
            continue
        if words[0] == "newmtl":
            present = " ".join(words[1:])
            found[present] = (None, None)
        elif words[0] == "Kd" and present in found and len(words) >= 4:
            try:
                r, g, b = (float(word) for word in words[1:4])
            except ValueError:
                continue
            found[present] = ((r, g, b), found[present][1])
        elif words[0] == "map_Kd" and present in found and len(words) >= 2:
            # Options come first ("-s 1 1 1"); a name may hold spaces.
            picture = _beside(folder, " ".join(words[1:])) or _beside(folder, words[-1])
            found[present] = (found[present][0], picture)
    return found


def _beside(folder: Path, name: str) -> Path | None:
    """A file inside the folder, wherever a stranger's path may lead."""
    try:
        file = (folder / name.replace("\\", "/")).resolve()
        return file if file.is_relative_to(folder.resolve()) and file.is_file() else None
    except (OSError, ValueError):
        return None


def _texture(
    coordinates: list[list[float]],
    corners: NDArray[np.int64],
    names: list[str],
    library: dict[str, Material],
    path: Path,
) -> Texture | None:
    pictures = [library.get(name, (None, None))[1] for name in names]
    images = tuple(dict.fromkeys(picture for picture in pictures if picture is not None))
    if not images or not coordinates:
        return None
    if len(corners) and corners.max() >= len(coordinates):
        raise InputError(f"The OBJ file {path.name} names texture coordinates that are not there.")
    number = {picture: k for k, picture in enumerate(images)}
    of_face = np.array([-1 if picture is None else number[picture] for picture in pictures], np.int32)
    return Texture(np.array(coordinates, np.float64).reshape(-1, 2), corners.astype(np.int32), images, of_face)


def _colours(mesh: MeshFile, names: list[str], library: dict[str, Material]) -> NDArray[np.uint8] | None:
    """Each vertex in the colour of the last face that names it, white where no material says; none beside pictures."""
    if any(library.get(name, (None, None))[1] is not None for name in set(names)):
        return None
    stated = {name: colour for name, (colour, picture) in library.items() if colour is not None and picture is None}
    if not stated or len(names) != len(mesh.faces) or not set(names) & set(stated):
        return None
    table = {name: np.clip(np.rint(np.array(colour) * 255), 0, 255) for name, colour in stated.items()}
    white = np.full(3, 255.0)
    of_face = np.array([table.get(name, white) for name in names], np.uint8)
    colours = np.full((len(mesh.vertices), 3), 255, np.uint8)
    colours[mesh.faces.reshape(-1)] = np.repeat(of_face, 3, axis=0)
    return colours
