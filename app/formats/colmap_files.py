"""The files of a COLMAP model, text and binary, as plain values."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.atomic import replacing
from imitation.errors import InputError

CAMERA_MODELS: dict[str, tuple[str, ...]] = {
    "SIMPLE_PINHOLE": ("f", "cx", "cy"),
    "PINHOLE": ("fx", "fy", "cx", "cy"),
    "SIMPLE_RADIAL": ("f", "cx", "cy", "k1"),
    "RADIAL": ("f", "cx", "cy", "k1", "k2"),
    "OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"),
    "FULL_OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
}
NUMBERS = {0: "SIMPLE_PINHOLE", 1: "PINHOLE", 2: "SIMPLE_RADIAL", 3: "RADIAL", 4: "OPENCV", 6: "FULL_OPENCV"}
NO_POINT = 2**64 - 1


@attrs.frozen
class Lens:
    """A camera's model and parameters, pixel centres at halves."""

    model: str
    width: int
    height: int
    parameters: tuple[float, ...]


@attrs.frozen(eq=False)
class Image:
    """A registered image: world to camera, and which point is seen where (-1: none)."""

    identity: int
    quaternion: tuple[float, ...]
    translation: tuple[float, ...]
    camera: int
    name: str
    pixels: NDArray[np.float64]
    points: NDArray[np.int64]


@attrs.frozen
class Point:
    """A point, its colour and mean error, and its track of (image, index of the pixel there)."""

    identity: int
    position: tuple[float, ...]
    color: tuple[int, ...]
    error: float
    track: tuple[tuple[int, int], ...]


Model = tuple[dict[int, Lens], list[Image], list[Point]]


def read_model(folder: Path) -> Model:
    """Read a model's three files, binary where there are both forms; points3D may be missing."""
    binary = (folder / "images.bin").is_file()
    suffix = ".bin" if binary else ".txt"
    try:
        data = {name: (folder / (name + suffix)).read_bytes() for name in ("cameras", "images")}
        points = folder / ("points3D" + suffix)
        data["points3D"] = points.read_bytes() if points.is_file() else b""
    except OSError as error:
        raise InputError(
            f"The COLMAP model in {folder} cannot be read: {error.strerror} ({error.filename})."
        ) from error
    try:
        return _read_binary(data) if binary else _read_text(data)
    except (ValueError, IndexError, KeyError, struct.error, UnicodeDecodeError) as error:
        raise InputError(f"The COLMAP model in {folder} is cut off or damaged: write it again.") from error


def _lines(data: bytes, keep_empty: bool = False) -> Iterator[list[str]]:
    for line in data.decode("utf-8").splitlines():
        if not line.startswith("#") and (keep_empty or line.strip()):
            yield line.split()


def _read_text(data: Mapping[str, bytes]) -> Model:
    lenses = {
        int(row[0]): Lens(row[1], int(row[2]), int(row[3]), tuple(map(float, row[4:])))
        for row in _lines(data["cameras"])
    }
    images, rows = [], list(_lines(data["images"], keep_empty=True))
    place = 0
    while place < len(rows):
        row = rows[place]
        if not row:
            place += 1
            continue
        seen = np.array(rows[place + 1] if place + 1 < len(rows) else [], np.float64).reshape(-1, 3)
        pose = tuple(map(float, row[1:8]))
        if len(pose) != 7:
            raise ValueError("image")
        images.append(
            Image(
                int(row[0]),
                pose[:4],
                pose[4:],
                int(row[8]),
                " ".join(row[9:]),
                seen[:, :2],
                seen[:, 2].astype(np.int64),
            )
        )
        place += 2
    points = []
    for row in _lines(data["points3D"]):
        track = tuple((int(a), int(b)) for a, b in zip(row[8::2], row[9::2], strict=True))
        points.append(Point(int(row[0]), tuple(map(float, row[1:4])), tuple(map(int, row[4:7])), float(row[7]), track))
    return lenses, images, points


class _Bytes:
    """Takes values from the front of a file."""

    def __init__(self, data: bytes) -> None:
        self.data, self.place = data, 0

    def take(self, form: str) -> tuple[Any, ...]:
        """Values of a little-endian struct format."""
        values = struct.unpack_from("<" + form, self.data, self.place)
        self.place += struct.calcsize("<" + form)
        return values

    def array(self, kind: Any, count: int) -> NDArray[Any]:
        """``count`` records of a numpy type."""
        values = np.frombuffer(self.data, kind, count, self.place)
        self.place += values.nbytes
        return values

    def text(self) -> str:
        """Characters up to the zero byte."""
        end = self.data.index(b"\0", self.place)
        value = self.data[self.place : end].decode("utf-8")
        self.place = end + 1
        return value


_SEEN = np.dtype([("x", "<f8"), ("y", "<f8"), ("point", "<u8")])
_TRACK = np.dtype([("image", "<u4"), ("place", "<u4")])


