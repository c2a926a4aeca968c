"""Sequences in one .npz: arrays of all frames, memory-mapped, so that a frame costs the memory of a frame."""

from __future__ import annotations

import shutil
import tempfile
import tokenize
import zipfile
from fractions import Fraction
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, check_mesh, to_int32
from app.formats.tvm.frames import FrameMesh, MeshFrames
from imitation.errors import InputError

SMALL = 1 << 16
DAMAGE = (
    OSError, ValueError, KeyError, IndexError, TypeError, AttributeError, ZeroDivisionError, OverflowError, SystemError,
)  # fmt: skip
"""What reading a damaged archive comes to; SystemError is text of characters that there are not."""
LARGEST = 1 << 38
"""Bytes that one array may have when it is unpacked."""


class PackedFrames(MeshFrames):
    """Arrays of an .npz; three forms are understood.

    - ``vertices`` (n, v, 3) or ``positions`` (n, v, 3), ``faces`` (m, 3): one connectivity;
    - the same as (all, 3) with ``vertex_offsets`` (n + 1,), ``faces`` (all, 3), local to the frame, with
      ``face_offsets`` (n + 1,): faces of their own;
    - positions in a box: vertex = ``center`` + ``scale`` * position.

    ``fps`` (1,) or (2,) as a fraction, ``colors`` uint8, ``up`` and ``unit`` may be there.
    """

    def __init__(self, path: Path) -> None:
        self.name, self.form = path.name, "npz"
        self._room = tempfile.TemporaryDirectory(prefix="motionwright-")
        try:
            self._arrays = _unpacked(path, Path(self._room.name))
            self._understand()
        except InputError:
            self._room.cleanup()
            raise
        except DAMAGE as error:
            self._room.cleanup()
            raise InputError(
                f"The file {path.name} is not an npz of vertices (or positions) and faces: export it again."
            ) from error

    def __len__(self) -> int:
        return self._count

    def close(self) -> None:
        """Let go of the unpacked arrays."""
        self._arrays.clear()
        self._room.cleanup()

    def _understand(self) -> None:
        arrays = self._arrays
        self._places = arrays["vertices"] if "vertices" in arrays else arrays["positions"]
        self._faces = arrays["faces"]
        self._starts = self._offsets("vertex_offsets", len(self._places))
        self._face_starts = self._offsets("face_offsets", len(self._faces))
        if self._places.dtype.kind != "f" or self._places.shape[-1:] != (3,) or self._faces.dtype.kind not in "iu":
            raise ValueError("shape")
        if self._faces.ndim != 2 or self._faces.shape[1] != 3:
            raise ValueError("faces")
        self.moving = self._starts is None
        if self._starts is None:
            if self._places.ndim != 3 or self._face_starts is not None:
                raise ValueError("frames")
            self._count = len(self._places)
        else:
            if self._places.ndim != 2:
                raise ValueError("frames")
            self._count = len(self._starts) - 1
            if self._face_starts is not None and len(self._face_starts) != len(self._starts):
                raise ValueError("offsets")
        if self._count < 2:
            raise InputError(f"The file {self.name} holds {self._count} frames: a sequence needs at least two.")
        self._centre = _row(arrays.get("center"), 3, 0.0)
        self._scale = _row(arrays.get("scale"), 3, 1.0)
        self._colours = arrays.get("colors", arrays.get("colours"))
        if self._colours is not None and (self._colours.dtype != np.uint8 or self._colours.shape[-1:] != (3,)):
            raise ValueError("colours")
        if "fps" in arrays:
            rate = arrays["fps"].reshape(-1)
            self.fps = (
                Fraction(int(rate[0]), int(rate[1]))
                if len(rate) == 2
                else Fraction(float(rate[0])).limit_denominator(1001)
            )
            if not 0 < self.fps <= 1000:
                raise ValueError("fps")
        stated = str(arrays["up"].reshape(-1)[0]) if "up" in arrays else None
        # What Motionwright writes of a character names it, and is Z up and metres.
        own = "name" in arrays and stated is None
        self.up = "y" if stated == "y" else "z" if stated == "z" or own else None
        self.unit = float(arrays["unit"].reshape(-1)[0]) if "unit" in arrays else 1.0 if own else None

    def _offsets(self, name: str, total: int) -> NDArray[np.int64] | None:
        if name not in self._arrays:
            return None
        stated = np.asarray(self._arrays[name])
        if stated.ndim != 1 or len(stated) < 2 or stated.dtype.kind not in "iu":
            raise ValueError(name)
        offsets = stated.astype(np.int64)
        if offsets[0] != 0 or (np.diff(offsets) < 0).any() or offsets[-1] != total:
            raise ValueError(name)
        return offsets

    def _frame(self, frame: int) -> FrameMesh:
        if self._starts is None:
            part, rows = slice(None), self._places[frame]
        else:
            part = slice(int(self._starts[frame]), int(self._starts[frame + 1]))
            rows = self._places[part]
        faces = self._faces
        if self._face_starts is not None:
            faces = faces[int(self._face_starts[frame]) : int(self._face_starts[frame + 1])]
        vertices = self._centre + self._scale * np.asarray(rows, np.float64)
        where = f"in frame {frame} of {self.name}"
        mesh = check_mesh(MeshFile(vertices, to_int32(np.asarray(faces), where), None, None, where))
        return FrameMesh(mesh.vertices, mesh.faces, self._painted(frame, part, len(vertices)))

    def _painted(self, frame: int, part: slice, count: int) -> NDArray[np.uint8] | None:
        if self._colours is None:
            return None
        rows = self._colours[frame] if self._colours.ndim == 3 else self._colours
        rows = np.array(rows[part] if self._starts is not None else rows)
        return rows if len(rows) == count else None


