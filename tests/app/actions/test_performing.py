"""Sequences into projects, and a character's own motion among them."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.actions import performing, performing_sample
from app.actions.performing_films import still, thumbnail
from app.actions.performing_frames import performance_frames, sequence_footage
from app.actions.session import Session
from app.model.document import Document
from app.model.edits import performance, poses, sequences
from app.model.performance import Motion
from imitation import InputError
from tests.app.captured import small_capture, write_capture


@pytest.mark.slow
def test_the_sample_takes_are_what_they_say(tmp_path: Path) -> None:
    """The hound's takes fall into the motions that were performed."""
    truth = performing_sample.make_takes(tmp_path / "takes.npz")
    session = Session.new(tmp_path / "film")
    try:
        made, _ = performing.add_sequence(session, tmp_path / "takes.npz")
        found: Any = session.result(session.stages.structure(made))
        assert [name for name, _ in truth] == ["trot", "bow", "walk", "shake"]
        starts = [cluster.first for cluster in found.clusters]
        assert len(starts) == 4
        assert np.abs(np.array(starts) - [first for _, first in truth]).max() <= 6
        analysis: Any = session.result(session.stages.analysis(made))
        assert np.abs(np.rad2deg(analysis.headings)).max() < 8
    finally:
        session.close()


@pytest.mark.slow
@pytest.mark.xdist_group("solved project")
def test_an_imitated_motion_is_a_sequence(solved_project: Path, tmp_path: Path) -> None:
    """The character's animated motion enters the database; an edit of its pose makes the sequence stale."""
    copy = tmp_path / "film.motionwright"
    shutil.copytree(solved_project, copy)
    session = Session.open(copy)
    try:
        character = session.document.characters[0]
        made, note = performing.add_character_motion(session, character.id)
        assert note == ""
        animated: Any = session.result(session.stages.animation(character.id))
        footage = sequence_footage(session, made)
        assert len(footage) == len(animated)
        assert footage.moving
        np.testing.assert_array_equal(footage[4].vertices, animated.vertices[4])
        session.apply(performance.add_key(session.document, Motion(made, 0)))
        session.result(session.stages.performance)
        frames = performance_frames(session)
        assert frames.moving
        np.testing.assert_allclose(
            frames[1].vertices[:, 2], animated.vertices[int(frames.performance.frames[1, 1])][:, 2]
        )
        fresh = session.runner.state(session.stages.features(made))
        vertex = next(iter(character.pairs.values()))
        place = tuple(float(value) for value in animated.vertices[3][vertex] + 0.05)
        session.apply(poses.move_vertices(session.document, character.id, 3, {vertex: place}, {vertex: place}))  # type: ignore[dict-item]
        assert (fresh, session.runner.state(session.stages.features(made))) == ("fresh", "stale")
    finally:
        session.close()


def test_a_motion_that_is_not_there_is_named() -> None:
    """The sentence says what was asked and what there is."""
    with pytest.raises(InputError, match="no motion called nobody/1: the motions are none"):
        performing.motion_named(Document(), [], "nobody/1")


def test_levelling_takes_out_a_climb(tmp_path: Path) -> None:
    """A walk up a slope stays on the level; what stands is moved by less than a centimetre, jumps are kept."""
    from app.formats.tvm import FrameMesh, write_mesh_frames

    capture = small_capture()
    rise = np.linspace(0.0, 1.0, 60)
    frames = []
    for k in range(60):
        vertices, faces, colours = capture.mesh(k)
        frames.append(FrameMesh(vertices + np.array([0, 0, rise[k]]), faces, colours))
    write_mesh_frames(tmp_path / "up.npz", frames, form="npz", fps=15, count=60)
    session = Session.new(tmp_path / "film")
    try:
        made, _ = performing.add_sequence(session, tmp_path / "up.npz")
        session.apply(sequences.set_level(session.document, made, True))
        footage = sequence_footage(session, made)
        lows = np.array([mesh.vertices[:, 2].min() for mesh in footage])
        assert np.ptp(lows) < 0.2
        assert np.ptp([mesh.vertices[:, 2].min() for mesh in frames]) > 0.9
    finally:
        session.close()


def test_a_thumbnail_shows_the_performer(tmp_path: Path) -> None:
    """A square picture with the performer in its middle, in colour."""
    session = Session.new(tmp_path / "film")
    try:
        made, _ = performing.add_sequence(session, write_capture(tmp_path / "take.npz"))
        picture = thumbnail(session, made, size=64)
        assert picture.shape == (64, 64, 3)
        spread = np.abs(picture.astype(int) - picture[:, :1].astype(int)).sum(axis=2)
        assert spread[20:44, 26:38].max() > 100 > spread[:, :6].max()
        whole = still(sequence_footage(session, made)[0], size=(64, 48))
        assert whole.shape == (48, 64, 3)
    finally:
        session.close()
