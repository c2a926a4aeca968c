"""Bring files into a project: the clip, characters, cameras."""

from __future__ import annotations

from pathlib import Path

from app.actions.session import Session
from app.formats import open_images, open_video, read_mesh
from app.model.character import UpAxis
from app.model.edits import characters, scene
from app.model.values import Clip
from imitation.errors import InputError


def add_clip(session: Session, path: Path, *, copy: bool = False, fps: float | None = None) -> Clip:
    """Set the project's clip: a video, or a folder of pictures at a frame rate.

    Raises ``InputError`` when it cannot be read or the project's marks do not fit it.
    """
    return take_clip(session, read_clip(session, path, copy=copy, fps=fps), path.stem)


def read_clip(session: Session, path: Path, *, copy: bool = False, fps: float | None = None) -> Clip:
    """Look what a clip is and bring it in, without changing the document: safe in any thread."""
    if not path.exists():
        raise InputError(f"{path} does not exist: check the path.")
    with open_images(path, fps=fps or 25.0) if path.is_dir() else open_video(path) as source:
        width, height = source.size
        count, rate = len(source), float(source.fps)
    return Clip(session.bring_in(path, copy=copy), width, height, count, rate)


def take_clip(session: Session, clip: Clip, name: str) -> Clip:
    """Set a clip that was read; a project without a name of its own is called like it."""
    session.apply(scene.set_clip(session.document, clip))
    if session.document.name == "Untitled":
        session.apply(scene.rename(session.document, name))
    return clip


def add_character(
    session: Session, path: Path, *, name: str | None = None, up: UpAxis | None = None, copy: bool = False
) -> str:
    """Add a character's mesh and give its id; ``up`` is its up axis, by default Y, or Z for USD-like files.

    Raises ``InputError`` when the mesh cannot be read.
    """
    read_mesh(path)
    media = session.bring_in(path, copy=copy)
    edit = characters.add_character(session.document, media, name=name or path.stem, up=up or "y")
    return session.apply(edit).characters[-1].id


def use_camera_file(session: Session, path: Path, *, copy: bool = False) -> None:
    """Read the cameras from a COLMAP model or a transforms.json instead of solving them."""
    from app.formats.cameras import read_cameras

    read_cameras(path)
    session.apply(scene.set_camera(session.document, "file", file=session.bring_in(path, copy=copy)))
