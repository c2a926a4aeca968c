"""Work that was not saved when the program ended: kept beside the project until somebody decides about it."""

from __future__ import annotations

import contextlib
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
    found = [_read(folder, file) for file in folder.path.glob(PATTERN)]
    if folder.recoverable() is not None:
        found.append(_read(folder, folder.autosave_file))
    return tuple(sorted((work for work in found if work is not None), key=lambda work: work.when, reverse=True))


def _read(folder: ProjectFolder, file: Path) -> UnsavedWork | None:
    with contextlib.suppress(InputError, OSError):
        when = datetime.fromtimestamp(file.stat().st_mtime).astimezone()
        return UnsavedWork(file, folder.read(file), when)
    return None
