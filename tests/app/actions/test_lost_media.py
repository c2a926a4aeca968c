"""Moved media are found beside the project, told from others by their content, and said where they lie."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from app.actions import bringing, collecting, lost_media
from app.actions.session import Session
from app.formats import write_mesh, write_video
from app.model.edits import characters, tracks
from app.storage.folder import ProjectFolder
from imitation import Cancelled, InputError

FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


def film(path: Path, frames: int = 6, seed: int = 0) -> Path:
    """Write a short video of noise."""
    picture = np.random.default_rng(seed).integers(40, 215, (48, 64, 3), np.uint8)
    write_video(path, [np.roll(picture, t, 1) for t in range(frames)], 25)
    return path


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project whose clip and mesh are linked, in a folder beside it."""
    there = tmp_path / "shoot"
    there.mkdir()
    write_mesh(there / "wolf.ply", CORNERS, FACES)
    with closing(Session.new(tmp_path / "walk")) as session:
        bringing.add_clip(session, film(there / "dog.mp4"))
        wolf = bringing.add_character(session, there / "wolf.ply", up="z")
        session.apply(tracks.add_track(session.document, 0, (5, 5), name="paw"))
        session.apply(characters.set_pair(session.document, wolf, session.document.tracks[0].id, 3))
        session.save()
    return session.folder.path


def test_nothing_is_lost_where_all_is_there(project: Path) -> None:
    """A project as it was saved asks for nothing."""
    with closing(Session.open(project)) as session:
        assert not lost_media.lost_media(session.document, session.folder)


def test_what_moved_is_found_beside_the_project(project: Path, tmp_path: Path) -> None:
    """A folder that was renamed: both files are found by name and content; a namesake is not taken for them."""
    (tmp_path / "shoot").rename(tmp_path / "takes")
    film(tmp_path / "dog.mp4", seed=1)
    with closing(Session.open(project)) as session:
        clip, mesh = lost_media.lost_media(session.document, session.folder)
        assert (clip.name, clip.owner, clip.found) == ("dog.mp4", "the clip", tmp_path / "takes" / "dog.mp4")
        assert (mesh.owner, mesh.found) == ("the mesh of wolf", tmp_path / "takes" / "wolf.ply")
        before = session.stages.track(session.document.tracks[0].id).key
        with pytest.raises(InputError):
            session.frames()
        for lost in (clip, mesh):
            assert lost.found is not None
            lost_media.relink(session, lost, lost.found)
        assert len(session.frames()) == 6
        assert session.stages.track(session.document.tracks[0].id).key == before, "moved files change no result"
        assert session.history.undo_label == "Find wolf again"
        assert not lost_media.lost_media(session.document, session.folder)


def test_what_does_not_fit_is_refused(project: Path, tmp_path: Path) -> None:
    """Another length of clip, a mesh without the marked vertex: a sentence, and the project as it was."""
    shutil.rmtree(tmp_path / "shoot")
    write_mesh(tmp_path / "small.ply", CORNERS[:3], FACES[:1])
    with closing(Session.open(project)) as session:
        clip, mesh = lost_media.lost_media(session.document, session.folder)
        assert clip.found is None
        before = session.document
        with pytest.raises(InputError, match=r"another clip: it has 9 frames of 64 x 48.*with 6"):
            lost_media.relink(session, clip, film(tmp_path / "long.mp4", frames=9))
        with pytest.raises(InputError, match=r"3 vertices, but wolf is marked at vertex 3"):
            lost_media.relink(session, mesh, tmp_path / "small.ply")
        assert session.document is before
        lost_media.relink(session, clip, film(tmp_path / "again.mp4", seed=5))
        assert session.document.clip.media.fingerprint != before.clip.media.fingerprint


def test_a_search_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder of very many entries is not read to its end."""
    for number in range(30):
        (tmp_path / f"{number}").mkdir()
    monkeypatch.setattr(lost_media, "MANY", 10)
    assert list(lost_media._named(tmp_path, "dog.mp4")) == []


def test_media_are_copied_in_later(project: Path) -> None:
    """Linked media are measured and copied with progress; one edit uses the copies, and undo goes back."""
    with closing(Session.open(project)) as session:
        before = session.document
        assert len(collecting.linked_media(before)) == 2
        assert collecting.linked_size(before, session.folder) > 300
        told: list[float] = []
        copies = collecting.copied_media(before, session.folder, session.folder, told.append)
        assert told == sorted(told)
        assert told[-1] == pytest.approx(1.0, abs=0.01)
        session.apply(collecting.use_copies(before, copies))
        assert not collecting.linked_media(session.document)
        assert session.document.clip.media.path == "media/dog.mp4"
        assert session.undo().label == "Copy media into the project"
        assert session.document == before


def test_copying_that_is_cancelled_leaves_nothing(project: Path) -> None:
    """No half of a film stays behind."""

    def stop(fraction: float) -> None:
        raise Cancelled

    with closing(Session.open(project)) as session:
        with pytest.raises(Cancelled):
            collecting.copied_media(session.document, session.folder, session.folder, stop)
        assert not session.folder.media.exists() or not list(session.folder.media.iterdir())
        assert isinstance(session.folder, ProjectFolder)


def test_media_are_sent_ahead_of_a_save(project: Path, tmp_path: Path) -> None:
    """Copied with progress to where the project will be saved; saving then copies nothing anew; cancelled, no trace."""

    def stop(fraction: float) -> None:
        raise Cancelled

    with closing(Session.open(project)) as session:
        copies = collecting.copied_media(session.document, session.folder, session.folder)
        session.apply(collecting.use_copies(session.document, copies))
        with pytest.raises(Cancelled):
            session.send_media(tmp_path / "other", stop)
        assert not (tmp_path / "other.motionwright").exists()
        told: list[float] = []
        session.send_media(tmp_path / "other", told.append)
        assert told[-1] == 1.0
        sent = tmp_path / "other.motionwright" / "media" / "dog.mp4"
        before = sent.stat().st_ino, sent.stat().st_ctime_ns
        session.save_as(tmp_path / "other")
        assert (sent.stat().st_ino, sent.stat().st_ctime_ns) == before
        assert len(session.frames()) == 6
