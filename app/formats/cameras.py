"""Camera paths from and to other programs: COLMAP models (text, binary) and nerfstudio's transforms.json.

Pixel centres: both put the centre of the top-left pixel at (0.5, 0.5), we at (0, 0); converted here, both ways.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from app.formats.colmap import read_colmap, write_colmap
from app.formats.nerfstudio import read_transforms, write_transforms
from imitation.errors import InputError

if TYPE_CHECKING:
    from imitation.cameras import CameraPath

CameraForm = Literal["text", "binary"]


def read_cameras(path: str | Path) -> CameraPath:
    """Read one camera a frame, in the order of the images' names.

    Parameters
    ----------
    path : the folder of a COLMAP model (or one that holds ``sparse/0`` or ``sparse``), or a transforms.json.

    Returns
    -------
    CameraPath
        In the file's own world, verdict "ok"; ``reason`` says what the file leaves open. Lens distortion is not kept,
        and named in ``reason``. From COLMAP also points, observations and residuals.

    Raises
    ------
    InputError
        No such model, a damaged file, a camera model without a pinhole form.
    """
    path = Path(path)
    if path.suffix.lower() == ".json":
        return read_transforms(path)
    if not path.exists():
        raise InputError(f"There are no cameras at {path}: give a COLMAP model's folder or a transforms.json.")
    if path.is_file():
        path = path.parent
    for folder in (path, path / "sparse" / "0", path / "sparse", path / "0"):
        if (folder / "images.bin").is_file() or (folder / "images.txt").is_file():
            return read_colmap(folder)
    if (path / "transforms.json").is_file():
        return read_transforms(path / "transforms.json")
    raise InputError(
        f"The folder {path} holds no COLMAP model (cameras and images as .bin or .txt) and no transforms.json."
    )


def write_cameras(
    path: str | Path,
    cameras: CameraPath,
    size: tuple[int, int],
    *,
    form: CameraForm = "text",
    pattern: str = "frame_{:05d}.png",
) -> None:
    """Write the cameras: a name that ends in .json as transforms.json, else a folder with a COLMAP model.

    Parameters
    ----------
    size : (width, height) of the frames, pixels.
    form : of the COLMAP model.
    pattern : name of each frame's image, with its number.
    """
    path = Path(path)
    names = [pattern.format(frame) for frame in range(len(cameras))]
    if len(set(names)) < len(names):
        raise InputError(f"The name pattern {pattern!r} gives several frames one name; put {{:05d}} into it.")
    if path.suffix.lower() == ".json":
        write_transforms(path, cameras, size, names)
    else:
        write_colmap(path, cameras, size, names, binary=form == "binary")
