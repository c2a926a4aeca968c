"""A project of two captured sequences that is analysed in seconds: a walk, and gymnastics of the same person."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.actions import performing
from app.actions.session import Session
from app.formats import write_image
from app.formats.tvm import FrameMesh, Texture, write_mesh_frames
from app.model.edits import performance as edits
from resources.performer import Part, perform

FPS = 15
TAKES = {"Walk": (Part("walk", 4),), "Gym": (Part("jumping jack", 3), Part("squat", 2.5), Part("march", 3))}


def write_take(folder: Path, name: str, form: str = "npz") -> Path:
    """Write one take, coarsely meshed; gives the file or folder."""
    capture = perform(list(TAKES[name]), fps=FPS, seed=len(name), cell=0.05)
    target = folder / (f"{name}.npz" if form == "npz" else name)
    frames = (FrameMesh(*capture.mesh(frame)) for frame in range(len(capture)))
    write_mesh_frames(target, frames, form=form, fps=FPS, count=len(capture), name=name)  # type: ignore[arg-type]
    return target


def build_small_performance(folder: Path) -> Path:
    """Make the project with its motion graph; gives its folder. No key motion is chosen yet."""
    session = Session.new(folder / "moves")
    for name in TAKES:
        performing.add_sequence(session, write_take(folder, name), name=name, copy=True)
    session.result(session.stages.graph)
    # Blends take seconds; tests that look at them switch them on.
    session.apply(edits.set_smoothing(session.document, blend=False))
    session.save()
    path = session.folder.path
    session.close()
    return path


def write_worn_take(folder: Path, name: str) -> Path:
    """The same take with a picture of its own on every frame instead of colours, as capture stages deliver it."""
    capture = perform(list(TAKES[name]), fps=FPS, seed=len(name), cell=0.07)
    pictures = folder / f"{name} pictures"
    pictures.mkdir()
    frames = []
    for frame in range(len(capture)):
        vertices, faces, _ = capture.mesh(frame)
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        image = pictures / f"{frame:04d}.png"
        write_image(image, np.full((8, 8, 3), (40, 90 + frame % 100, 160), np.uint8))
        coordinates = ((vertices - low) / (high - low))[:, [0, 2]]
        worn = Texture(coordinates, faces, (image,), np.zeros(len(faces), np.int32))
        frames.append(FrameMesh(vertices, faces, None, worn))
    write_mesh_frames(folder / name, frames, form="ply", fps=FPS, count=len(frames), name=name)
    return folder / name
