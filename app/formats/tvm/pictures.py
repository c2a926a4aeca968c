"""Pictures that come inside mesh files, put on the disk where they can be passed on as files."""

from __future__ import annotations

import hashlib
import shutil
import tempfile
import threading
import weakref
from collections import OrderedDict
from pathlib import Path

BUDGET = 1 << 30
"""Bytes of pictures that stay on the disk; the oldest go first."""
KEPT = 16
"""So many stay, whatever their size."""


def picture_suffix(data: bytes) -> str:
    """The suffix that a picture's first bytes call for, ".png" or ".jpg"; empty for anything else."""
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return ".png"
    return ".jpg" if data.startswith(b"\xff\xd8\xff") else ""


class PictureRoom:
    """A folder of its own, gone with the sequence; equal pictures are one file. Safe from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._folder: Path | None = None
        self._files: OrderedDict[str, tuple[Path, int]] = OrderedDict()
        self._total = 0

    def put(self, data: bytes, stem: str) -> Path | None:
        """The file of a picture, byte for byte; None where it is neither PNG nor JPEG."""
        suffix = picture_suffix(data)
        if not suffix:
            return None
        key = hashlib.sha256(data).hexdigest()
        with self._lock:
            if key not in self._files:
                if self._folder is None:
                    self._folder = Path(tempfile.mkdtemp(prefix="motionwright-"))
                    weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
                place = self._folder / key[:16]
                place.mkdir()
                (place / (stem + suffix)).write_bytes(data)
                self._files[key] = (place / (stem + suffix), len(data))
                self._total += len(data)
            self._files.move_to_end(key)
            while self._total > BUDGET and len(self._files) > KEPT:
                _, (old, size) = self._files.popitem(last=False)
                shutil.rmtree(old.parent, ignore_errors=True)
                self._total -= size
            return self._files[key][0]
