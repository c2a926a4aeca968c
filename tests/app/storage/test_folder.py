"""Saving and loading change nothing; what cannot be read says why; nothing is lost."""

from __future__ import annotations

import errno
import json
import os
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from app.formats import atomic
from app.model.document import Document
from app.model.edits import scene
from app.storage.folder import ProjectFolder
from app.storage.migrations import VERSION
from app.storage.results import ABANDONED, ResultStore
from app.storage.schema import document_from_json, document_to_json
from imitation import CameraPath, InputError
from tests.app.strategies import documents, start


@given(documents)
@settings(max_examples=60, deadline=None)
def test_json_round_trip_is_exact(document: Document) -> None:
    """Every document reads back equal, and equal documents give equal bytes."""
    data = document_to_json(document)
    again = document_from_json(data, "project.json")
    assert again == document
    assert document_to_json(again) == data


def test_fields_of_a_newer_program_are_kept() -> None:
    """What this program does not know goes through load and save untouched, at the top and deep inside."""
    body = json.loads(document_to_json(start()))
    body["document"]["mood"] = {"tempo": [1, 2.5, None]}
    body["document"]["clip"]["lens"] = "35 mm"
    document = document_from_json(json.dumps(body).encode(), "project.json")
    again = json.loads(document_to_json(document))
    assert again["document"]["mood"] == {"tempo": [1, 2.5, None]}
    assert again["document"]["clip"]["lens"] == "35 mm"


@pytest.mark.parametrize(("old", "new"), [("t1", ("t1",)), (None, ())])
def test_a_project_of_version_1_opens(old: str | None, new: tuple[str, ...]) -> None:
    """It knew one track of constant depth, and no horizon; all else is as it was, and it is saved as version 2."""
    body = json.loads(document_to_json(start()))
    body["version"] = 1
    world = body["document"]["world"]
    for later in ("depth_tracks", "pitch", "roll", "height", "seen"):
        del world[later]
    for track in body["document"]["tracks"]:
        del track["mirror_lag"]
    world["depth_track"] = old
    world["weather"] = "fair"
    opened = document_from_json(json.dumps(body).encode(), "project.json")
    assert opened.world.depth_tracks == new
    assert opened.world.pitch is None
    assert opened.world.seen is None
    assert opened.tracks == start().tracks
    again = json.loads(document_to_json(opened))
    assert again["version"] == VERSION == 2
    assert "depth_track" not in again["document"]["world"]
    assert again["document"]["world"]["weather"] == "fair"


def test_a_newer_format_is_refused_politely() -> None:
    """A file of a later version says that the program must be updated."""
    body = json.loads(document_to_json(Document()))
    body["version"] = VERSION + 1
    with pytest.raises(InputError, match="newer Motionwright"):
        document_from_json(json.dumps(body).encode(), "project.json")


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not readable"),
        (b"\xff\xfe", "not readable"),
        (b"[]", "not a Motionwright project"),
        (b'{"format": "other", "version": 1}', "not a Motionwright project"),
        (b'{"format": "motionwright", "version": 1}', "missing field 'document'"),
        (b'{"format": "motionwright", "version": 1, "document": {"clip": {"width": 3}}}', "damaged"),
        (b'{"format": "motionwright", "version": 1, "document": {"name": 3}}', "text was expected, not 3"),
        (b'{"format": "motionwright", "version": 1, "document": {"range": {"first": 5, "last": 2}}}', "no interval"),
    ],
)
def test_damaged_files_say_so(data: bytes, reason: str) -> None:
    """A damaged project gives one sentence, never a traceback."""
    with pytest.raises(InputError, match=reason) as refusal:
        document_from_json(data, "project.json")
    assert "\n" not in str(refusal.value)


def test_a_project_that_exists_is_not_overwritten(tmp_path: Path) -> None:
    """Creating where a project lies is refused."""
    ProjectFolder.create(tmp_path / "film", Document())
    with pytest.raises(InputError, match="project already"):
        ProjectFolder.create(tmp_path / "film", Document())


def test_a_full_disk_leaves_the_saved_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """When the disk is full, saving says so and the earlier file stays whole."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    before = folder.file.read_bytes()

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(atomic.os, "fsync", full)
    with pytest.raises(InputError, match="disk is full"):
        folder.save(start())
    assert folder.file.read_bytes() == before
    assert [path.name for path in folder.path.iterdir()] == ["project.json"]


def test_autosave_is_offered_until_saved(tmp_path: Path) -> None:
    """Unsaved work comes back after a crash; after saving there is nothing to recover."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    changed = scene.rename(Document(), "changed").document
    folder.autosave(changed)
    assert folder.recoverable() == changed
    folder.save(changed)
    assert folder.recoverable() is None


