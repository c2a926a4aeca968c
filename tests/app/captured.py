"""A small captured performance on the disk, for tests of everything that starts from files."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from app.formats.tvm import FrameMesh, write_mesh_frames
from resources.performer import Capture, Part, perform


@lru_cache(maxsize=1)
def small_capture() -> Capture:
    """Walk, squats, walk again, arms waved: 15 frames a second, coarse meshes."""
    script = [Part("walk", 4), Part("squat", 2), Part("march", 4), Part("walk", 3)]
    return perform(script, fps=15, seed=11, cell=0.045)


def write_capture(target: Path, form: str = "npz") -> Path:
    """Write it; gives the path."""
    capture = small_capture()
    frames = (FrameMesh(*capture.mesh(k)) for k in range(len(capture)))
    write_mesh_frames(target, frames, form=form, fps=15, count=len(capture), name="take")  # type: ignore[arg-type]
    return target
