"""Writing so that a file is either the old one or the whole new one, never a half."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from imitation.errors import InputError

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary file beside ``path`` (same suffix) that becomes ``path`` when the block ends well.

    After an error or a cancellation the temporary file is gone and ``path`` is as it was.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    with explained(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise InputError(f"{path} is a folder, so no file can be written there: choose another name.")
        temporary = path.with_name(f".{path.stem[:80]}.{os.urandom(4).hex()}.part{path.suffix}")
        try:
            # What cannot be written is told now, not after what goes into it was computed.
            temporary.touch()
            yield temporary
            with temporary.open("rb+") as file:
                os.fsync(file.fileno())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)


@contextlib.contextmanager
def replacing_numbered(folder: Path, stem: str, suffix: str) -> Iterator[Path]:
    """Give a temporary folder whose files move into ``folder`` when the block ends well.

    Files ``stem_<digits>suffix`` of an earlier, longer sequence are removed then; nothing else in ``folder`` is
    touched. After an error or a cancellation ``folder`` is as it was.
    """
    with explained(folder):
        if folder.exists() and not folder.is_dir():
            raise InputError(f"{folder} is a file, so no sequence can be written there: choose another name.")
        existed = folder.is_dir()
        folder.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=".", suffix=".part", dir=folder))
        try:
            yield temporary
            made = sorted(temporary.iterdir())
            for path in made:
                path.replace(folder / path.name)
            names = {path.name for path in made}
            pattern = re.compile(rf"{re.escape(stem)}_\d+{re.escape(suffix)}")
            for path in folder.iterdir():
                if pattern.fullmatch(path.name) and path.name not in names:
                    path.unlink()
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
            if not existed:
                with contextlib.suppress(OSError):
                    folder.rmdir()


@contextlib.contextmanager
def explained(path: Path) -> Iterator[None]:
    """Turn an operating system's refusal to write ``path`` into an InputError of one sentence."""
    try:
        yield
    except OSError as error:
        if error.errno in _FULL:
            raise InputError(f"The disk is full: {path} was not written; free some space and try again.") from error
        raise InputError(f"{path} cannot be written: {error.strerror or error}.") from error
