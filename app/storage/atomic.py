"""Files that are either the old one or the new one, whatever happens in between."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from imitation.errors import InputError


def write_atomically(path: Path, data: bytes) -> None:
    """Write beside the file, bring it to the disk, then put it in the file's place.

    Raises ``InputError`` when the disk is full or the folder cannot be written; the old file stays as it was.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with beside.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        beside.replace(path)
        _sync_folder(path.parent)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise InputError(explain(error, path)) from error


def explain(error: OSError, path: Path) -> str:
    """Say in one sentence why a file could not be written."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"The disk is full, so {path.name} was not written; make room and save again."
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return f"{path} cannot be written: choose a folder that you may write to."
    return f"{path} could not be written ({error.strerror or error}); the earlier file is unchanged."


def _sync_folder(folder: Path) -> None:
    # Without this a power cut may forget the rename; not every file system can do it, Windows cannot.
    if os.name == "nt":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    except OSError:
        pass
    finally:
        os.close(handle)
