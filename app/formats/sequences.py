"""Moving meshes from and to the outside: folders of PLY or OBJ, animated GLB, USD, npz."""

from __future__ import annotations

import io
import re
import tokenize
import zipfile
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from app.formats.animated_glb import Interpolation, read_animated_glb, write_animated_glb
from app.formats.atomic import replacing, replacing_numbered
from app.formats.images import natural_key, read_bytes
from app.formats.meshes import read_mesh
from app.formats.obj import write_obj
from app.formats.ply import write_ply
from app.formats.sequence import MeshSequence, mesh_sequence, vertex_normals
from app.formats.usd import USD_SUFFIXES, read_usd, write_usd
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

Form = Literal["ply", "obj", "glb", "usd", "npz"]
NPZ_DAMAGE = (
    OSError, EOFError, ValueError, KeyError, IndexError, TypeError, AttributeError, ArithmeticError, MemoryError,
    SyntaxError, SystemError, RecursionError, NotImplementedError, RuntimeError, tokenize.TokenError,
    zipfile.BadZipFile, zipfile.LargeZipFile,
)  # fmt: skip
"""What reading a damaged archive comes to."""
DECOMPRESSORS = ("zlib", "_lzma", "lzma", "_bz2", "bz2")
FORMS: tuple[Form, ...] = ("ply", "obj", "glb", "usd", "npz")


def write_sequence(
    path: str | Path,
    vertices: ArrayLike,
    faces: ArrayLike,
    fps: Fraction | float,
    *,
    form: Form | None = None,
    colors: ArrayLike | None = None,
    normals: bool = True,
    interpolation: Interpolation = "linear",
    quantize: bool = False,
    name: str = "character",
    progress: Progress | None = None,
) -> None:
    """Write a moving mesh; whole or not at all.

    Parameters
    ----------
    path : a folder for "ply" and "obj" (files ``name_0000.ply`` ...), else a file.
    vertices : (n, v, 3) positions in each frame, Z up.
    faces : (m, 3) vertex indices.
    fps : frames per second.
    form : taken from the suffix where it is not given: .glb, .usd/.usda/.usdc, .npz.
    colors : (v, 3) uint8 sRGB.
    normals : write normals (OBJ, PLY, GLB).
    interpolation, quantize : see write_animated_glb.
    name : of the mesh inside the file, and of the files in a folder.

    Raises
    ------
    InputError
        Arrays that are no sequence, an unknown suffix, usd-core missing, the disk is full.
    """
    path = Path(path)
    sequence = mesh_sequence(vertices, faces, fps, colors, name)
    chosen = form or _form(path)
    (progress or silent)(0.0)
    if chosen in ("ply", "obj"):
        _write_folder(path, sequence, "ply" if chosen == "ply" else "obj", normals, progress)
        return
    if chosen == "usd" and path.suffix.lower() not in USD_SUFFIXES:
        raise InputError(f"A USD stage cannot be written as {path.name}: use .usd, .usda or .usdc.")
    with replacing(path) as temporary:
        if chosen == "glb":
            write_animated_glb(
                temporary, sequence, progress, interpolation=interpolation, quantize=quantize, normals=normals
            )
        elif chosen == "usd":
            write_usd(temporary, sequence, progress)
        else:
            _write_npz(temporary, sequence)
    part(progress, 0, 1)(1.0)


def read_sequence(path: str | Path, *, fps: Fraction | float | None = None) -> MeshSequence:
    """Read a moving mesh of one connectivity: a folder of PLY or OBJ files, an animated GLB, USD, npz.

    Parameters
    ----------
    fps : frames per second, where the files do not state them (folders: 25 where not given).

    Raises
    ------
    InputError
        No such file, no sequence in it, frames of different connectivity.
    """
    path = Path(path)
    if path.is_dir():
        return _read_folder(path, 25 if fps is None else fps)
    if not path.is_file():
        raise InputError(f"The sequence {path} does not exist: choose a file or a folder.")
    suffix = path.suffix.lower()
    if suffix in (".glb", ".gltf"):
        return read_animated_glb(path, read_bytes(path).tobytes())
    if suffix in USD_SUFFIXES:
        return read_usd(path)
    if suffix == ".npz":
        return _read_npz(path)
    raise InputError(f"The file {path.name} is no sequence that can be read: give a folder, GLB, USD or npz.")


