"""What the window remembers between runs: its size, the look, projects opened lately."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Literal

from PySide6.QtCore import QSettings

from app.actions.places import settings_folder

Choice = Literal["auto", "raster", "gl"]

RECENT = 8
AUTOSAVES = (15, 30, 60, 120, 300)
"""Seconds between autosaves that can be chosen."""
MEMORY = (256, 512, 1024, 2048, 4096)
"""Megabytes of results kept in memory that can be chosen."""
VIEWPORTS = ("auto", "gl", "raster")


def settings() -> QSettings:
    """The file of the window's settings."""
    return QSettings(str(settings_folder() / "window.ini"), QSettings.Format.IniFormat)


def recent_projects() -> list[Path]:
    """Projects opened lately that are still there, the last first."""
    value = settings().value("recent", [])
    names = [value] if isinstance(value, str) else list(value or [])
    return [Path(name) for name in names if Path(name).exists()]


def remember_project(path: Path) -> None:
    """Put a project at the top of those opened lately."""
    others = [str(each) for each in recent_projects() if each != path]
    settings().setValue("recent", [str(path), *others][:RECENT])


def autosave_seconds() -> int:
    """Seconds between two autosaves."""
    return _chosen("autosave", AUTOSAVES, 60)


def memory_megabytes() -> int:
    """Megabytes of results that are kept in memory."""
    return _chosen("memory", MEMORY, 1024)


def viewport() -> Choice:
    """What draws in 3D."""
    value = str(settings().value("viewport", "auto"))
    return "gl" if value == "gl" else "raster" if value == "raster" else "auto"


def expects_opengl(wanted: Choice) -> bool:
    """Whether OpenGL will draw in 3D: by choice, or because a graphics card was found when the window was last open.

    To look for one takes longer than the window has until it is seen.
    """
    return wanted == "gl" or (wanted == "auto" and str(settings().value("graphics card", "false")) == "true")


def remember_graphics_card(found: bool) -> None:
    """Keep whether this machine has one, for the next start."""
    settings().setValue("graphics card", "true" if found else "false")


def _chosen(name: str, values: tuple[int, ...], default: int) -> int:
    """A remembered number; one that cannot be chosen, by hand or by a newer program, counts as the default."""
    try:
        value = int(str(settings().value(name, default)))
    except ValueError:
        return default
    return value if value in values else default


def thumbnail_of(project: Path) -> Path:
    """Where the picture of a project lies that is shown among those opened lately."""
    name = hashlib.blake2b(str(project).encode(), digest_size=12).hexdigest()
    return settings_folder() / "thumbnails" / f"{name}.png"
