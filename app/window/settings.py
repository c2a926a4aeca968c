"""What the window remembers between runs: its size, the look, projects opened lately."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSettings

from app.actions.places import settings_folder

RECENT = 8


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
