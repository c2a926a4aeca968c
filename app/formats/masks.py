"""Masks: which pixels belong to the subject, as PNG files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.formats.images import natural_key, read_bytes, write_image
from imitation.errors import InputError


def read_mask(path: str | Path, size: tuple[int, int] | None = None) -> NDArray[np.bool_]:
    """Read a mask (h, w): True where the picture is brighter than half, or where a palette or label picture is not 0.

    Parameters
    ----------
    size : (width, height) that it must have, pixels.

    Raises
    ------
    InputError
        Not a picture, or of another size.
    """
    import cv2

    path = Path(path)
    picture = cv2.imdecode(read_bytes(path), cv2.IMREAD_UNCHANGED)
    if picture is None:
        raise InputError(f"The file {path} is not a picture that can be read: give a mask as PNG.")
    if size is not None and picture.shape[1::-1] != size:
        raise InputError(
            f"The mask {path.name} is {picture.shape[1]} x {picture.shape[0]} pixels, but the clip is {size[0]} x "
            f"{size[1]}: give masks of the clip's size."
        )
    if picture.ndim == 3 and picture.shape[2] == 4 and picture[..., 3].min() < picture[..., 3].max():
        picture = picture[..., 3]
    elif picture.ndim == 3:
        picture = picture[..., :3].max(axis=2)
    top = int(picture.max(initial=0))
    # Labels are small numbers; brightness reaches the top of its range.
    whole = 65535 if picture.dtype == np.uint16 else 255
    mask: NDArray[np.bool_] = picture > 0 if top < whole // 2 else picture > whole // 2
    return mask


def write_mask(path: str | Path, mask: ArrayLike) -> None:
    """Write a mask (h, w) as a PNG, 255 where True; whole or not at all."""
    array = np.asarray(mask)
    if array.ndim != 2 or not array.size:
        raise InputError(f"A mask must be (h, w), but is {array.shape}.")
    if Path(path).suffix.lower() != ".png":
        raise InputError(f"A mask cannot be written as {Path(path).name}: use the suffix .png.")
    write_image(path, (array != 0).astype(np.uint8) * np.uint8(255))


def read_masks(folder: str | Path, frames: int, size: tuple[int, int]) -> dict[int, NDArray[np.bool_]]:
    """Read a folder of masks: a number that ends a name is the frame (0-based), else the order is.

    Parameters
    ----------
    frames : how many frames the clip has.
    size : (width, height) of the clip, pixels.

    Returns
    -------
    Frame to mask (h, w); frames may be missing.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"The folder of masks {folder} does not exist: choose another one.")
    paths = [path for path in folder.iterdir() if path.suffix.lower() == ".png" and not path.name.startswith(".")]
    if not paths:
        raise InputError(f"The folder {folder} holds no PNG masks: choose another one.")
    paths.sort(key=lambda path: natural_key(path.name))
    numbers = [_ending(path.stem) for path in paths]
    if None in numbers or len(set(numbers)) < len(numbers):
        numbers = list(range(len(paths)))
    masks: dict[int, NDArray[np.bool_]] = {}
    for path, frame in zip(paths, numbers, strict=True):
        assert frame is not None
        if frame >= frames:
            raise InputError(f"The mask {path.name} is for frame {frame}, but the clip's last frame is {frames - 1}.")
        masks[frame] = read_mask(path, size)
    return masks


def _ending(stem: str) -> int | None:
    digits = stem[len(stem.rstrip("0123456789")) :]
    return int(digits) if digits else None
