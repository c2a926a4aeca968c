"""Beginning a project with what is asked for, or not at all."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path

from app.actions.session import Session
from app.storage.folder import ProjectFolder


@contextlib.contextmanager
def begun(path: Path) -> Iterator[Session]:
    """Give a new project at a path, closed at the end; where the block fails, the place is as it was before.

    Who then corrects what was wrong can use the same name again.
    """
    folder = ProjectFolder.free(path)
    # Nearest first: those that are not there yet are made by the project, and go with it if they are empty.
    made = [each for each in (folder.path, *folder.path.parents) if not each.exists()]
    held = [each for each in (folder.media, folder.results) if each.exists()]
    try:
        with contextlib.closing(Session.new(path)) as session:
            yield session
    except BaseException:
        folder.file.unlink(missing_ok=True)
        for each in (folder.media, folder.results):
            if each not in held:
                shutil.rmtree(each, ignore_errors=True)
        for each in made:
            with contextlib.suppress(OSError):
                each.rmdir()
        raise
