"""Opening sequences of meshes, whatever they are made of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.formats.animated_glb import is_shape_animation, shape_animation
from app.formats.gltf import read_gltf
from app.formats.gltf_animation import keep_animation
from app.formats.images import read_bytes
from app.formats.meshfile import MeshFile, check_mesh
from app.formats.posed_glb import PosedGltf
from app.formats.sequence import MeshSequence
from app.formats.tvm.folder import FolderFrames
from app.formats.tvm.frames import FrameMesh, MeshFrames
from app.formats.tvm.glb_dress import glb_texture
from app.formats.tvm.packed import PackedFrames
from app.formats.tvm.pictures import PictureRoom
from app.formats.tvm.usd_frames import UsdFrames
from app.formats.usd import USD_SUFFIXES
from imitation.errors import InputError

GLB_SUFFIXES = (".glb", ".gltf")


class MovingFrames(MeshFrames):
    """A moving mesh of one connectivity (animated GLB, USD), held in single precision."""

    moving = True
    up, unit = "z", 1.0

    def __init__(self, sequence: MeshSequence, form: str) -> None:
        if len(sequence) < 2:
            raise InputError(f"The file {sequence.name} holds one frame only: a sequence needs at least two.")
        self.name, self.form, self.fps = sequence.name, form, sequence.fps
        self._vertices = sequence.vertices.astype(np.float32)
        self._faces, self._colours = sequence.faces, sequence.colors

    def __len__(self) -> int:
        return len(self._vertices)

    def _frame(self, frame: int) -> FrameMesh:
        return FrameMesh(self._vertices[frame].astype(np.float64), self._faces, self._colours)


class PosedFrames(MeshFrames):
    """An animated scene of a GLB (joints, moving parts), posed when a frame is asked for; pictures come along."""

    moving = True
    up, unit = "z", 1.0
    form = "animated GLB"

    def __init__(self, posed: PosedGltf, path: Path, remark: str = "") -> None:
        if len(posed) < 2:
            raise InputError(f"The file {path.name} holds one frame only: a sequence needs at least two.")
        self.name, self.fps = path.name, posed.animation.fps
        self._posed, self._room = posed, PictureRoom()
        self._texture = glb_texture(posed.gltf, path, self._room)
        self.remark = f"{remark} {_uneven(posed)}".strip()
        check_mesh(MeshFile(posed.vertices(0), posed.faces, posed.colors, "z", path.name))

    def __len__(self) -> int:
        return len(self._posed)

    def _frame(self, frame: int) -> FrameMesh:
        return FrameMesh(self._posed.vertices(frame), self._posed.faces, self._posed.colors, self._texture)


def _uneven(posed: PosedGltf) -> str:
    """What was chosen where the keys do not say a rate."""
    if posed.animation.even:
        return ""
    return f"The keys of {posed.gltf.name} lie at no even rate: it is sampled at {posed.animation.fps} a second."


def _animated_glb(path: Path, wanted: str | None) -> MeshFrames:
    """Morph targets of one plain mesh as they are keyed; anything else that moves, or wears pictures, is posed."""
    gltf = read_gltf(path, read_bytes(path).tobytes())
    remark = keep_animation(gltf, wanted)
    if is_shape_animation(gltf) and not gltf.items("textures"):
        frames = MovingFrames(shape_animation(gltf), "animated GLB")
        frames.remark = remark
        return frames
    return PosedFrames(PosedGltf(gltf), path, remark)


def open_mesh_frames(path: str | Path, *, animation: str | None = None) -> MeshFrames:
    """Open a folder of PLY, OBJ, OFF, STL or GLB files, an .npz, an animated GLB, or USD.

    Frames are read when they are asked for. Only the first is looked at here.

    Parameters
    ----------
    path : the folder or file.
    animation : which one of a GLB, by its name or its number from 1; default: the first, and a remark on the others.

    Raises
    ------
    InputError
        No such animation, or nothing to choose from; no such file, no meshes, one only, several formats in a folder,
        a damaged first frame.
    """
    path = Path(path)
    if animation is not None and path.is_file() and path.suffix.lower() not in GLB_SUFFIXES:
        raise InputError(f"{path.name} has no animations to choose from: only an animated GLB can hold several.")
    if path.is_dir():
        if animation is not None:
            raise InputError(f"{path.name} is a folder, with no animations to choose from: only an animated GLB has.")
        frames: MeshFrames = FolderFrames(path)
    elif not path.is_file():
        raise InputError(f"The sequence {path} does not exist: choose a folder or a file.")
    elif path.suffix.lower() == ".npz":
        frames = PackedFrames(path)
    elif path.suffix.lower() in GLB_SUFFIXES:
        frames = _animated_glb(path, animation)
    elif path.suffix.lower() in USD_SUFFIXES:
        frames = UsdFrames(path)
    else:
        raise InputError(f"{path.name} is no sequence of meshes: give a folder of PLY, OBJ, OFF or GLB, or npz, GLB.")
    try:
        frames[0]
    except InputError:
        frames.close()
        raise
    return frames
