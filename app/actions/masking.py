"""Masks made elsewhere become lassos, which a person can correct like drawn ones."""

from __future__ import annotations

from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.session import Session
from app.formats import open_images
from app.model.edits import Edit
from app.model.edits.edit import clip_of
from app.model.frozen import FrozenMap
from app.model.values import KeyMask, Lasso
from imitation.errors import InputError

SMALLEST = 20
"""Specks and holes of fewer pixels are noise of the mask's maker."""


def import_masks(session: Session, folder: Path, *, every: int = 1, tolerance: float = 1.0) -> int:
    """Take a folder of mask pictures, one a frame, white the subject, as key masks; gives how many.

    Parameters
    ----------
    every : only each so manieth frame; the program carries masks to the frames between.
    tolerance : how far outlines may leave the picture's edge, pixels.

    Raises
    ------
    InputError : other size or number than the clip has.
    """
    clip = clip_of(session.document)
    keys: dict[int, KeyMask] = {}
    with open_images(folder) as pictures:
        if len(pictures) != clip.frame_count or pictures.size != (clip.width, clip.height):
            has = f"{len(pictures)} of {pictures.size[0]} x {pictures.size[1]}"
            wanted = f"{clip.frame_count} of {clip.width} x {clip.height}"
            raise InputError(f"The masks of {folder} do not fit the clip: there are {has}, it needs {wanted}.")
        for frame in range(0, clip.frame_count, max(every, 1)):
            lassos = _outlines(pictures[frame][..., 0] > 127, tolerance)
            if lassos:
                keys[frame] = KeyMask(lassos)
    if not keys:
        raise InputError(f"The masks of {folder} are empty: white is the subject.")
    masks = FrozenMap({**session.document.masks, **keys})
    edit = Edit(attrs.evolve(session.document, masks=masks), f"Import {len(keys)} masks")
    session.apply(edit)
    return len(keys)


def _outlines(mask: NDArray[np.bool_], tolerance: float) -> tuple[Lasso, ...]:
    import cv2

    found, levels = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    lassos = []
    for index, contour in enumerate(found):
        outline = cv2.approxPolyDP(contour, tolerance, True)[:, 0]
        if len(outline) >= 3 and cv2.contourArea(contour) >= SMALLEST:
            points = tuple((float(x), float(y)) for x, y in outline)
            lassos.append(Lasso(points, subtract=bool(levels[0, index, 3] >= 0)))
    return tuple(sorted(lassos, key=lambda lasso: lasso.subtract))