def _row(given: Any, width: int, usual: float) -> NDArray[np.float64]:
    if given is None:
        return np.full(width, usual)
    values = np.asarray(given, np.float64).reshape(-1)
    if len(values) not in (1, width) or not np.isfinite(values).all():
        raise ValueError("box")
    return np.broadcast_to(values, (width,)).copy()


def _unpacked(path: Path, room: Path) -> dict[str, Any]:
    """All arrays of the archive: small ones in memory, large ones unpacked to the disk and mapped."""
    arrays: dict[str, Any] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            for number, entry in enumerate(archive.infolist()[:64]):
                if not entry.filename.endswith(".npy"):
                    continue
                with archive.open(entry) as stream:
                    arrays[entry.filename[:-4]] = _array(stream, entry, room / f"{number}.raw")
    except (zipfile.BadZipFile, zipfile.LargeZipFile, EOFError, NotImplementedError, RuntimeError) as error:
        raise ValueError("archive") from error
    except Exception as error:
        # Damaged compressed data raise each module's own class (zlib.error, LZMAError).
        if type(error).__module__ in ("zlib", "_lzma", "lzma", "_bz2", "bz2"):
            raise ValueError("archive") from error
        raise
    return arrays


def _array(stream: IO[bytes], entry: zipfile.ZipInfo, target: Path) -> NDArray[Any]:
    version = np.lib.format.read_magic(stream)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    try:
        shape, fortran, dtype = read(stream)
    except (SyntaxError, tokenize.TokenError, RecursionError, MemoryError) as error:
        # The header is a line of Python, which numpy reads with a tokenizer.
        raise ValueError("header") from error
    if dtype.hasobject or (fortran and len(shape) > 1) or any(length < 0 for length in shape):
        raise ValueError("kind of array")
    size = dtype.itemsize
    for length in shape:
        size *= int(length)
    # The header's shape against what the archive holds, before memory or disk is asked for.
    if size > entry.file_size or size > LARGEST:
        raise ValueError("shape promises more than there is")
    if size <= SMALL:
        data = stream.read(size)
        if len(data) < size:
            raise ValueError("cut off")
        return np.frombuffer(data, dtype).reshape(shape)
    if size > shutil.disk_usage(target.parent).free:
        raise InputError(f"Unpacking a sequence of {size >> 20} MB needs more room than {target.parent} has.")
    with target.open("wb") as file:
        shutil.copyfileobj(stream, file, 1 << 20)
        written = file.tell()
    if written < size:
        raise ValueError("cut off")
    return np.memmap(target, dtype, "r", shape=shape)
