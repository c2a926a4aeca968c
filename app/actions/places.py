"""Folders of the user's machine where the program keeps what belongs to no project."""

from __future__ import annotations

from pathlib import Path

import platformdirs


def unsaved_folder() -> Path:
    """Where projects live until they are saved for the first time."""
    return Path(platformdirs.user_state_dir("motionwright", appauthor=False)) / "unsaved"


def settings_folder() -> Path:
    """Where settings of the program are kept."""
    return Path(platformdirs.user_config_dir("motionwright", appauthor=False))
