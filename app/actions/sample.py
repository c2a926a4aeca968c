"""The built-in sample: a filmed hound that walks up some stairs, and two characters that shall do the same."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from app.actions import bringing
from app.actions.marks import apply_marks
from app.actions.session import Session
from imitation.errors import InputError


def sample_folder() -> Path:
    """Give the folder of the sample's files.

    Raises ``InputError`` when the installation came without them.
    """
    folder = Path(str(files("resources"))) / "sample"
    if not (folder / "sample.json").is_file():
        raise InputError(f"The sample is not in this installation ({folder} is missing): install Motionwright again.")
    return folder


def fill_with_sample(session: Session, *, copy: bool = False) -> None:
    """Put the sample's clip, marks and characters into a new project, as a user would have made them."""
    folder = sample_folder()
    bringing.add_clip(session, folder / "clip.mp4", copy=copy)
    apply_marks(session, folder / "sample.json", copy=copy)