def _form(path: Path) -> Form:
    suffix = path.suffix.lower()
    if suffix in USD_SUFFIXES:
        return "usd"
    for form in FORMS:
        if suffix == "." + form and form not in ("ply", "obj"):
            return form
    raise InputError(f"What to write to {path.name} is not clear: use .glb, .usd or .npz, or name the form ply or obj.")


def _write_folder(
    folder: Path, sequence: MeshSequence, form: Literal["ply", "obj"], normals: bool, progress: Progress | None
) -> None:
    report = progress or silent
    stem = re.sub(r"[^\w-]+", "_", sequence.name) or "character"
    digits = max(4, len(str(len(sequence) - 1)))
    with replacing_numbered(folder, stem, "." + form) as temporary:
        for frame, vertices in enumerate(sequence.vertices):
            target = temporary / f"{stem}_{frame:0{digits}d}.{form}"
            v = vertices.astype(np.float64)
            n = vertex_normals(v, sequence.faces) if normals else None
            if form == "ply":
                write_ply(target, v, sequence.faces, sequence.colors, n)
            else:
                write_obj(target, v, sequence.faces, sequence.colors, n)
            report((frame + 1) / len(sequence))


def _read_folder(folder: Path, fps: Fraction | float) -> MeshSequence:
    for suffix in (".ply", ".obj"):
        paths = [each for each in folder.iterdir() if each.suffix.lower() == suffix and not each.name.startswith(".")]
        if paths:
            break
    else:
        raise InputError(f"The folder {folder} holds no PLY or OBJ files: choose another one.")
    paths.sort(key=lambda each: natural_key(each.name))
    first = read_mesh(paths[0])
    frames = np.empty((len(paths), *first.vertices.shape), np.float64)
    for frame, each in enumerate(paths):
        mesh = first if frame == 0 else read_mesh(each)
        if mesh.vertices.shape != first.vertices.shape or not np.array_equal(mesh.faces, first.faces):
            raise InputError(
                f"The mesh {each.name} has other faces than {paths[0].name}: a moving mesh needs one connectivity."
            )
        frames[frame] = mesh.vertices
    name = re.sub(r"_?\d+$", "", paths[0].stem) or "character"
    return mesh_sequence(frames, first.faces, fps, first.colors, name)


def _write_npz(path: Path, sequence: MeshSequence) -> None:
    arrays = {
        "vertices": sequence.vertices,
        "faces": sequence.faces,
        "fps": np.array([sequence.fps.numerator, sequence.fps.denominator], np.int64),
        "name": np.array(sequence.name),
    }
    if sequence.colors is not None:
        arrays["colors"] = sequence.colors
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for key, array in arrays.items():
            memory = io.BytesIO()
            np.lib.format.write_array(memory, np.asarray(array, order="C"), allow_pickle=False)
            # A fixed date, so that the same arrays give the same bytes.
            archive.writestr(
                zipfile.ZipInfo(f"{key}.npy", (1980, 1, 1, 0, 0, 0)), memory.getvalue(), zipfile.ZIP_DEFLATED
            )


def _read_npz(path: Path) -> MeshSequence:
    def load(read: Callable[[str], np.ndarray], names: set[str]) -> MeshSequence:
        def numbers(name: str) -> np.ndarray:
            if (array := read(name)).dtype.kind not in "fiu":
                raise ValueError(name)
            return array

        if "vertices" in names:
            vertices = numbers("vertices")
        else:  # positions in a box: vertex = center + scale * position
            vertices = numbers("center") + numbers("scale") * numbers("positions").astype(np.float64)
        rate = numbers("fps").reshape(-1)
        fps = (
            Fraction(int(rate[0]), int(rate[1])) if len(rate) == 2 else Fraction(float(rate[0])).limit_denominator(1001)
        )
        colors = read("colors") if "colors" in names else None
        if colors is not None:
            colors = colors[0] if colors.ndim == 3 else colors
        name = str(read("name")) if "name" in names else path.stem
        return mesh_sequence(vertices, read("faces"), fps, colors, name)

    try:
        with np.load(path, allow_pickle=False) as archive:
            return load(archive.__getitem__, set(archive.files))
    except InputError:
        raise
    except Exception as error:
        # Damage ends in the exceptions of the zip, its decompressors, a header that is a line of Python, a promise of
        # more memory than there is, or arrays of another kind; what is none of these is ours and goes on.
        if not isinstance(error, NPZ_DAMAGE) and type(error).__module__ not in DECOMPRESSORS:
            raise
        raise InputError(f"The file {path.name} is not an npz of vertices, faces and fps: export it again.") from error
