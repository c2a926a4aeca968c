"""What a file or a folder is, told by its name and content within milliseconds."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np
import pytest

from app.actions.kinds import kind_of
from app.actions.session import Session
from app.formats import write_mesh, write_sequence

FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


def folder(path: Path, *names: str) -> Path:
    """Make a folder of empty files."""
    path.mkdir()
    for name in names:
        (path / name).touch()
    return path


@pytest.mark.parametrize(
    ("names", "kind"),
    [
        (("0001.png", "0002.png", "notes.txt"), "clip"),
        (("0001.JPG", "0002.JPG"), "clip"),
        (("a_0.ply", "a_1.ply"), "sequence"),
        (("a_0.obj", "a_0.mtl", "a_0.png", "a_1.obj", "a_1.mtl", "a_1.png"), "sequence"),
        (("0.glb", "1.glb", "2.glb"), "sequence"),
        (("cameras.bin", "images.bin", "points3D.bin"), "cameras"),
        (("transforms.json", "1.png", "2.png"), "cameras"),
        (("project.json",), "project"),
        (("autosave.json",), "project"),
        (("one.ply",), ""),
        (("notes.txt",), ""),
        ((), ""),
        ((".hidden.png", ".other.png"), ""),
    ],
)
def test_folders_are_told_by_what_they_hold(tmp_path: Path, names: tuple[str, ...], kind: str) -> None:
    """Pictures are a clip, meshes a sequence, whatever lies beside them."""
    assert kind_of(folder(tmp_path / "thing", *names)) == kind


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("dog.MP4", "clip"),
        ("dog.mov", "clip"),
        ("wolf.ply", "mesh"),
        ("wolf.OBJ", "mesh"),
        ("walk.npz", "sequence"),
        ("walk.usdc", "sequence"),
        ("project.json", "project"),
        ("transforms.json", "cameras"),
        ("notes.txt", ""),
        ("picture.png", ""),
    ],
)
def test_files_are_told_by_their_names(tmp_path: Path, name: str, kind: str) -> None:
    """Upper and lower case are one."""
    (tmp_path / name).touch()
    assert kind_of(tmp_path / name) == kind


def test_a_glb_that_moves_is_a_sequence(tmp_path: Path) -> None:
    """One that stands still is a character's mesh; a damaged one is read, and complained of, as a mesh."""
    write_mesh(tmp_path / "still.glb", CORNERS, FACES)
    write_sequence(tmp_path / "moving.glb", np.stack([CORNERS, CORNERS + 1]), FACES, 25)
    (tmp_path / "text.gltf").write_text(json.dumps({"animations": [{}]}))
    (tmp_path / "bad.gltf").write_text("[")
    assert kind_of(tmp_path / "still.glb") == "mesh"
    assert kind_of(tmp_path / "moving.glb") == "sequence"
    assert kind_of(tmp_path / "text.gltf") == "sequence"
    assert kind_of(tmp_path / "bad.gltf") == "mesh"


def test_a_project_is_a_project(tmp_path: Path) -> None:
    """Its folder, and the file inside."""
    session = Session.new(tmp_path / "film")
    session.close()
    assert kind_of(session.folder.path) == "project"
    assert kind_of(session.folder.file) == "project"
    assert kind_of(tmp_path / "gone.mp4") == ""


def test_a_full_folder_is_told_quickly(tmp_path: Path) -> None:
    """Ten thousand pictures are not all looked at."""
    path = folder(tmp_path / "many", *(f"{number:05d}.png" for number in range(10_000)))
    begin = time.perf_counter()
    assert kind_of(path) == "clip"
    assert time.perf_counter() - begin < 0.2
