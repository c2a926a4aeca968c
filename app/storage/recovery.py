"""Work that was not saved when the program ended: kept beside the project until somebody decides about it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

import attrs

from app.formats.atomic import explained
from app.model.document import Document
from app.storage.folder import ProjectFolder
from imitation.errors import InputError

PATTERN = "recovery*.json"


@attrs.frozen(eq=False)
class UnsavedWork:
    """A document that was autosaved and never saved.

    Attributes
    ----------
    file : where it lies, in the project's folder.
    when : of the autosave, in the machine's time zone.
    """

    file: Path
    document: Document
    when: datetime

    def forget(self) -> None:
        """Delete it for good."""
        with explained(self.file):
            self.file.unlink(missing_ok=True)


def set_aside(folder: ProjectFolder) -> None:
    """Move an autosave that may be recovered out of the way of the next autosave.

    Raises ``InputError`` where the folder cannot be written.
    """
    if folder.recoverable() is None:
        return
    target, number = folder.path / "recovery.json", 2
    while target.exists():
        target, number = folder.path / f"recovery-{number}.json", number + 1
    with explained(target):
        folder.autosave_file.rename(target)


def unsaved_work(folder: ProjectFolder) -> tuple[UnsavedWork, ...]:
    """Give what may be recovered in a project's folder, the newest first; damaged files are left out."""
    files = [*folder.path.glob(PATTERN)]
    if folder.recoverable() is not None:
        files.append(folder.autosave_file)
    return _newest_first(folder, files)


def readable(folder: ProjectFolder) -> tuple[UnsavedWork, ...]:
    """Give every autosave in a project's folder that can be read, the newest first, though the project be newer.

    For a project whose own file cannot be read: any of them is better than nothing.
    """
    return _newest_first(folder, (*folder.path.glob(PATTERN), folder.autosave_file))


def _newest_first(folder: ProjectFolder, files: Iterable[Path]) -> tuple[UnsavedWork, ...]:
    found = [work for file in files if (work := _read(folder, file)) is not None]
    return tuple(sorted(found, key=lambda work: work.when, reverse=True))


def _read(folder: ProjectFolder, file: Path) -> UnsavedWork | None:
    with contextlib.suppress(InputError, OSError):
        when = datetime.fromtimestamp(file.stat().st_mtime).astimezone()
        return UnsavedWork(file, folder.read(file), when)
    return None
