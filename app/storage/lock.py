"""Who works in a folder: a lock that the operating system lets go of when its holder dies, however it dies."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from types import ModuleType

NAME = ".lock"


class FolderLock:
    """Held while a project is open; it keeps nobody out, it only says that somebody is in."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._file = -1

    def take(self) -> bool:
        """Take the lock; False where another holds it. A folder that cannot be written counts as free."""
        try:
            file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError:
            return True
        if not _locked(file):
            os.close(file)
            return False
        self._file = file
        return True

    def let_go(self) -> None:
        """Let others in, and leave no file behind."""
        file, self._file = self._file, -1
        if file < 0:
            return
        if os.name == "nt":  # an open file cannot be removed there
            os.close(file)
        with contextlib.suppress(OSError):
            self._path.unlink()
        if os.name != "nt":
            os.close(file)

    def __del__(self) -> None:
        if self._file >= 0:
            os.close(self._file)


def in_use(folder: Path) -> bool:
    """Whether a running program has a folder open."""
    if not (folder / NAME).exists():
        return False
    lock = FolderLock(folder)
    free = lock.take()
    lock.let_go()
    return not free


def _locked(file: int) -> bool:
    module = _module()
    if module is None:
        return True
    try:
        if os.name == "nt":
            module.locking(file, module.LK_NBLCK, 1)
        else:
            module.flock(file, module.LOCK_EX | module.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return os.name != "nt"  # a file system without locks: nobody can be told apart
    return True


def _module() -> ModuleType | None:
    try:
        if os.name == "nt":
            return __import__("msvcrt")
        return __import__("fcntl")
    except ImportError:
        return None
