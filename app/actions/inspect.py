"""Look into a file from outside without taking it into a project."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

from app.formats import open_images, open_video, read_mesh, read_sequence
from app.formats.tvm import MeshFrames, open_mesh_frames
from app.storage.folder import SUFFIX, ProjectFolder
from imitation.errors import InputError

MESHES = {".ply", ".obj", ".off", ".stl"}
PICTURES = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp"}


def inspect(path: Path) -> dict[str, Any]:
    """Give what kind of thing a path is and what it holds.

    Raises ``InputError`` with what is wrong when it cannot be used.
    """
    if not path.exists():
        raise InputError(f"{path} does not exist: check the path.")
    if path.is_dir():
        return _folder(path)
    if path.name == "project.json":
        return _project(path.parent)
    if path.suffix.lower() in MESHES:
        mesh = read_mesh(path)
        colours = "with colours" if mesh.colors is not None else "without colours"
        return {"kind": "mesh", "vertices": len(mesh.vertices), "faces": len(mesh.faces), "surface": colours}
    if path.suffix.lower() in {".glb", ".npz", ".usd", ".usda", ".usdc"}:
        return _sequence(path)
    if path.name == "transforms.json":
        return _cameras(path)
    with open_video(path) as video:
        width, height = video.size
        return {"kind": "video", "frames": len(video), "size": f"{width} x {height}", "fps": float(video.fps)}


def _folder(path: Path) -> dict[str, Any]:
    if path.suffix == SUFFIX or (path / "project.json").is_file():
        return _project(path)
    names = {entry.suffix.lower() for entry in path.iterdir()}
    if any((path / name).is_file() for name in ("cameras.txt", "cameras.bin", "transforms.json")):
        return _cameras(path)
    if names & PICTURES:
        with open_images(path) as pictures:
            width, height = pictures.size
            return {"kind": "pictures", "frames": len(pictures), "size": f"{width} x {height}"}
    if names & MESHES:
        return _sequence(path)
    raise InputError(f"{path} holds neither pictures nor meshes nor cameras nor a project.")


def _project(path: Path) -> dict[str, Any]:
    document = ProjectFolder.find(path).load()
    return {
        "kind": "project",
        "name": document.name,
        "tracks": len(document.tracks),
        "characters": len(document.characters),
    }


def _sequence(path: Path) -> dict[str, Any]:
    if path.suffix.lower() in {".glb", ".gltf"}:
        with open_mesh_frames(path) as frames:
            return _moving(len(frames), len(frames[0].vertices), len(frames[0].faces), frames.fps)
    if path.is_dir() or path.suffix.lower() == ".npz":
        with open_mesh_frames(path) as frames:
            if not frames.moving and _changes(frames):
                first = frames[0]
                return {
                    "kind": "mesh sequence with faces of its own in every frame",
                    "frames": len(frames),
                    "vertices": len(first.vertices),
                    "faces": len(first.faces),
                    "fps": float(frames.fps) if frames.fps is not None else "not stated",
                }
    sequence = read_sequence(path)
    return _moving(len(sequence), sequence.vertices.shape[1], len(sequence.faces), sequence.fps)


def _moving(frames: int, vertices: int, faces: int, fps: Fraction | None) -> dict[str, Any]:
    rate = float(fps) if fps is not None else "not stated"
    return {"kind": "mesh sequence", "frames": frames, "vertices": vertices, "faces": faces, "fps": rate}


def _changes(frames: MeshFrames) -> bool:
    """Whether the second frame or the last has other faces than the first."""
    import numpy as np

    first, *others = (frames[k] for k in (0, 1, -1))
    return any(
        len(other.vertices) != len(first.vertices) or not np.array_equal(other.faces, first.faces) for other in others
    )


def _cameras(path: Path) -> dict[str, Any]:
    from app.formats.cameras import read_cameras

    cameras = read_cameras(path)
    return {"kind": "cameras", "frames": len(cameras), "points": len(cameras.points)}
