"""Fingerprints of media: cheap enough for every opening, and different for different files."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from imitation.errors import InputError

_PART = 1 << 16


def file_fingerprint(path: Path) -> str:
    """A hash of a file's size and of 64 KiB at its start, middle and end; the place and date do not matter."""
    digest = hashlib.blake2b(digest_size=16)
    _add(digest, path, _PART)
    return digest.hexdigest()


def folder_fingerprint(paths: Iterable[Path]) -> str:
    """A hash of the names, sizes and first, middle and last KiB of files, in the order given."""
    digest = hashlib.blake2b(digest_size=16)
    for path in paths:
        digest.update(path.name.encode() + b"\0")
        _add(digest, path, 1 << 10)
    return digest.hexdigest()


def _add(digest: hashlib.blake2b, path: Path, part: int) -> None:
    try:
        size = path.stat().st_size
        digest.update(size.to_bytes(8, "little"))
        with path.open("rb") as file:
            if size <= 3 * part:
                digest.update(file.read())
                return
            for start in (0, (size - part) // 2, size - part):
                file.seek(start)
                digest.update(file.read(part))
    except OSError as error:
        raise InputError(f"The file {path} cannot be read: {error.strerror}.") from error
