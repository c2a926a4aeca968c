"""Time-varying meshes from and to files: every frame with faces of its own, read one at a time."""

from app.formats.tvm.frames import FrameMesh, MeshFrames, Texture
from app.formats.tvm.guess import Guess, guess_facts
from app.formats.tvm.opening import open_mesh_frames
from app.formats.tvm.painting import painted
from app.formats.tvm.writing import FRAME_FORMS, FrameForm, write_mesh_frames

__all__ = [
    "FRAME_FORMS",
    "FrameForm",
    "FrameMesh",
    "Guess",
    "MeshFrames",
    "Texture",
    "guess_facts",
    "open_mesh_frames",
    "painted",
    "write_mesh_frames",
]
