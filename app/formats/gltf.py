"""The binary glTF container: JSON and one block of bytes, accessors read and written."""

from __future__ import annotations

import base64
import json
import struct
import urllib.parse
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_UNREADABLE = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


@attrs.define
class Gltf:
    """A parsed file.

    Attributes
    ----------
    tree : the JSON part.
    buffers : the bytes of each buffer.
    name : the file's name, for messages.
    """

    tree: dict[str, Any]
    buffers: list[bytes]
    name: str

    def items(self, kind: str) -> list[dict[str, Any]]:
        """The list of that name in the JSON part, empty where there is none."""
        found: list[dict[str, Any]] = self.tree.get(kind, [])
        return found

    def accessor(self, index: int) -> NDArray[Any]:
        """The values (count, width) of an accessor, sparse ones filled in, normalised integers as floats."""
        entry = self.items("accessors")[index]
        kind, width, count = COMPONENTS[entry["componentType"]], WIDTHS[entry["type"]], int(entry["count"])
        if "bufferView" in entry:
            values = self._view(entry["bufferView"], entry.get("byteOffset", 0), kind, width, count)
        else:
            if count > 5_000_000:
                raise ValueError("count")
            values = np.zeros((count, width), kind)
        if "sparse" in entry:
            sparse = entry["sparse"]
            where, what, size = sparse["indices"], sparse["values"], int(sparse["count"])
            index_kind = COMPONENTS[where["componentType"]]
            places = self._view(where["bufferView"], where.get("byteOffset", 0), index_kind, 1, size)[:, 0]
            values = values.copy()
            values[places] = self._view(what["bufferView"], what.get("byteOffset", 0), kind, width, size)
        if entry.get("normalized"):
            scale = np.iinfo(values.dtype).max
            values = np.maximum(values.astype(np.float64) / scale, -1.0)
        return values

    def view(self, view: int) -> bytes:
        """The bytes of a buffer view."""
        entry = self.items("bufferViews")[view]
        start, size = int(entry.get("byteOffset", 0)), int(entry["byteLength"])
        data = self.buffers[entry.get("buffer", 0)]
        if start < 0 or size < 0 or start + size > len(data):
            raise ValueError("view outside its buffer")
        return bytes(data[start : start + size])

    def _view(self, view: int, offset: int, kind: str, width: int, count: int) -> NDArray[Any]:
        entry = self.items("bufferViews")[view]
        data = self.buffers[entry.get("buffer", 0)]
        start, room = entry.get("byteOffset", 0) + offset, entry["byteLength"] - offset
        row = np.dtype(kind).itemsize * width
        stride = entry.get("byteStride") or row
        if count < 0 or offset < 0 or start < 0 or stride < row or (count and (count - 1) * stride + row > room):
            raise ValueError("accessor outside its buffer")
        if count and start + (count - 1) * stride + row > len(data):
            raise ValueError("buffer too short")
        raw = np.ndarray((count, width), "<" + kind, data, start, (stride, np.dtype(kind).itemsize))
        return np.array(raw)


def read_gltf(path: Path, data: bytes) -> Gltf:
    """Parse a GLB, or a glTF with its buffers beside it or inside it.

    Raises
    ------
    InputError
        Not such a file, cut off, or compressed in a way that is not read.
    """
    name = path.name
    try:
        tree, binary = _split(data)
        buffers = [_buffer(path.parent, entry, binary) for entry in tree.get("buffers", [])]
        needed = [str(extension) for extension in tree.get("extensionsRequired", [])]
    except (ValueError, KeyError, TypeError, AttributeError, struct.error, OSError) as error:
        raise InputError(f"The file {name} is not a whole GLB or glTF file: export it again.") from error
    for extension in needed:
        if extension in _UNREADABLE:
            raise InputError(f"The file {name} is compressed by {extension}, which is not read: export it without.")
    return Gltf(tree, buffers, name)


