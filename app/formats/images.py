"""Pictures: single ones, and folders of them as a clip."""

from __future__ import annotations

import re
import threading
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.atomic import replacing
from app.formats.cache import ByteCache
from app.formats.fingerprint import folder_fingerprint
from app.formats.source import FrameSource, Picture
from imitation.errors import InputError

SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp")


def open_images(folder: str | Path, *, fps: Fraction | float = Fraction(25), memory: int = 64 << 20) -> ImageFrames:
    """Open a folder of pictures, in natural order of their names (2 before 10), as a sequence of RGB frames.

    Parameters
    ----------
    folder : holds PNG, JPEG, BMP, TIFF or WebP files of one size; other files are ignored.
    fps : frames per second to assume.
    memory : budget of decoded frames, bytes.

    Raises
    ------
    InputError
        No such folder, or no pictures in it.
    """
    return ImageFrames(Path(folder), fps=Fraction(fps).limit_denominator(100_000), memory=memory)


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """A sorting key by which numbers inside names count as numbers."""
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", name.lower()) if part]


class ImageFrames(FrameSource):
    """The pictures of a folder as frames of constant rate.

    Attributes
    ----------
    paths : the files in order.
    """

    def __init__(self, folder: Path, *, fps: Fraction, memory: int) -> None:
        if not folder.is_dir():
            what = "is a file, not a folder" if folder.exists() else "does not exist"
            raise InputError(f"The folder of pictures {folder} {what}: choose another one.")
        if fps <= 0:
            raise InputError(f"The frame rate must be above 0, but got {fps}.")
        files = [path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES and not path.name.startswith(".")]
        if not files:
            raise InputError(
                f"The folder {folder} holds no pictures (PNG, JPEG, BMP, TIFF or WebP): choose another one."
            )
        self.paths = sorted(files, key=lambda path: (natural_key(path.name), path.name))
        self.path, self.fps, self.constant_rate, self.rotation = folder, fps, True, 0
        self.times = np.arange(len(self.paths)) / float(fps)
        self.times.setflags(write=False)
        self.fingerprint = folder_fingerprint(self.paths)
        self._lock = threading.Lock()
        self._cache: ByteCache[Picture] = ByteCache(memory)
        height, width = read_image(self.paths[0]).shape[:2]
        self.size = (width, height)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.path, self.fps, self._cache.budget)

    def close(self) -> None:
        """Let go of all decoded frames."""
        with self._lock:
            self._cache.clear()

    def _picture(self, frame: int) -> Picture:
        with self._lock:
            picture = self._cache.get(frame)
            if picture is None:
                picture = read_image(self.paths[frame])
                height, width = picture.shape[:2]
                if (width, height) != self.size:
                    raise InputError(
                        f"The picture {self.paths[frame].name} is {width} x {height} pixels, but the first one is "
                        f"{self.size[0]} x {self.size[1]}: give pictures of one size."
                    )
                picture.setflags(write=False)
                self._cache.put(frame, picture, picture.nbytes)
            return picture


def _again(folder: Path, fps: Fraction, memory: int) -> ImageFrames:
    return ImageFrames(folder, fps=fps, memory=memory)


def read_image(path: str | Path) -> Picture:
    """Read a picture as uint8 RGB (h, w, 3).

    Raises
    ------
    InputError
        The file cannot be read as a picture.
    """
    import cv2

    decoded = cv2.imdecode(read_bytes(Path(path)), cv2.IMREAD_COLOR)
    if decoded is None:
        raise InputError(f"The file {path} is not a picture that can be read: give a PNG or JPEG file.")
    return np.ascontiguousarray(decoded[..., ::-1])


def write_image(path: str | Path, picture: NDArray[np.uint8]) -> None:
    """Write a picture, uint8 grey (h, w), RGB (h, w, 3) or RGBA (h, w, 4), as the suffix says; whole or not at all."""
    import cv2

    path = Path(path)
    order = {2: picture, 3: picture[..., ::-1]}.get(picture.ndim)
    if picture.ndim == 3 and picture.shape[2] == 4:
        order = picture[..., [2, 1, 0, 3]]
    if order is None or picture.dtype != np.uint8:
        raise InputError(
            f"A picture must be uint8 (h, w), (h, w, 3) or (h, w, 4), got {picture.dtype} {picture.shape}."
        )
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"A picture cannot be written as {path.name}: use the suffix .png or .jpg.")
    done, data = cv2.imencode(path.suffix, np.ascontiguousarray(order))
    if not done:
        raise InputError(f"A picture of shape {picture.shape} cannot be written as {path.suffix}.")
    with replacing(path) as temporary:
        temporary.write_bytes(data.tobytes())


def read_bytes(path: Path) -> NDArray[np.uint8]:
    """The content of a file (n,), or an InputError of one sentence."""
    try:
        data = np.fromfile(path, np.uint8)
    except OSError as error:
        raise InputError(f"The file {path} cannot be read: {error.strerror or error}.") from error
    if not data.size:
        raise InputError(f"The file {path} is empty: choose another one.")
    return data
