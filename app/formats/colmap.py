"""COLMAP models: cameras, images and points3D, as text or binary."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from app.formats.colmap_files import CAMERA_MODELS, Image, Lens, Point, read_model, write_model
from app.formats.images import natural_key
from app.formats.pinhole import CENTRE, Array, intrinsics, lost, parameters
from imitation.errors import InputError

if TYPE_CHECKING:
    from imitation.cameras import CameraPath


def _pinhole(lens: Lens, where: str) -> tuple[Array, dict[str, float]]:
    names = CAMERA_MODELS.get(lens.model)
    if names is None:
        raise InputError(
            f"{where} uses the camera model {lens.model}, which has no pinhole form: "
            "run COLMAP's image_undistorter first."
        )
    values = dict(zip(names, lens.parameters, strict=True))
    fx, fy = values.pop("fx", values.get("f", 0.0)), values.pop("fy", values.get("f", 0.0))
    values.pop("f", None)
    return intrinsics(fx, fy, values.pop("cx"), values.pop("cy"), where), values


def read_colmap(folder: Path) -> CameraPath:
    """Read a model; images in the order of their names become frames. See ``read_cameras``."""
    from scipy.spatial.transform import Rotation

    from imitation.cameras import CameraPath

    lenses, images, points = read_model(folder)
    images = sorted(images, key=lambda image: natural_key(image.name))
    if not images:
        raise InputError(f"The COLMAP model in {folder} has no registered images.")
    Ks: list[Array] = []
    distortion: dict[str, float] = {}
    for image in images:
        if image.camera not in lenses:
            raise InputError(f"Image {image.name} in {folder} names camera {image.camera}, which is not in the model.")
        K, left = _pinhole(lenses[image.camera], str(folder))
        Ks.append(K)
        distortion |= left
    quaternions = np.array([image.quaternion for image in images])
    if not np.isfinite(quaternions).all() or (np.linalg.norm(quaternions, axis=1) < 1e-9).any():
        raise InputError(f"The COLMAP model in {folder} has images with rotations that are no rotations.")
    R = Rotation.from_quat(quaternions, scalar_first=True).as_matrix()
    T = np.array([image.translation for image in images])
    numbers = {point.identity: place for place, point in enumerate(points)}
    rows, seen = [], []
    for frame, image in enumerate(images):
        for x, y, identity in zip(*image.pixels.T, image.points, strict=True) if len(image.pixels) else ():
            if identity in numbers:
                rows.append((frame, x - CENTRE, y - CENTRE))
                seen.append(numbers[identity])
    world = np.array([point.position for point in points]).reshape(-1, 3)
    observations = np.array(rows, np.float64).reshape(-1, 3)
    return CameraPath(
        K=np.array(Ks),
        R=R,
        T=T,
        verdict="ok",
        points=world,
        reason="Read from a COLMAP model; scale and up are as the file has them." + lost(distortion),
        observations=observations,
        observed=np.array(seen, np.int32),
        residuals=_residuals(np.array(Ks), R, T, world, observations, np.array(seen, np.int64)),
    )


def _residuals(K: Array, R: Array, T: Array, points: Array, rows: Array, seen: np.ndarray) -> Array:
    """Reprojection error (n,) per frame, rms, pixels; NaN without observations."""
    frame = rows[:, 0].astype(int)
    local = np.einsum("nij,nj->ni", R[frame], points[seen]) + T[frame]
    with np.errstate(divide="ignore", invalid="ignore"):
        image = np.einsum("nij,nj->ni", K[frame], local / local[:, 2:])
        square = ((image[:, :2] - rows[:, 1:]) ** 2).sum(1)
        mean = np.bincount(frame, square, minlength=len(K)) / np.bincount(frame, minlength=len(K))
    residuals: Array = np.sqrt(mean)
    return residuals


def write_colmap(
    folder: Path, cameras: CameraPath, size: tuple[int, int], names: list[str], *, binary: bool = False
) -> None:
    """Write a model with one PINHOLE camera for all frames where they share it, else one a frame."""
    from scipy.spatial.transform import Rotation

    shared = len(np.unique(cameras.K, axis=0)) <= 1
    lenses = {
        number + 1: Lens("PINHOLE", size[0], size[1], parameters(K))
        for number, K in enumerate(cameras.K[:1] if shared else cameras.K)
    }
    quaternions = Rotation.from_matrix(cameras.R).as_quat(canonical=True, scalar_first=True)
    frame = cameras.observations[:, 0].astype(int)
    tracks: list[list[tuple[int, int]]] = [[] for _ in cameras.points]
    images = []
    for number, name in enumerate(names):
        here = np.flatnonzero(frame == number)
        for place, row in enumerate(here):
            tracks[cameras.observed[row]].append((number + 1, place))
        images.append(
            Image(
                number + 1,
                tuple(map(float, quaternions[number])),
                tuple(map(float, cameras.T[number])),
                1 if shared else number + 1,
                name,
                cameras.observations[here, 1:] + CENTRE,
                cameras.observed[here].astype(np.int64) + 1,
            )
        )
    points = [
        Point(number + 1, tuple(map(float, position)), (200, 200, 200), 0.0, tuple(tracks[number]))
        for number, position in enumerate(cameras.points)
    ]
    write_model(folder, lenses, images, points, binary=binary)