def _read_binary(data: Mapping[str, bytes]) -> Model:
    source = _Bytes(data["cameras"])
    lenses = {}
    for _ in range(source.take("Q")[0]):
        identity, model, width, height = source.take("iiQQ")
        name = NUMBERS.get(model, f"number {model}")
        if name not in CAMERA_MODELS:  # its length is unknown, so nothing after it can be read
            lenses[identity] = Lens(name, width, height, ())
            break
        lenses[identity] = Lens(name, width, height, source.take(f"{len(CAMERA_MODELS[name])}d"))
    source, images = _Bytes(data["images"]), []
    for _ in range(source.take("Q")[0]):
        identity, *pose, camera = source.take("I7dI")
        name = source.text()
        seen = source.array(_SEEN, source.take("Q")[0])
        pixels = np.stack([seen["x"], seen["y"]], axis=1)
        images.append(
            Image(identity, tuple(pose[:4]), tuple(pose[4:]), camera, name, pixels, seen["point"].astype(np.int64))
        )
    points: list[Point] = []
    if data["points3D"]:
        source = _Bytes(data["points3D"])
        for _ in range(source.take("Q")[0]):
            identity, x, y, z, red, green, blue, error, length = source.take("Q3d3BdQ")
            track = source.array(_TRACK, length)
            pairs = tuple((int(a), int(b)) for a, b in zip(track["image"], track["place"], strict=True))
            points.append(Point(identity, (x, y, z), (red, green, blue), error, pairs))
    return lenses, images, points


def write_model(
    folder: Path, lenses: Mapping[int, Lens], images: Sequence[Image], points: Sequence[Point], *, binary: bool
) -> None:
    """Write the three files; an older model in the other form is removed, as COLMAP would read that first."""
    made = _binary(lenses, images, points) if binary else _text(lenses, images, points)
    suffix, other = (".bin", ".txt") if binary else (".txt", ".bin")
    for name, data in made.items():
        with replacing(folder / (name + suffix)) as target:
            target.write_bytes(data)
    for name in ("cameras", "images", "points3D", "rigs", "frames"):
        (folder / (name + other)).unlink(missing_ok=True)
        if name in ("rigs", "frames"):
            (folder / (name + suffix)).unlink(missing_ok=True)


def _text(lenses: Mapping[int, Lens], images: Sequence[Image], points: Sequence[Point]) -> dict[str, bytes]:
    def numbers(values: Any) -> str:
        return " ".join(map(repr, map(float, values)))

    cameras = ["# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"]
    cameras += [f"{i} {x.model} {x.width} {x.height} {numbers(x.parameters)}" for i, x in lenses.items()]
    lines = ["# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME", "# POINTS2D[] as (X, Y, POINT3D_ID)"]
    for image in images:
        pose = numbers((*image.quaternion, *image.translation))
        lines.append(f"{image.identity} {pose} {image.camera} {image.name}")
        lines.append(
            " ".join(f"{x!r} {y!r} {p}" for (x, y), p in zip(image.pixels.tolist(), image.points, strict=True))
        )
    rows = ["# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)"]
    for point in points:
        track = " ".join(f"{a} {b}" for a, b in point.track)
        color = " ".join(map(str, point.color))
        rows.append(f"{point.identity} {numbers(point.position)} {color} {point.error!r} {track}".rstrip())
    files = {"cameras": cameras, "images": lines, "points3D": rows}
    return {name: ("\n".join(text) + "\n").encode() for name, text in files.items()}


def _binary(lenses: Mapping[int, Lens], images: Sequence[Image], points: Sequence[Point]) -> dict[str, bytes]:
    codes = {name: number for number, name in NUMBERS.items()}
    cameras = [struct.pack("<Q", len(lenses))]
    for identity, lens in lenses.items():
        cameras.append(struct.pack("<iiQQ", identity, codes[lens.model], lens.width, lens.height))
        cameras.append(struct.pack(f"<{len(lens.parameters)}d", *lens.parameters))
    shots = [struct.pack("<Q", len(images))]
    for image in images:
        shots.append(struct.pack("<I7dI", image.identity, *image.quaternion, *image.translation, image.camera))
        seen = np.zeros(len(image.pixels), _SEEN)
        seen["x"], seen["y"] = image.pixels.T
        seen["point"] = image.points.astype(np.uint64)
        shots.append(image.name.encode() + b"\0" + struct.pack("<Q", len(seen)) + seen.tobytes())
    cloud = [struct.pack("<Q", len(points))]
    for point in points:
        cloud.append(
            struct.pack("<Q3d3BdQ", point.identity, *point.position, *point.color, point.error, len(point.track))
        )
        cloud.append(np.array(point.track, np.uint32).reshape(-1, 2).astype("<u4").tobytes())
    return {"cameras": b"".join(cameras), "images": b"".join(shots), "points3D": b"".join(cloud)}
