"""The built-in sample: a filmed hound that walks up some stairs, and two characters that shall do the same."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

from app.actions import bringing
from app.actions.marks import apply_values
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
    made: dict[str, Any] = json.loads((folder / "sample.json").read_text())
    bringing.add_clip(session, folder / made["clip"], copy=copy)
    apply_values(session, _marks(made), folder, copy=copy)


def _marks(made: dict[str, Any]) -> dict[str, Any]:
    """Turn what the maker of the sample wrote into the form of a file of marks (docs/formats.md)."""
    first, second, metres = made["length"]
    return {
        "world": {"length": {"frame": 0, "pixels": [first, second], "metres": metres}},
        "lassos": {frame: [outline] for frame, outline in made["lassos"].items()},
        "tracks": {
            name: {"clicks": clicks, "contacts": made["contacts"].get(name, [])}
            for name, clicks in made["clicks"].items()
        },
        "characters": {
            name: {"mesh": character["file"], "up": "z", "pairs": character["pairs"]}
            for name, character in made["characters"].items()
        },
    }
