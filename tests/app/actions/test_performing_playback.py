"""Frames for playing and comparing, the self-similarity for the eye, wishes of export, reading apart from adding."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.actions import performing
from app.actions.performing_frames import performance_frames, sequence_footage
from app.actions.performing_matrix import similarity
from app.actions.performing_playback import performance_shown, sequence_shown
from app.actions.performing_wishes import Wish, why_no_animation, write_wish
from app.actions.session import Session
from app.formats.tvm import open_mesh_frames
from app.model.edits import performance
from app.model.performance import Motion
from imitation.errors import Cancelled, InputError
from tests.app.captured import small_capture, write_capture


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """A capture with three key motions, composed and blended."""
    place = tmp_path_factory.mktemp("film")
    made = Session.new(place / "film")
    take, _ = performing.add_sequence(made, write_capture(place / "take.npz"))
    for frame in (10, 90, 10):
        made.apply(performance.add_key(made.document, Motion(take, frame)))
    made.apply(performance.set_mu(made.document, 50.0))
    made.result(made.stages.blends)
    yield made
    made.close()


def test_shown_frames_are_those_composed(session: Session) -> None:
    """Places, faces and colours; in-betweens and source frames are named; without them, and as filmed, on request."""
    shown, plain = performance_shown(session), performance_frames(session)
    assert (len(shown), shown.fps) == (len(plain), plain.fps)
    placed: Any = session.ready(session.stages.performance)
    cut = next(cut.position for cut in placed.performance.cuts if cut.kind == "cut")
    for position in (0, cut - 1, cut, len(plain) - 1):
        frame, truth = shown[position], plain[position]
        np.testing.assert_allclose(frame.vertices, truth.vertices, atol=1e-5)
        np.testing.assert_array_equal(frame.colours, truth.colours)
        np.testing.assert_allclose(frame.low, truth.vertices.min(axis=0), atol=1e-5)
        assert frame.blended == plain.blended(position)
        assert (frame.sequence, frame.source) == tuple(placed.performance.frames[position])
        np.testing.assert_allclose(np.linalg.norm(frame.normals, axis=1), 1.0, atol=1e-3)
    filmed = performance_shown(session, aligned=False)[cut]
    source = sequence_footage(session, session.document.sequences[0].id)[filmed.source]
    np.testing.assert_allclose(filmed.vertices, source.vertices, atol=1e-5)
    assert not filmed.blended
    assert not performance_shown(session, blended=False)[cut].blended


def test_a_sequence_is_shown_as_captured(session: Session) -> None:
    """Frames of the source; its size is counted, so that what is kept can be bounded."""
    sequence = session.document.sequences[0]
    shown = sequence_shown(session, sequence.id)
    assert len(shown) == sequence.frame_count
    frame = shown[3]
    assert (frame.sequence, frame.source, frame.blended) == (0, 3, False)
    arrays = (frame.vertices, frame.normals, frame.faces, frame.colours)
    assert frame.size == sum(each.nbytes for each in arrays if each is not None)


def test_the_matrix_for_the_eye(session: Session) -> None:
    """Dark on the diagonal, the distances as they are; a sequence that was not compared says so."""
    sequence = session.document.sequences[0].id
    made = similarity(session, sequence)
    assert len(made) == session.document.sequences[0].frame_count
    assert made.distance(5, 5) == 0.0
    assert made.distance(5, 40) == made.distance(40, 5) > 0
    middle = made.picture[np.arange(len(made.picture)), np.arange(len(made.picture))]
    assert middle.mean() < made.picture.mean()


def test_wishes_are_written(session: Session, tmp_path: Path) -> None:
    """A folder with the path inside, a file with the path beside it; one animated GLB is refused with a reason."""
    sentence = write_wish(session, Wish("off", tmp_path / "moves", path=True))
    assert sentence == "Written: moves and path.json."
    assert (tmp_path / "moves" / "path.json").is_file()
    write_wish(session, Wish("npz", tmp_path / "moves.npz", path=True))
    assert (tmp_path / "moves.path.json").is_file()
    assert "faces of their own" in why_no_animation(session)
    with pytest.raises(InputError, match="faces of their own"):
        write_wish(session, Wish("animation", tmp_path / "moves.glb"))


def test_a_wish_that_is_cancelled_leaves_nothing(session: Session, tmp_path: Path) -> None:
    """Neither meshes nor a path."""

    def stop(fraction: float) -> None:
        if fraction > 0.3:
            raise Cancelled

    with pytest.raises(Cancelled):
        write_wish(session, Wish("ply", tmp_path / "moves", path=True), stop)
    assert list(tmp_path.iterdir()) == []


def test_reading_changes_nothing_until_it_is_taken(session: Session, tmp_path: Path) -> None:
    """What was read can be dropped; taken, it is one entry of the history; other files are not found again."""
    before = session.document
    path = write_capture(tmp_path / "again.npz")
    found = performing.read_sequence(session, path, up="z")
    assert session.document is before
    made, note = performing.take_sequence(session, found)
    assert [each.name for each in session.document.sequences] == ["take", "again"]
    assert session.history.undo_label == "Add again"
    assert note == ""
    media = performing.find_again(session, made, path)
    assert media == session.document.sequence(made).media
    short = tmp_path / "short.npz"
    with np.load(path) as arrays:
        count = int(arrays["vertex_offsets"][3])
        faces = int(arrays["face_offsets"][3])
        np.savez(
            short,
            vertices=arrays["vertices"][:count],
            vertex_offsets=arrays["vertex_offsets"][:4],
            faces=arrays["faces"][:faces],
            face_offsets=arrays["face_offsets"][:4],
        )
    with pytest.raises(InputError, match="has 3 frames, but again was made of"):
        performing.find_again(session, made, short)
    session.undo()


def test_frames_of_one_connectivity_are_one_animated_glb(tmp_path: Path) -> None:
    """Where all frames have the same faces nothing speaks against it, and the file holds every frame."""
    vertices, faces, colours = small_capture().mesh(0)
    turns = 2 * np.pi * np.arange(60) / 15
    frames = []
    for turn in turns:
        swayed = vertices.copy()
        swayed[:, 1] += 0.25 * np.sin(turn) * vertices[:, 2]
        swayed[:, 2] *= 1 + 0.1 * np.cos(turn)
        frames.append(swayed)
    np.savez(tmp_path / "sway.npz", vertices=np.array(frames, np.float32), faces=faces, colors=colours, fps=[15])
    with closing(Session.new(tmp_path / "film")) as session:
        made, _ = performing.add_sequence(session, tmp_path / "sway.npz", up="z", unit=1.0)
        session.apply(performance.add_key(session.document, Motion(made, 20)))
        placed: Any = session.result(session.stages.performance)
        assert why_no_animation(session) == ""
        write_wish(session, Wish("animation", tmp_path / "sway.glb"))
        back = open_mesh_frames(tmp_path / "sway.glb")
        assert len(back) == len(placed.performance)
        assert back.moving
        shown = performance_shown(session)[7].vertices
        np.testing.assert_allclose(back[7].vertices, shown, atol=1e-3)
