"""Finished motions of other projects as sequences: read, kept up, refused, by session and command line."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.actions import performing
from app.actions.collecting import linked_media
from app.actions.lost_media import lost_media, relink
from app.actions.performing_frames import sequence_footage
from app.actions.session import Session
from app.commands.main import run
from app.model.edits import characters
from app.storage.folder import ProjectFolder
from imitation.errors import InputError

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("solved project")]


@pytest.fixture
def other(solved_project: Path, tmp_path: Path) -> Path:
    """A solved project that may be changed."""
    place = tmp_path / "there" / "film.motionwright"
    shutil.copytree(solved_project, place)
    return place


@pytest.fixture
def animated(other: Path) -> Any:
    """The motion that lies in it."""
    session = Session.open(other)
    try:
        return session.ready(session.stages.animation(session.document.characters[0].id))
    finally:
        session.close()


def test_a_finished_motion_of_another_project_is_a_sequence(other: Path, animated: Any, tmp_path: Path) -> None:
    """Its frames come bit for bit, the other project stays as it was; it is linked and found where it was moved."""
    before = {file: file.stat().st_mtime_ns for file in other.rglob("*")}
    assert run(["perform", "add", str(tmp_path / "mine.motionwright"), str(other)]) == 0
    assert {file: file.stat().st_mtime_ns for file in other.rglob("*")} == before
    session = Session.open(tmp_path / "mine.motionwright")
    try:
        (sequence,) = session.document.sequences
        assert (sequence.name, sequence.source_count) == ("subject", len(animated))
        assert (sequence.up, sequence.unit, sequence.guessed) == ("z", 1.0, ())
        footage = sequence_footage(session, sequence.id)
        assert footage.moving
        np.testing.assert_array_equal(footage[4].vertices, animated.vertices[4])
        assert linked_media(session.document) == ()  # a whole project is not copied along
    finally:
        session.close()
    other.rename(tmp_path / "elsewhere.motionwright")
    (tmp_path / "deep").mkdir()
    (tmp_path / "elsewhere.motionwright").rename(tmp_path / "deep" / other.name)
    session = Session.open(tmp_path / "mine.motionwright")
    try:
        (lost,) = lost_media(session.document, session.folder)
        assert lost.found == tmp_path / "deep" / other.name
        relink(session, lost, lost.found)
        np.testing.assert_array_equal(sequence_footage(session, "s1")[7].vertices, animated.vertices[7])
    finally:
        session.close()


def test_a_motion_that_changed_is_named_and_found_again(other: Path, tmp_path: Path) -> None:
    """Animated in another way it is another motion: said, not taken silently; found again it is used as it is now."""
    mine = Session.new(tmp_path / "mine.motionwright")
    try:
        made, _ = performing.add_sequence(mine, other)
        mine.save()
    finally:
        mine.close()
    theirs = Session.open(other)
    try:
        character = theirs.document.characters[0]
        theirs.apply(characters.set_solve(theirs.document, character.id, method="paper"))
        theirs.save()
        mine = Session.open(tmp_path / "mine.motionwright")
        try:
            with pytest.raises(InputError, match="has changed since it was added"):
                sequence_footage(mine, made)
            with pytest.raises(InputError, match="changed after its motion was made: open it and run animate"):
                performing.add_sequence(mine, other)
            again: Any = theirs.result(theirs.stages.animation(character.id))
            theirs.result(theirs.stages.alignment(character.id))
            media = performing.find_again(mine, made, other)
            assert media.fingerprint != mine.document.sequence(made).media.fingerprint  # type: ignore[union-attr]
            mine.apply(performing.sequences.relink_sequence(mine.document, made, media))
            np.testing.assert_array_equal(sequence_footage(mine, made)[3].vertices, again.vertices[3])
        finally:
            mine.close()
    finally:
        theirs.close()


def test_projects_without_a_motion_are_refused(other: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Never animated, no such character, no character, the project itself, copying: one sentence and a status."""
    mine = tmp_path / "mine.motionwright"
    assert run(["perform", "add", str(mine), str(other), "--character", "nobody"]) != 0
    assert "no character called nobody in film.motionwright: the characters are subject" in capsys.readouterr().err
    assert run(["perform", "add", str(mine), str(other), "--character", "subject", "--name", "hound"]) == 0
    assert run(["perform", "add", str(mine), str(other), "--copy"]) != 0
    assert "whose motion is linked" in capsys.readouterr().err
    assert run(["perform", "add", str(other), str(other)]) != 0
    assert "is this project itself" in capsys.readouterr().err
    shutil.rmtree(ProjectFolder(other).results)
    assert run(["perform", "add", str(mine), str(other)]) != 0
    assert "subject in film.motionwright was never animated: open it and run animate" in capsys.readouterr().err
    Session.new(tmp_path / "bare.motionwright").close()
    assert run(["perform", "add", str(mine), str(tmp_path / "bare.motionwright")]) != 0
    assert "bare.motionwright has no character" in capsys.readouterr().err
    assert [each.name for each in ProjectFolder(mine).load().sequences] == ["hound"]
