"""Pictures side by side, with labels."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError

Picture = NDArray[np.uint8]
_PAPER = (24, 26, 30)


def side_by_side(
    pictures: Sequence[Picture], labels: Sequence[str] = (), *, gap: int = 6, columns: int | None = None
) -> Picture:
    """Put pictures beside each other at the height of the first, each under its label.

    Parameters
    ----------
    pictures : uint8 RGB, of any sizes.
    labels : a word or two for each; none for no labels.
    gap : pixels between pictures.
    columns : pictures in a row; all where not given.
    """
    import cv2

    if not pictures or (labels and len(labels) != len(pictures)):
        raise InputError(f"There are {len(pictures)} pictures and {len(labels)} labels: give a label for each picture.")
    height = pictures[0].shape[0]
    tiles: list[Picture] = []
    for number, picture in enumerate(pictures):
        tile = np.ascontiguousarray(picture)
        if tile.shape[0] != height:
            width = max(1, round(tile.shape[1] * height / tile.shape[0]))
            method = cv2.INTER_AREA if tile.shape[0] > height else cv2.INTER_CUBIC
            tile = np.asarray(cv2.resize(tile, (width, height), interpolation=method), np.uint8)
        tiles.append(label(tile, labels[number]) if labels else tile)
    per_row = columns or len(tiles)
    rows = [_joined(tiles[first : first + per_row], gap, 1) for first in range(0, len(tiles), per_row)]
    return _joined(rows, gap, 0)


def side_by_side_frames(
    sources: Sequence[Iterable[Picture]], labels: Sequence[str] = (), *, gap: int = 6, columns: int | None = None
) -> Iterator[Picture]:
    """The same for several films that run together; ends with the shortest."""
    for pictures in zip(*sources, strict=False):
        yield side_by_side(pictures, labels, gap=gap, columns=columns)


def label(picture: Picture, text: str) -> Picture:
    """Write a label in the upper left corner, on a darkened strip."""
    import cv2

    if not text:
        return picture
    scale = max(picture.shape[0], 160) / 900
    face, thick, finer = cv2.FONT_HERSHEY_SIMPLEX, max(1, round(scale * 2)), 2
    (width, tall), below = cv2.getTextSize(text, face, scale * finer, thick * finer)
    margin = round(14 * scale) * finer
    strip = np.zeros((tall + below + 2 * margin, width + 2 * margin), np.uint8)
    cv2.putText(strip, text, (margin, margin + tall), face, scale * finer, 255, thick * finer, cv2.LINE_AA)
    small = cv2.resize(strip, (strip.shape[1] // finer, strip.shape[0] // finer), interpolation=cv2.INTER_AREA)
    out = picture.copy()
    high, wide = min(small.shape[0], out.shape[0]), min(small.shape[1], out.shape[1])
    ink = small[:high, :wide, None].astype(np.float32) / 255
    under = out[:high, :wide] * 0.45
    out[:high, :wide] = np.rint(under + ink * (245 - under)).astype(np.uint8)
    return out


def _joined(pictures: Sequence[Picture], gap: int, axis: int) -> Picture:
    shape = [max(picture.shape[k] for picture in pictures) for k in range(3)]
    shape[axis] = sum(picture.shape[axis] for picture in pictures) + gap * (len(pictures) - 1)
    joined, at = np.empty(shape, np.uint8), [0, 0]
    if len({picture.shape[1 - axis] for picture in pictures}) > 1:
        joined[:] = _PAPER
    for number, picture in enumerate(pictures):
        if number:
            strip = [slice(None), slice(None)]
            strip[axis] = slice(at[axis], at[axis] + gap)
            joined[tuple(strip)] = _PAPER
            at[axis] += gap
        joined[at[0] : at[0] + picture.shape[0], at[1] : at[1] + picture.shape[1]] = picture
        at[axis] += picture.shape[axis]
    return joined
