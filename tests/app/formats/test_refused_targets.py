"""Targets that cannot be written are refused before anything is computed for them."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from app.formats import Picture, write_video
from imitation.errors import InputError


def test_a_film_is_refused_before_its_first_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a disk that is full or may not be written, no frame is asked for, and nothing is left."""

    def refuse(path: Path, *_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system", str(path))

    def frames() -> Iterator[Picture]:
        pytest.fail("A frame was made for a film that cannot be written.")
        yield

    monkeypatch.setattr(Path, "touch", refuse)
    with pytest.raises(InputError, match="cannot be written: Read-only file system"):
        write_video(tmp_path / "film.mp4", frames(), Fraction(25), count=1)
    assert not list(tmp_path.iterdir())
