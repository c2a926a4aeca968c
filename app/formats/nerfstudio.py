"""nerfstudio's transforms.json: camera to world, OpenGL axes (x right, y up, z backward)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from app.formats.atomic import replacing
from app.formats.images import natural_key, read_bytes
from app.formats.pinhole import Array, intrinsics, lost, parameters
from app.formats.ply import read_ply, write_ply
from imitation.errors import InputError

if TYPE_CHECKING:
    from imitation.cameras import CameraPath

FLIP = np.diag([1.0, -1.0, -1.0])  # OpenGL's camera axes to OpenCV's, and back
POINTS = "sparse_pc.ply"
DISTORTION = ("k1", "k2", "k3", "k4", "p1", "p2")


def _number(frame: dict[str, Any], whole: dict[str, Any], key: str, default: float | None = None) -> float:
    value = frame.get(key, whole.get(key, default))
    if value is None:
        raise KeyError(key)
    return float(value)


def _lens(frame: dict[str, Any], whole: dict[str, Any], where: str) -> Array:
    model = str(frame.get("camera_model", whole.get("camera_model", "OPENCV")))
    if model not in ("OPENCV", "PINHOLE", "SIMPLE_PINHOLE"):
        raise InputError(
            f"{where} uses the camera model {model}, which has no pinhole form: undistort its images first."
        )
    width = _number(frame, whole, "w", -1.0)
    height = _number(frame, whole, "h", -1.0)
    if "fl_x" in frame or "fl_x" in whole:
        fx = _number(frame, whole, "fl_x")
    else:
        if width <= 0:
            raise KeyError("w")
        fx = 0.5 * width / np.tan(0.5 * _number(frame, whole, "camera_angle_x"))
    fy = _number(frame, whole, "fl_y", fx)
    centred = (width / 2 if width > 0 else None, height / 2 if height > 0 else None)
    return intrinsics(fx, fy, _number(frame, whole, "cx", centred[0]), _number(frame, whole, "cy", centred[1]), where)


def read_transforms(path: Path) -> CameraPath:
    """Read transforms.json and the point cloud it names; frames in the order of their names. See ``read_cameras``."""
    from imitation.cameras import CameraPath

    try:
        whole = json.loads(read_bytes(path).tobytes())
    except ValueError as error:
        raise InputError(f"The file {path} is not JSON: write the transforms again.") from error
    frames = whole.get("frames") if isinstance(whole, dict) else None
    if not isinstance(frames, list) or not frames:
        raise InputError(f"The file {path} has no list of frames: is it a transforms.json?")
    try:
        frames = sorted(frames, key=lambda frame: natural_key(str(frame.get("file_path", ""))))
        poses = np.array([frame["transform_matrix"] for frame in frames], np.float64)
        Ks = np.array([_lens(frame, whole, str(path)) for frame in frames])
        distortion = {key: _number(frames[0], whole, key, 0.0) for key in DISTORTION}
    except (KeyError, ValueError, TypeError, AttributeError) as error:
        raise InputError(f"The file {path} lacks a pose or a focal length for some frames ({error}).") from error
    if poses.shape[1:] not in ((4, 4), (3, 4)) or not np.isfinite(poses).all():
        raise InputError(f"The poses in {path} must be finite 4 x 4 matrices, camera to world.")
    axes = poses[:, :3, :3]
    scale = np.cbrt(np.abs(np.linalg.det(axes)))[:, None, None]
    if (scale < 1e-9).any() or np.abs(axes @ np.swapaxes(axes, 1, 2) / scale**2 - np.eye(3)).max() > 1e-3:
        raise InputError(f"The poses in {path} hold matrices that are no rotations.")
    R = FLIP @ np.swapaxes(axes / scale, 1, 2)
    T = -np.einsum("nij,nj->ni", R, poses[:, :3, 3])
    points = np.zeros((0, 3))
    cloud = whole.get("ply_file_path")
    if isinstance(cloud, str) and (path.parent / cloud).is_file():
        points = read_ply(read_bytes(path.parent / cloud).tobytes(), cloud).vertices
    reason = "Read from a transforms.json; scale and up are as the file has them." + lost(distortion)
    return CameraPath(K=Ks, R=R, T=T, verdict="ok", points=points, reason=reason)


def write_transforms(path: Path, cameras: CameraPath, size: tuple[int, int], names: list[str]) -> None:
    """Write transforms.json, and the points beside it as ``sparse_pc.ply`` where there are any."""
    shared = len(np.unique(cameras.K, axis=0)) <= 1
    whole: dict[str, Any] = {"camera_model": "OPENCV", "w": size[0], "h": size[1]}
    whole |= dict.fromkeys(("k1", "k2", "p1", "p2"), 0.0)

    def lens(K: Array) -> dict[str, float]:
        return dict(zip(("fl_x", "fl_y", "cx", "cy"), parameters(K), strict=True))

    if shared and len(cameras):
        whole |= lens(cameras.K[0])
    if len(cameras.points):
        whole["ply_file_path"] = POINTS
    frames = []
    for frame, name in enumerate(names):
        pose = np.eye(4)
        pose[:3, :3] = cameras.R[frame].T @ FLIP
        pose[:3, 3] = cameras.centres[frame]
        entry: dict[str, Any] = {"file_path": f"images/{name}", "transform_matrix": pose.tolist()}
        frames.append(entry if shared else entry | lens(cameras.K[frame]))
    whole["frames"] = frames
    if len(cameras.points):
        with replacing(path.parent / POINTS) as target:
            write_ply(target, cameras.points, np.zeros((0, 3), np.int32), exact=True)
    with replacing(path) as target:
        target.write_text(json.dumps(whole, indent=1) + "\n")
