"""Opening sequences of meshes, whatever they are made of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.formats.animated_glb import is_shape_animation, shape_animation
from app.formats.gltf import read_gltf
from app.formats.images import read_bytes
from app.formats.meshfile import MeshFile, check_mesh
from app.formats.posed_glb import PosedGltf
from app.formats.sequence import MeshSequence
from app.formats.sequences import read_sequence
from app.formats.tvm.folder import FolderFrames
from app.formats.tvm.frames import FrameMesh, MeshFrames
from app.formats.tvm.glb_dress import glb_texture
from app.formats.tvm.packed import PackedFrames
from app.formats.tvm.pictures import PictureRoom
from app.formats.usd import USD_SUFFIXES
from imitation.errors import InputError


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

    def __init__(self, posed: PosedGltf, path: Path) -> None:
        if len(posed) < 2:
            raise InputError(f"The file {path.name} holds one frame only: a sequence needs at least two.")
        self.name, self.fps = path.name, posed.animation.fps
        self._posed, self._room = posed, PictureRoom()
        self._texture = glb_texture(posed.gltf, path, self._room)
        self.remark = _remark(posed)
        check_mesh(MeshFile(posed.vertices(0), posed.faces, posed.colors, "z", path.name))

    def __len__(self) -> int:
        return len(self._posed)

    def _frame(self, frame: int) -> FrameMesh:
        return FrameMesh(self._posed.vertices(frame), self._posed.faces, self._posed.colors, self._texture)


def _remark(posed: PosedGltf) -> str:
    """What was chosen that the file leaves open."""
    words = []
    names = [str(entry.get("name") or "one without a name") for entry in posed.gltf.items("animations")]
    if len(names) > 1:
        words.append(f"{posed.gltf.name} has {len(names)} animations: {posed.animation.name} is taken.")
    if not posed.animation.even:
        words.append(
            f"The keys of {posed.gltf.name} lie at no even rate: it is sampled at {posed.animation.fps} a second."
        )
    return " ".join(words)


def _animated_glb(path: Path) -> MeshFrames:
    """Morph targets of one mesh as they are keyed; anything else that moves is posed."""
    gltf = read_gltf(path, read_bytes(path).tobytes())
    if is_shape_animation(gltf):
        return MovingFrames(shape_animation(gltf), "animated GLB")
    return PosedFrames(PosedGltf(gltf), path)


def open_mesh_frames(path: str | Path) -> MeshFrames:
    """Open a folder of PLY, OBJ, OFF, STL or GLB files, an .npz, an animated GLB, or USD.

    Frames are read when they are asked for. Only the first is looked at here.

    Raises
    ------
    InputError
        No such file, no meshes, one only, several formats in a folder, a damaged first frame.
    """
    path = Path(path)
    if path.is_dir():
        frames: MeshFrames = FolderFrames(path)
    elif not path.is_file():
        raise InputError(f"The sequence {path} does not exist: choose a folder or a file.")
    elif path.suffix.lower() == ".npz":
        frames = PackedFrames(path)
    elif path.suffix.lower() in (".glb", ".gltf"):
        frames = _animated_glb(path)
    elif path.suffix.lower() in USD_SUFFIXES:
        frames = MovingFrames(read_sequence(path), "USD")
    else:
        raise InputError(f"{path.name} is no sequence of meshes: give a folder of PLY, OBJ, OFF or GLB, or npz, GLB.")
    try:
        frames[0]
    except InputError:
        frames.close()
        raise
    return frames
