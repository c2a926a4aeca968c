"""Fingerprints: tell whether a file is the one that the project was made with, without reading gigabytes."""

from __future__ import annotations

import hashlib
from pathlib import Path

from imitation.errors import InputError

_CHUNK = 1 << 20


def fingerprint(path: Path) -> str:
    """Hash the size and the first, middle and last megabyte of a file, or of every file in a folder by name."""
    digest = hashlib.blake2b(digest_size=16)
    files = sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else [path]
    for file in files:
        if path.is_dir():
            digest.update(file.relative_to(path).as_posix().encode())
        try:
            _add(digest, file)
        except OSError as error:
            raise InputError(f"{file} cannot be read ({error.strerror}).") from error
    return digest.hexdigest()


def _add(digest: hashlib.blake2b, file: Path) -> None:
    size = file.stat().st_size
    digest.update(size.to_bytes(8, "little"))
    with file.open("rb") as stream:
        for start in sorted({0, max(0, size // 2 - _CHUNK // 2), max(0, size - _CHUNK)}):
            stream.seek(start)
            digest.update(stream.read(_CHUNK))