def test_an_autosave_older_than_the_project_is_superseded(tmp_path: Path) -> None:
    """A save that was cut off before it removed the autosave does not bring older work back."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    folder.autosave(scene.rename(Document(), "older").document)
    autosaved = folder.autosave_file.read_bytes()
    newer = scene.rename(Document(), "newer").document
    folder.save(newer)
    folder.autosave_file.write_bytes(autosaved)
    written = folder.file.stat().st_mtime_ns
    os.utime(folder.autosave_file, ns=(written - 1000, written - 1000))
    assert folder.recoverable() is None
    assert folder.load() == newer


def test_a_damaged_autosave_is_no_obstacle(tmp_path: Path) -> None:
    """A half-written autosave is not offered, and the project opens."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    folder.autosave_file.write_bytes(b"{")
    assert folder.recoverable() is None
    assert folder.load() == Document()


def test_media_are_copied_once_and_found_after_a_move(tmp_path: Path) -> None:
    """Copies with one content are one file; another file of the same name is another; a moved project finds both."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    source = tmp_path / "clip.bin"
    source.write_bytes(b"one")
    first, again = folder.copy_in(source), folder.copy_in(source)
    source.write_bytes(b"two")
    second = folder.copy_in(source)
    assert first == again
    assert first.path != second.path
    linked = folder.link(source)
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    folder.path.rename(moved / folder.path.name)
    source.rename(moved / source.name)
    folder = ProjectFolder.find(moved / "film")
    assert folder.locate(first).read_bytes() == b"one"
    assert folder.locate(second).read_bytes() == b"two"
    assert folder.locate(linked) == moved / "clip.bin"


def test_missing_media_are_named(tmp_path: Path) -> None:
    """A medium that is gone is named with the place where it was expected."""
    folder = ProjectFolder.create(tmp_path / "film", Document())
    source = tmp_path / "clip.bin"
    source.write_bytes(b"one")
    media = folder.link(source)
    source.unlink()
    with pytest.raises(InputError, match=r"clip\.bin is missing"):
        folder.locate(media)


def test_results_come_back_with_the_same_bits(tmp_path: Path) -> None:
    """Nested results of arrays and engine types survive the disk bit by bit."""
    rng = np.random.default_rng(1)
    path = CameraPath(np.tile(np.eye(3), (4, 1, 1)), np.tile(np.eye(3), (4, 1, 1)), rng.normal(size=(4, 3)), "static")
    value = {"path": path, 3: (rng.normal(size=5), None, 0.1 + 0.2, float("nan"), "words"), "list": [True, 7]}
    store = ResultStore(tmp_path)
    store.save("ab" * 16, value)
    again = store.load("ab" * 16)
    assert np.array_equal(again["path"].T, path.T)
    assert again["path"].verdict == "static"
    assert np.array_equal(again[3][0], value[3][0])
    assert again[3][1:3] == (None, 0.1 + 0.2)
    assert np.isnan(again[3][3])
    assert again["list"] == [True, 7]


def test_a_result_of_foreign_code_is_not_run(tmp_path: Path) -> None:
    """A results folder from a stranger can name no class outside the program."""
    store = ResultStore(tmp_path)
    store.save("ab" * 16, {"a": 1})
    file = tmp_path / "ab" / ("ab" * 16) / "value.json"
    file.write_text(json.dumps({"class": "subprocess:Popen", "fields": {"args": "true"}}))
    with pytest.raises(KeyError):
        store.load("ab" * 16)


def test_what_a_killed_process_left_is_swept(tmp_path: Path) -> None:
    """Half-written results go once their writer cannot be at work any more; results and fresh parts stay."""
    store = ResultStore(tmp_path)
    store.save("ab12", {"kept": 1})
    for name, age in ((".ab13.99.part", 2 * ABANDONED), (".ab14.99.part", 0.0)):
        (tmp_path / "ab" / name).mkdir()
        long_ago = time.time() - age
        os.utime(tmp_path / "ab" / name, (long_ago, long_ago))
    store.sweep()
    assert sorted(path.name for path in (tmp_path / "ab").iterdir()) == [".ab14.99.part", "ab12"]
    assert store.load("ab12") == {"kept": 1}


def test_names_of_results_are_remembered(tmp_path: Path) -> None:
    """A store opened anew knows that a stage had a result, though under another key."""
    ResultStore(tmp_path).save("ab12", 1, "animation/c3")
    again = ResultStore(tmp_path)
    assert again.knows("animation/c3")
    assert not again.knows("animation/c4")
    again.clear()
    assert not again.knows("animation/c3")
