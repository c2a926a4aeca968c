"""OpenEXR pictures: linear light with alpha, half floats; by the format's own package, which is optional."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.atomic import replacing
from imitation.errors import InputError


def write_exr(path: str | Path, picture: NDArray[np.floating]) -> None:
    """Write linear light multiplied by alpha (h, w, 4), as compositing programs expect it; whole or not at all.

    Raises
    ------
    InputError
        The package OpenEXR is not installed, the shape is another one, or the disk is full.
    """
    openexr = _package()
    path = Path(path)
    if picture.ndim != 3 or picture.shape[2] != 4:
        raise InputError(f"An EXR picture must be (h, w, 4), got {picture.shape}.")
    header = {"compression": openexr.ZIP_COMPRESSION, "type": openexr.scanlineimage}
    with replacing(path) as temporary:
        openexr.File(header, {"RGBA": np.ascontiguousarray(picture, np.float16)}).write(str(temporary))


def need_exr() -> None:
    """Refuse before anything is computed where the package is not installed."""
    _package()


def _package() -> Any:
    try:
        import OpenEXR
    except ImportError:
        raise InputError("EXR files need the package OpenEXR: install it, or write PNG files instead.") from None
    return OpenEXR
