"""A full disk: one sentence, the old file whole, no rubbish left."""

from __future__ import annotations

import contextlib
import errno
import resource
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from app.formats import write_image, write_mask, write_mesh, write_sequence, write_tracks, write_video
from imitation.errors import InputError

NOISE = np.random.default_rng(0).integers(0, 255, (12, 128, 128, 3), np.uint8)
VERTICES = np.random.default_rng(1).normal(size=(8, 3000, 3))
FACES = np.arange(3000, dtype=np.int32).reshape(1000, 3)

WRITERS: dict[str, Callable[[Path], None]] = {
    "clip.mp4": lambda path: write_video(path, list(NOISE), 25),
    "picture.png": lambda path: write_image(path, NOISE[0]),
    "mask.png": lambda path: write_mask(path, NOISE[0, :, :, 0] > 99),
    "mesh.ply": lambda path: write_mesh(path, VERTICES[0], FACES),
    "mesh.obj": lambda path: write_mesh(path, VERTICES[0], FACES),
    "mesh.off": lambda path: write_mesh(path, VERTICES[0], FACES),
    "mesh.stl": lambda path: write_mesh(path, VERTICES[0], FACES),
    "mesh.glb": lambda path: write_mesh(path, VERTICES[0], FACES),
    "moving.glb": lambda path: write_sequence(path, VERTICES, FACES, 25),
    "moving.usdc": lambda path: write_sequence(path, VERTICES, FACES, 25),
    "moving.npz": lambda path: write_sequence(path, VERTICES, FACES, 25),
    "tracks.json": lambda path: write_tracks(path, {"a": VERTICES[0, :, :2]}),
    "tracks.csv": lambda path: write_tracks(path, {"a": VERTICES[0, :, :2]}),
}


@contextlib.contextmanager
def full_disk(room: int) -> Iterator[None]:
    """No file may grow beyond ``room`` bytes: the system refuses as it does when a disk is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_the_old_file(tmp_path: Path, name: str) -> None:
    """Every writer says so in one sentence, keeps what was there and removes its own part."""
    (tmp_path / name).write_bytes(b"old")
    with full_disk(1000), pytest.raises(InputError, match=r"disk is full|cannot be written") as caught:
        WRITERS[name](tmp_path / name)
    assert "\n" not in str(caught.value)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_bytes() == b"old"
    WRITERS[name](tmp_path / name)
    assert (tmp_path / name).stat().st_size > 1000


def test_a_full_disk_leaves_the_old_folder(tmp_path: Path) -> None:
    """A folder of frames is as it was when the disk runs full half way."""
    write_sequence(tmp_path, VERTICES[:2], FACES, 25, form="ply")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with full_disk(1000), pytest.raises(InputError, match="disk is full"):
        write_sequence(tmp_path, VERTICES + 1, FACES, 25, form="ply")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_no_space_reported_at_the_very_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some systems notice a full disk only when data is flushed."""

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(InputError, match=r"disk is full: .*mesh\.ply was not written"):
        write_mesh(tmp_path / "mesh.ply", VERTICES[0], FACES)
    assert not list(tmp_path.iterdir())


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    """A folder in the way, and a file in the way of a folder, are named."""
    (tmp_path / "taken.ply").mkdir()
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match="is a folder"):
        write_mesh(tmp_path / "taken.ply", VERTICES[0], FACES)
    with pytest.raises(InputError, match=r"is a file|cannot be written"):
        write_sequence(tmp_path / "file", VERTICES, FACES, 25, form="ply")
    with pytest.raises(InputError, match="cannot be written"):
        write_mesh(tmp_path / "file" / "mesh.ply", VERTICES[0], FACES)
