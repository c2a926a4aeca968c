"""What runs that ended badly left unsaved: found again, taken up, or thrown away. Nothing is decided for the person."""

from __future__ import annotations

import contextlib
import shutil
import time
from pathlib import Path

from app.actions.collecting import linked_from
from app.actions.places import unsaved_folder
from app.actions.session import Session
from app.model.document import Document
from app.storage.folder import ProjectFolder
from app.storage.lock import in_use
from app.storage.recovery import UnsavedWork, readable, set_aside, unsaved_work
from app.storage.results import ResultStore
from imitation.errors import InputError

ABANDONED = 24 * 3600.0
"""Seconds after which the place of a project without any work in it is swept."""


def pending(session: Session) -> tuple[UnsavedWork, ...]:
    """Give the unsaved work of earlier runs in this project, the newest first, safe from this run's autosaves.

    To be asked once, before this run autosaves.
    A project that another program has open has none: what lies there is that one's.
    """
    if not session.alone:
        return ()
    with contextlib.suppress(InputError):  # a folder that cannot be written gets no autosave over it either
        set_aside(session.folder)
    return unsaved_work(session.folder)


def recover(session: Session, work: UnsavedWork) -> None:
    """Go on with unsaved work, as one entry of the history that undo takes back."""
    session.recover(work.document)
    with contextlib.suppress(InputError):
        session.autosave()
        if work.file != session.folder.autosave_file:
            work.forget()


def never_saved() -> tuple[UnsavedWork, ...]:
    """Give the newest work of every project that was never saved and is open in no program, the newest first."""
    found = []
    for place in _places():
        folder = ProjectFolder(place)
        work = unsaved_work(folder)
        if work:
            found.append(work[0])
        elif time.time() - place.stat().st_mtime > ABANDONED:
            shutil.rmtree(place, ignore_errors=True)
    return tuple(sorted(found, key=lambda work: work.when, reverse=True))


def take_up(work: UnsavedWork) -> Session:
    """Open a project that was never saved, with its work on top, still without a place of the person's choice."""
    folder = ProjectFolder(work.file.parent)
    saved = folder.load() if folder.file.is_file() else Document()
    session = Session(saved, folder, titled=False)
    recover(session, work)
    return session


def beside_damaged(path: Path) -> UnsavedWork | None:
    """Give the newest autosave in the folder of a project that cannot be opened, None where none can be read."""
    try:
        works = readable(ProjectFolder.find(path))
    except (InputError, OSError):
        return None
    return works[0] if works else None


def open_copy(work: UnsavedWork) -> Session:
    """Open an autosave as a project without a place; the damaged project stays as it is.

    Its media are used where they are, and what was computed of them is not computed again.
    """
    damaged = ProjectFolder(work.file.parent)
    document = linked_from(work.document, damaged)
    session = Session.new(name=document.name)
    ResultStore(session.folder.results).share(ResultStore(damaged.results))
    session.recover(document)
    return session


def throw_away(work: UnsavedWork) -> None:
    """Delete unsaved work for good; a project that was never saved goes with it."""
    work.forget()
    folder = ProjectFolder(work.file.parent)
    if work.file.parent.parent == unsaved_folder() and not in_use(folder.path) and not unsaved_work(folder):
        shutil.rmtree(folder.path, ignore_errors=True)


def what_it_holds(document: Document) -> str:
    """Say in a few words what work there is, so that it can be told apart: "dog: 3 points, 12 clicks"."""
    counts = {
        "point": len(document.tracks),
        "click": sum(len(track.clicks) for track in document.tracks),
        "mask": len(document.masks),
        "pose edit": sum(len(character.edits) for character in document.characters),
        "character": len(document.characters),
        "sequence": len(document.sequences),
    }
    words = [f"{count} {noun}{'s' if count > 1 else ''}" for noun, count in counts.items() if count]
    return f"{document.name}: {', '.join(words[:3])}" if words else document.name


def _places() -> list[Path]:
    try:
        places = [each for each in unsaved_folder().iterdir() if each.is_dir()]
    except OSError:
        return []
    return [each for each in places if not in_use(each)]
