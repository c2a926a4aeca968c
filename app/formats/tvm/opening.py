"""Opening sequences of meshes, whatever they are made of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.formats.sequence import MeshSequence
from app.formats.sequences import read_sequence
from app.formats.tvm.folder import FolderFrames
from app.formats.tvm.frames import FrameMesh, MeshFrames
from app.formats.tvm.packed import PackedFrames
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
    elif path.suffix.lower() in (".glb", ".gltf", *USD_SUFFIXES):
        form = "animated GLB" if path.suffix.lower() in (".glb", ".gltf") else "USD"
        frames = MovingFrames(read_sequence(path), form)
    else:
        raise InputError(f"{path.name} is no sequence of meshes: give a folder of PLY, OBJ, OFF or GLB, or npz, GLB.")
    try:
        frames[0]
    except InputError:
        frames.close()
        raise
    return frames