def _split(data: bytes) -> tuple[dict[str, Any], bytes]:
    if data[:4] != b"glTF":
        return dict(json.loads(data)), b""
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2 or length > len(data):
        raise ValueError("length")
    place, chunks = 12, dict[int, bytes]()
    while place + 8 <= length:
        size, kind = struct.unpack_from("<II", data, place)
        if place + 8 + size > length:
            raise ValueError("chunk")
        chunks.setdefault(kind, data[place + 8 : place + 8 + size])
        place += 8 + size
    return dict(json.loads(chunks[0x4E4F534A])), chunks.get(0x004E4942, b"")


def _buffer(folder: Path, entry: dict[str, Any], binary: bytes) -> bytes:
    uri = entry.get("uri")
    if uri is None:
        return binary
    if uri.startswith("data:"):
        return base64.b64decode(uri.split(",", 1)[1])
    beside = (folder / urllib.parse.unquote(uri)).resolve()
    if not beside.is_relative_to(folder.resolve()):
        raise ValueError("buffer outside the folder")
    return beside.read_bytes()


class GltfWriter:
    """Collects accessors, then writes one GLB."""

    def __init__(self) -> None:
        self.tree: dict[str, Any] = {"asset": {"version": "2.0", "generator": "Motionwright"}}
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, Any]] = []
        self._parts: list[bytes] = []
        self._size = 0

    def add(
        self,
        values: NDArray[Any],
        kind: str,
        *,
        target: int | None = None,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Add the values (count, width) of an accessor; rows are filled up to multiples of four bytes."""
        rows = np.ascontiguousarray(values.reshape(len(values), -1))
        code = next(code for code, name in COMPONENTS.items() if np.dtype(name) == rows.dtype)
        size = rows.dtype.itemsize * rows.shape[1]
        spare = -size % 4 if target == 34962 else 0
        data = np.zeros((len(rows), size + spare), np.uint8)
        data[:, :size] = rows.view(np.uint8).reshape(len(rows), size)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": self._size, "byteLength": data.size}
        if target is not None:
            view["target"] = target
        if spare:
            view["byteStride"] = size + spare
        entry: dict[str, Any] = {
            "bufferView": len(self._views), "componentType": code, "count": len(rows), "type": kind,
        }  # fmt: skip
        if normalized:
            entry["normalized"] = True
        if bounds:
            entry["min"], entry["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        self._views.append(view)
        self._accessors.append(entry)
        padded = data.tobytes() + b"\0" * (-data.size % 4)
        self._parts.append(padded)
        self._size += len(padded)
        return len(self._accessors) - 1

    def add_bytes(self, data: bytes) -> int:
        """Add a view of plain bytes, such as a picture, and give its number."""
        self._views.append({"buffer": 0, "byteOffset": self._size, "byteLength": len(data)})
        padded = data + b"\0" * (-len(data) % 4)
        self._parts.append(padded)
        self._size += len(padded)
        return len(self._views) - 1

    def write(self, path: Path) -> None:
        """Write the file."""
        tree = {
            **self.tree, "accessors": self._accessors, "bufferViews": self._views,
            "buffers": [{"byteLength": self._size}],
        }  # fmt: skip
        text = json.dumps(tree, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + self._size
        if total > 0xFFFFFFFF:
            raise InputError("A GLB file cannot be larger than 4 GB: write fewer frames, or PLY files.")
        with path.open("wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, total))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", self._size, b"BIN\0"))
            for part in self._parts:
                file.write(part)


def to_linear(colors: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """Linear 16-bit values, as glTF wants them, of sRGB colours."""
    s = colors / 255.0
    linear = np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)
    values: NDArray[np.uint16] = np.rint(linear * 65535).astype(np.uint16)
    return values


def to_srgb(linear: NDArray[Any]) -> NDArray[np.uint8]:
    """SRGB colours of linear values 0 to 1."""
    x = np.clip(np.nan_to_num(np.asarray(linear, np.float64)), 0.0, 1.0)
    s = np.where(x <= 0.0031308, x * 12.92, 1.055 * x ** (1 / 2.4) - 0.055)
    values: NDArray[np.uint8] = np.rint(s * 255).astype(np.uint8)
    return values
